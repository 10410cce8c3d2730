"""`remember` and `fold`: values of earlier records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from sequence_planner.expressions.place import Place
from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import FieldType, Record
from sequence_planner.pipelines.stages.transparent import TransparentStage


@dataclass(frozen=True)
class RememberStage:
    """A variable keeps the last known value of another field, but for those that are ignored."""

    place: Place
    variable: str
    type: FieldType
    of: FieldPath
    ignored: frozenset[object]
    kind: ClassVar[str] = "remember"

    @property
    def reads(self) -> frozenset[str]:
        """The field whose value is kept."""
        return frozenset({self.of.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The value kept."""
        return {self.variable: self.type}

    def begin(self) -> RememberCourse:
        """Begin with nothing remembered."""
        return RememberCourse(self)

    def backwards(self, values: dict[str, object]) -> None:
        """A device says what is so now: where the state does not tell that, it is what is remembered."""
        if self.of.text not in values and values.get(self.variable) is not None:
            values[self.of.text] = values[self.variable]


@dataclass(slots=True)
class RememberCourse:
    """Has the value that is kept."""

    stage: RememberStage
    kept: object = None
    due: ClassVar[float | None] = None

    def take(self, record: Record, now: float) -> Record:
        """The record with the value kept, after this one has been looked at."""
        value = self.stage.of.read(record.values, record.troubles)
        if value is not None and value not in self.stage.ignored:
            self.kept = value
        record.values[self.stage.variable] = self.kept
        return record

    def wake(self, now: float) -> None:
        """Nothing happens by itself."""


@dataclass(frozen=True)
class FoldStage(TransparentStage):
    """Fields that are unknown or missing keep the value of the last record that had one."""

    kind: ClassVar[str] = "fold"

    def begin(self) -> FoldCourse:
        """Begin with nothing remembered."""
        return FoldCourse(self)


@dataclass(slots=True)
class FoldCourse:
    """Has the last known value of each field."""

    stage: FoldStage
    known: dict[str, object] = field(default_factory=dict)
    due: ClassVar[float | None] = None

    def take(self, record: Record, now: float) -> Record:
        """The record with what earlier ones said where it says nothing."""
        values = record.values
        given = ((each.path.text, each.path.read(values, record.troubles)) for each in self.stage.fields)
        self.known |= {name: value for name, value in given if value is not None}
        values |= {each.path.text: self.known.get(each.path.text) for each in self.stage.fields}
        return record

    def wake(self, now: float) -> None:
        """Nothing happens by itself."""
