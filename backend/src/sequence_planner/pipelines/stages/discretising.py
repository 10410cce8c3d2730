"""`discretise` and `undiscretise`: from numbers to the name of the region they are in, and back."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

from sequence_planner.expressions.place import Place
from sequence_planner.expressions.types import EnumerationType, IntegerRange
from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import FieldType, ListType, Record
from sequence_planner.pipelines.stage import NotInvertibleError
from sequence_planner.pipelines.stages.immediate import ImmediateStage
from sequence_planner.pipelines.stages.regions import Numbers, Points, Regions, numbers_of
from sequence_planner.pipelines.stages.values import shown


@dataclass(frozen=True)
class DiscretiseStage:
    """Numbers become the name of the region they are in, or `otherwise`; with none of these they are unknown.

    With a hysteresis a region, once reached, is left only when the numbers are further outside than that.
    """

    place: Place
    field: FieldPath
    variable: str
    type: EnumerationType
    regions: Regions
    otherwise: str | None
    hysteresis: float
    field_type: FieldType
    kind: ClassVar[str] = "discretise"

    @property
    def reads(self) -> frozenset[str]:
        """The numbers."""
        return frozenset({self.field.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The name."""
        return {self.variable: self.type}

    def begin(self) -> DiscretiseCourse:
        """Begin in no region."""
        return DiscretiseCourse(self)

    def backwards(self, values: dict[str, object]) -> None:
        """Numbers in the region of that name; for `otherwise` those there are already, or ones near them."""
        name = values.get(self.variable)
        if name is None:
            return
        region = name if isinstance(name, str) and name in self.regions.names else None
        if region is None and name != self.otherwise:
            what = f"it is neither among the values of `{self.kind}` nor its `otherwise`"
            raise NotInvertibleError(f"no number means {shown(name)} for `{self.variable}`: {what}")
        for numbers in self._tried(region, numbers_of(values.get(self.field.text), self.regions.axes)):
            if numbers is not None and self.regions.find(fitting := _of_type(numbers, self.field_type)) == region:
                values[self.field.text] = _as_field(fitting, self.field_type)
                return
        raise NotInvertibleError(f"no number means {shown(name)} for `{self.variable}`: leave a gap for it")

    def _tried(self, region: str | None, now: Numbers | None) -> Iterator[Numbers | None]:
        """Numbers in that region, or in none; the second ones outside are so far out that integers are, too."""
        if region is not None:
            yield self.regions.inside(region)
        else:
            yield self.regions.outside(self.hysteresis, now)
            yield self.regions.outside(self.hysteresis + 1.0, now)


@dataclass(slots=True)
class DiscretiseCourse:
    """Knows in which region the numbers were last."""

    stage: DiscretiseStage
    last: str | None = None
    due: ClassVar[float | None] = None

    def take(self, record: Record, now: float) -> Record:
        """The record with the name of the region."""
        stage = self.stage
        raw = stage.field.get(record.values)
        numbers = None if raw is None else numbers_of(raw, stage.regions.axes)
        if numbers is None:
            self.last = None
            record.values[stage.variable] = None
            if raw is not None:
                record.troubles.append(f"{stage.field} is no position: {shown(raw)}")
            return record
        stays = stage.hysteresis > 0 and self.last is not None
        if not stays or not stage.regions.holds(self.last or "", numbers, stage.hysteresis):
            self.last = stage.regions.find(numbers)
        record.values[stage.variable] = self.last or stage.otherwise
        if self.last is None and stage.otherwise is None:
            record.troubles.append(f"{stage.field} is {shown(raw)}, which is in none of the ranges")
        return record

    def wake(self, now: float) -> None:
        """Nothing happens by itself."""


@dataclass(frozen=True)
class UndiscretiseStage(ImmediateStage):
    """A name becomes the coordinates of its point."""

    variable: FieldPath
    field: str
    type: FieldType
    points: Mapping[str, Numbers]
    kind: ClassVar[str] = "undiscretise"

    @property
    def reads(self) -> frozenset[str]:
        """The name."""
        return frozenset({self.variable.text})

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The coordinates."""
        return {self.field: self.type}

    def apply(self, record: Record) -> None:
        """The field takes the coordinates."""
        name = self.variable.get(record.values)
        numbers = self.points.get(name) if isinstance(name, str) else None
        record.values[self.field] = None if numbers is None else _as_field(numbers, self.type)
        if name is not None and numbers is None:
            record.troubles.append(f"{self.variable} is {shown(name)}, which has no coordinates")

    def backwards(self, values: dict[str, object]) -> None:
        """The name of the nearest point: a command is always one of them, but for rounding."""
        raw = values.get(self.field)
        if raw is None:
            return
        numbers = numbers_of(raw, len(next(iter(self.points.values()))))
        if numbers is None:
            raise NotInvertibleError(f"{self.field} is no position: {shown(raw)}")
        values[self.variable.text] = Points(self.points, 0.0).nearest(numbers)


def _of_type(numbers: Numbers, type_: FieldType) -> Numbers:
    """`numbers` as the field can have them: rounded where it has integers."""
    element = type_.element if isinstance(type_, ListType) else type_
    return tuple(map(round, numbers)) if isinstance(element, IntegerRange) else numbers


def _as_field(numbers: Numbers, type_: FieldType) -> object:
    return list(numbers) if isinstance(type_, ListType) else numbers[0]
