"""The nature of a stage: a description, checked when the station is loaded, and its course while the station runs.

A stage reads some fields of a record and gives some; all others pass through it. Descriptions are immutable and
shared; what must be remembered from record to record is in the `StageInstance` that `begin` makes. No stage looks at a
clock: times are given to it, in seconds on any clock that only goes forward, so that a pipeline can be run in an
example as on a station.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from sequence_planner.language.records.record import FieldType, Record
from sequence_planner.language.types import Place


class NotInvertibleError(Exception):
    """A stage cannot be read backwards for these values; the text says why and what to do."""


class StageInstance(Protocol):
    """One stage while it runs."""

    @property
    def due(self) -> float | None:
        """The moment when `wake` is to be called if nothing comes before; None: not at all."""

    def take(self, record: Record, now: float) -> Record | None:
        """Return what goes on because of a record, which may be changed in place; None when it is held back or
        dropped.
        """

    def wake(self, now: float) -> Record | None:
        """Return what goes on because time has passed."""


class Stage(Protocol):
    """One stage as written and checked."""

    @property
    def kind(self) -> str:
        """The key by which documents name it, such as `discretise`."""

    @property
    def place(self) -> Place:
        """The place where it was written."""

    @property
    def reads(self) -> frozenset[str]:
        """The fields it needs; a nested one by its path, such as `pose.position.x`."""

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The fields that a record has after it, in addition to those it had or with another type."""

    def begin(self) -> StageInstance:
        """Start it afresh, with nothing remembered."""

    def backwards(self, values: dict[str, object]) -> None:
        """Add to `values`, which has what the stage gives, fields it could have read: how an emulated device speaks.

        Raises `NotInvertibleError` when there are none.
        """


@dataclass(frozen=True)
class Override:
    """Values that a person has set in place of those that came; `until` is on the clock of the pipeline."""

    fields: Mapping[str, object]
    actor: str
    until: float


@runtime_checkable
class Overriding(Protocol):
    """The course of a stage whose fields a person can set."""

    @property
    def name(self) -> str:
        """What it is called where it is set."""

    @property
    def override(self) -> Override | None:
        """The override that is set now."""

    def set_override(self, fields: Mapping[str, object], now: float, actor: str) -> Record | None:
        """Set these fields; returns the last record with them. Raises ValueError for what the bounds do not allow."""

    def clear_override(self, now: float) -> Record | None:
        """Take back what is set; returns the last record without it."""

    def restore(self, override: Override) -> None:
        """Go on with what was set before the pipeline began afresh."""


@runtime_checkable
class Closable(Protocol):
    """The course of a stage that holds something of the system's, such as a process."""

    def close(self) -> None:
        """Give it back. May be repeated."""


@runtime_checkable
class Loadable(Protocol):
    """A stage that needs something loaded, which can fail on this machine."""

    def loading_trouble(self) -> str | None:
        """Load it once, beside; what is wrong with it, or None."""


@runtime_checkable
class Patient(Protocol):
    """A stage that works beside, and can be waited for where time is only told, as in an example."""

    def begin_patiently(self) -> StageInstance:
        """Start it afresh so that each record is answered at once."""
