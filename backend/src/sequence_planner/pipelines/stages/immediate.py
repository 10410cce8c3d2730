"""Stages that remember nothing: what goes on is decided by the record alone, and at once."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from sequence_planner.expressions.place import Place
from sequence_planner.pipelines.record import Record
from sequence_planner.pipelines.stage import Course


@dataclass(frozen=True, slots=True)
class ImmediateCourse:
    """The course of a stage that changes each record and lets it go on."""

    apply: Callable[[Record], None]
    due: ClassVar[float | None] = None

    def take(self, record: Record, now: float) -> Record:
        """The record with what the stage gives."""
        self.apply(record)
        return record

    def wake(self, now: float) -> None:
        """Nothing happens by itself."""


@dataclass(frozen=True)
class ImmediateStage(ABC):
    """A stage without a memory."""

    place: Place

    @abstractmethod
    def apply(self, record: Record) -> None:
        """Add to `record` what the stage gives; it is unknown where that cannot be said."""

    def begin(self) -> Course:
        """Its course, which has nothing to remember."""
        return ImmediateCourse(self.apply)
