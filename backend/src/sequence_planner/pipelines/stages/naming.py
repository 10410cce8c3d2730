"""`rename` and `constant`: fields under other names, and fields that never change."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import FieldType, Record
from sequence_planner.pipelines.stages.immediate import ImmediateStage


@dataclass(frozen=True)
class Renaming:
    """A field under another name."""

    source: FieldPath
    target: str
    type: FieldType


@dataclass(frozen=True)
class RenameStage(ImmediateStage):
    """Fields also under other names; all are read before one is given, so that two can change places."""

    kind: ClassVar[str] = "rename"
    renamings: tuple[Renaming, ...]

    @property
    def reads(self) -> frozenset[str]:
        """The old names."""
        return frozenset(renaming.source.text for renaming in self.renamings)

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The new names."""
        return {renaming.target: renaming.type for renaming in self.renamings}

    def apply(self, record: Record) -> None:
        """Give each field its other name."""
        values = record.values
        values |= {renaming.target: renaming.source.get(values) for renaming in self.renamings}

    def backwards(self, values: dict[str, object]) -> None:
        """Give each its old name."""
        values |= {
            renaming.source.text: values[renaming.target]
            for renaming in self.renamings
            if values.get(renaming.target) is not None
        }


@dataclass(frozen=True)
class ConstantStage(ImmediateStage):
    """Fields that never change."""

    kind: ClassVar[str] = "constant"
    fields: Mapping[str, object]
    gives: Mapping[str, FieldType]

    @property
    def reads(self) -> frozenset[str]:
        """Nothing."""
        return frozenset()

    def apply(self, record: Record) -> None:
        """Set them."""
        record.values.update(self.fields)

    def backwards(self, values: dict[str, object]) -> None:
        """They say nothing about other fields."""
