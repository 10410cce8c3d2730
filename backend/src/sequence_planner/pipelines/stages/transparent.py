"""Stages through which the same fields pass, with other values or at other times."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.expressions.place import Place
from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import FieldType, Record


@dataclass(frozen=True)
class Passing:
    """A field that a stage may hold back, with its type."""

    path: FieldPath
    type: FieldType


@dataclass(frozen=True)
class TransparentStage:
    """A stage that gives what it reads. Read backwards nothing has to be added."""

    place: Place
    fields: tuple[Passing, ...]

    @property
    def reads(self) -> frozenset[str]:
        """The fields it may hold back."""
        return frozenset(field.path.text for field in self.fields)

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The same."""
        return {field.path.text: field.type for field in self.fields}

    def get(self, record: Record) -> tuple[object, ...]:
        """The values of the fields."""
        return tuple(field.path.read(record.values, record.troubles) for field in self.fields)

    def put(self, record: Record, values: tuple[object, ...]) -> Record:
        """Give `values` to the fields."""
        record.values.update(zip((field.path.text for field in self.fields), values, strict=True))
        return record

    def backwards(self, values: dict[str, object]) -> None:
        """What it gives is what it reads."""


def again(record: Record) -> Record:
    """`record` once more; what made no sense in it has been said."""
    return Record(dict(record.values))
