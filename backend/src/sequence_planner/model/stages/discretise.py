"""Stages `discretise` and `undiscretise`: numbers to named regions, and back."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Annotated, ClassVar, Protocol

from pydantic import Field, model_validator

from sequence_planner.language.records.field_paths import REAL, FieldPath, is_number, is_numeric, shown
from sequence_planner.language.records.record import FieldType, ListType, Record
from sequence_planner.language.types import EnumerationType, IntegerRange, Place
from sequence_planner.model.fields import Given
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, NotInvertibleError, StageDeclaration, StageInstance
from sequence_planner.model.stages.marks import (
    ExampleValue,
    GivenValue,
    MessageField,
    ModelVariable,
    NamedMap,
    ReadValue,
)
from sequence_planner.model.stages.suggestions import MOST_POINTS, Candidate, Spot, has_numbers
from sequence_planner.model.stages.support import ImmediateStage, briefly, values_of, wanted_type
from sequence_planner.texts.message import message

# Named parts of a space of numbers: points with a tolerance, and ranges of a single number.

Numbers = tuple[float, ...]


class Regions(Protocol):
    """Named regions. A margin widens a region on every side."""

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, as written."""

    @property
    def axes(self) -> int:
        """The number of numbers that say a place."""

    def find(self, numbers: Numbers) -> str | None:
        """The region in which `numbers` are."""

    def holds(self, name: str, numbers: Numbers, margin: float) -> bool:
        """Return whether `numbers` are in that region, widened by `margin`."""

    def inside(self, name: str) -> Numbers | None:
        """Numbers in that region, and `find` says so; None when there are none."""

    def outside(self, margin: float, start: Numbers | None) -> Numbers | None:
        """Numbers in no region, not even widened by `margin`: `start` or ones near it; None when there are none."""


def numbers_of(raw: object, axes: int) -> Numbers | None:
    """A field's value as a place; None when it is not as many finite numbers as there are axes."""
    numbers = raw if isinstance(raw, list) else [raw]
    if len(numbers) != axes or not all(map(is_number, numbers)):
        return None
    return tuple(map(float, numbers))


def distance(one: Numbers, other: Numbers) -> float:
    """Return how far they are apart on the axis on which they are furthest apart."""
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


@dataclass(frozen=True)
class Points:
    """Points, each of which is reached when every number is within `tolerance` of its own: the nearest of several."""

    points: Mapping[str, Numbers]
    tolerance: float

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, as written."""
        return tuple(self.points)

    @property
    def axes(self) -> int:
        """The number of numbers that say a place."""
        return len(next(iter(self.points.values())))

    def nearest(self, numbers: Numbers) -> str:
        """The nearest point, however far it is."""
        return min(self.points, key=lambda name: distance(self.points[name], numbers))

    def find(self, numbers: Numbers) -> str | None:
        """The point within whose tolerance `numbers` are."""
        name = self.nearest(numbers)
        return name if self.holds(name, numbers, 0.0) else None

    def holds(self, name: str, numbers: Numbers, margin: float) -> bool:
        """Return whether `numbers` are within the tolerance of that point, widened by `margin`."""
        return distance(self.points[name], numbers) <= self.tolerance + margin

    def inside(self, name: str) -> Numbers | None:
        """The point itself."""
        return self.points[name]

    def outside(self, margin: float, start: Numbers | None) -> Numbers | None:
        """`start`, by default the first point, moved along the first axis until it is at no point."""
        numbers = start or next(iter(self.points.values()))
        step = 2 * (self.tolerance + margin)
        while any(self.holds(name, numbers, margin) for name in self.points):
            numbers = (numbers[0] + step, *numbers[1:])
            step *= 2
        return numbers


@dataclass(frozen=True)
class Ranges:
    """Ranges of a single number, bounds included; None where there is no bound. Of two that touch the first counts."""

    ranges: Mapping[str, tuple[float | None, float | None]]

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, as written."""
        return tuple(self.ranges)

    @property
    def axes(self) -> int:
        """One."""
        return 1

    def find(self, numbers: Numbers) -> str | None:
        """The first range in which the number is."""
        return next((name for name in self.ranges if self.holds(name, numbers, 0.0)), None)

    def holds(self, name: str, numbers: Numbers, margin: float) -> bool:
        """Return whether the number is in that range, widened by `margin`."""
        least, greatest = self.ranges[name]
        (number,) = numbers
        return (least is None or least - margin <= number) and (greatest is None or number <= greatest + margin)

    def inside(self, name: str) -> Numbers | None:
        """The middle of that range, or a number well within it where it has one bound or none."""
        least, greatest = self.ranges[name]
        if least is None or greatest is None:
            tried = 0.0 if least is greatest is None else least + 1 if least is not None else (greatest or 0.0) - 1
        else:
            tried = (least + greatest) / 2
        return (tried,) if self.find((tried,)) == name else None

    def outside(self, margin: float, start: Numbers | None) -> Numbers | None:
        """`start`, or a number between two ranges or beyond them."""
        bounds = sorted(bound for pair in self.ranges.values() for bound in pair if bound is not None)
        gaps = [(a + b) / 2 for a, b in pairwise(bounds)]
        beyond = [bounds[0] - 1 - 2 * margin, bounds[-1] + 1 + 2 * margin] if bounds else []
        for tried in [*([] if start is None else start), *gaps, *beyond]:
            if not any(self.holds(name, (tried,), margin) for name in self.ranges):
                return (tried,)
        return None


# `discretise`: from numbers to the name of the region they are in.

Point = Annotated[list[float], Field(min_length=1)]
Coordinates = Mapping[SourceText, Sequence[float]]
Bounds = tuple[float | None, float | None]


class DiscretiseDocument(StageDeclaration):
    """Numbers become the value whose coordinates are within `tolerance` of each, else `otherwise`."""

    kind: ClassVar[str] = "discretise"
    about: ClassVar[str] = "From numbers to the name of a point; for incoming topics."
    direction: ClassVar = "incoming"
    instead: ClassVar[str] = "undiscretise"

    field: MessageField
    """An array of numbers in the message, or a single number."""
    variable: ModelVariable
    """What gets the name of the point."""
    values: Given[NamedMap | dict[GivenValue, Point]] = None
    """The coordinates of each named point; or the name of a map of the station to numbers, of which each is a point."""
    ranges: Annotated[
        Given[dict[GivenValue, Annotated[Bounds, Field(strict=False)]]], ExampleValue({"low": [None, 0]})
    ] = None
    """For a single number: the least and the greatest of each value, `null` where there is no bound."""
    tolerance: Given[Annotated[float, Field(gt=0)]] = None
    """How far from a point each number may be."""
    otherwise: Given[GivenValue] = None
    """The value between points or ranges."""
    hysteresis: Annotated[float, Field(ge=0)] = 0.0
    """How much further than that a number must go for the value to be left again."""

    @model_validator(mode="after")
    def _points_or_ranges(self) -> DiscretiseDocument:
        if (self.values is None) == (self.ranges is None):
            raise ValueError(message("form.discretise"))
        if self.values is not None and (self.tolerance is None or self.otherwise is None):
            raise ValueError(message("form.discretise-values"))
        if self.ranges is not None and self.tolerance is not None:
            raise ValueError(message("form.discretise-ranges"))
        return self

    def check(self, context: Context) -> DiscretiseStage | None:
        """From numbers to names."""
        if not self.is_for(context):
            return None
        found = context.field(self.field)
        points = points_of(self.values, context)
        if points is None:
            return None
        names = [*(points or self.ranges or {})]
        names += [] if self.otherwise is None else [self.otherwise]
        type_ = wanted_type(context, self.variable) or EnumerationType(tuple(dict.fromkeys(map(str, names))))
        named = _are_names(context, self.field, names, type_)
        if found is None or not named or not isinstance(type_, EnumerationType):
            return None
        path, field = found
        regions = _regions(self, points, field, context)
        if regions is None:
            return None
        otherwise = None if self.otherwise is None else str(self.otherwise)
        variable, hysteresis = str(self.variable), self.hysteresis
        return DiscretiseStage(context.place, path, variable, type_, regions, otherwise, hysteresis, field)

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects(has_numbers):
            for name, values, declares in _named(path, spot):
                made: dict[str, object] = {"field": path, "variable": name}
                if isinstance(type_, ListType):
                    points = {value: [float(index)] * (type_.length or 1) for index, value in enumerate(values[:-1])}
                    made |= {"values": points, "tolerance": 0.1, "otherwise": values[-1]}
                else:
                    low = type_.minimum if isinstance(type_, IntegerRange) else 0
                    bounds = [None, *(float(low + index) for index in range(1, len(values))), None]
                    made["ranges"] = {value: [bounds[index], bounds[index + 1]] for index, value in enumerate(values)}
                yield Candidate({cls.kind: made}, declares)


def points_of(values: SourceText | Coordinates | None, context: Context) -> Coordinates | None:
    """Points as they are written, or those that a map of the station has on one axis; None after a finding."""
    if not isinstance(values, SourceText):
        return values or {}
    if (found := context.named(values, context.vocabulary.maps)) is None:
        return None
    if not isinstance(found.target, IntegerRange):
        said = message("wrong.map-to-points", name=str(values), type=briefly(found.target))
        context.found(values.place, said)
        return None
    return {SourceText(name, values.place, name): [float(at)] for name, at in found.table.items()}


def _regions(document: DiscretiseDocument, values: Coordinates, field: FieldType, context: Context) -> Regions | None:
    if document.ranges is not None:
        if not is_numeric(field):
            context.found(
                document.field.place, message("wrong.ranges-of-number", name=str(document.field), type=str(field))
            )
            return None
        return _ranges(document.ranges, context)
    tolerance = document.tolerance or 0.0
    if not _fit(context, document.field, values, field) or not _are_apart(context, values, tolerance):
        return None
    return Points({str(name): tuple(point) for name, point in values.items()}, tolerance)


def _fit(context: Context, name: SourceText, values: Coordinates, field: FieldType) -> bool:
    """Check whether points have as many coordinates as the field has numbers, and no two are the same."""
    element = field.element if isinstance(field, ListType) else field
    if not is_numeric(element):
        context.found(name.place, message("wrong.no-numbers", name=str(name), type=str(field)))
        return False
    lengths = {len(point) for point in values.values()}
    length = field.length if isinstance(field, ListType) else 1
    if len(lengths) != 1 or length not in (None, *lengths):
        context.found(name.place, message("wrong.coordinates", name=str(name), type=str(field)))
        return False
    first: dict[tuple[float, ...], SourceText] = {}
    twins = [(point, twin) for point, at in values.items() if (twin := first.setdefault(tuple(at), point)) is not point]
    for point, twin in twins:
        context.found(point.place, message("wrong.same-coordinates", name=str(point), other=str(twin)))
    return not twins


def _are_apart(context: Context, values: Coordinates, tolerance: float) -> bool:
    near = [
        (one, other, apart)
        for (one, here), (other, there) in combinations(values.items(), 2)
        if (apart := distance(tuple(here), tuple(there))) <= tolerance
    ]
    for one, other, apart in near:
        near_by = message(
            "wrong.too-near", name=str(other), distance=f"{apart:g}", other=str(one), tolerance=f"{tolerance:g}"
        )
        context.found(other.place, near_by)
    return not near


def _ranges(ranges: Mapping[SourceText, Bounds], context: Context) -> Ranges | None:
    wrong = not ranges
    if not ranges:
        context.found(context.place, message("wrong.no-ranges"))
    for name, (least, greatest) in ranges.items():
        if least is not None and greatest is not None and least > greatest:
            context.found(name.place, message("wrong.backward-range", name=str(name)))
            wrong = True
    for (one, here), (other, there) in combinations(ranges.items(), 2):
        if not wrong and _overlap(here, there):
            context.found(other.place, message("wrong.overlapping-ranges", name=str(other), other=str(one)))
            wrong = True
    return None if wrong else Ranges({str(name): bounds for name, bounds in ranges.items()})


def _overlap(one: Bounds, other: Bounds) -> bool:
    """Return whether two ranges have more than one number in common."""
    least = max((bound for bound in (one[0], other[0]) if bound is not None), default=None)
    greatest = min((bound for bound in (one[1], other[1]) if bound is not None), default=None)
    return least is None or greatest is None or least < greatest


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
    is_timed: ClassVar[bool] = False

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
class DiscretiseCourse(StageInstance):
    """Knows in which region the numbers were last."""

    stage: DiscretiseStage
    last: str | None = None

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


def _named(path: str, spot: Spot) -> Iterator[tuple[str, tuple[str, ...], dict[str, str]]]:
    """The variables with names that a field could become, with their values, and what must be declared for them."""
    for name, wanted in spot.open.items():
        if isinstance(wanted, EnumerationType) and 1 < len(wanted.values) <= MOST_POINTS:
            yield name, wanted.values, {}
    for enumeration, values in spot.enumerations.items():
        if 1 < len(values) <= MOST_POINTS:
            name = spot.name(f"{path}_{enumeration}")
            yield name, values, {name: enumeration}


# `undiscretise`: from the name of a point to its numbers.


class UndiscretiseDocument(StageDeclaration):
    """A value becomes its coordinates."""

    kind: ClassVar[str] = "undiscretise"
    about: ClassVar[str] = "From the name of a point to its numbers; for outgoing topics."
    direction: ClassVar = "outgoing"
    instead: ClassVar[str] = "discretise"

    variable: ModelVariable
    """The variable whose value names a point."""
    field: MessageField
    """The array of numbers in the message."""
    values: NamedMap | dict[ReadValue, Point]
    """The coordinates of every value; or the name of a map of the station to numbers, of which each is a point."""

    def check(self, context: Context) -> UndiscretiseStage | None:
        """From names to numbers."""
        if not self.is_for(context):
            return None
        found = context.field(self.variable)
        values = points_of(self.values, context)
        if values is None:
            return None
        axes = {len(point) for point in values.values()}
        field = wanted_type(context, self.field) or ListType(REAL, next(iter(axes)) if len(axes) == 1 else None)
        fits = _fit(context, self.field, values, field)
        if found is None or not _are_names(context, self.field, values, found[1]) or not fits:
            return None
        path, type_ = found
        missing = sorted(set(type_.values if isinstance(type_, EnumerationType) else ()) - set(map(str, values)))
        if missing:
            context.found(self.variable.place, message("wrong.no-coordinates", names=", ".join(missing)))
            return None
        element = field.element if isinstance(field, ListType) else field
        points = {str(name): _coordinates(context, name, at, element) for name, at in values.items()}
        known = {name: point for name, point in points.items() if point is not None}
        return UndiscretiseStage(context.place, path, str(self.field), field, known) if known == points else None

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects(lambda each: isinstance(each, EnumerationType)):
            assert isinstance(type_, EnumerationType)
            for name, wanted in spot.open.items():
                axes = (wanted.length or 1) if isinstance(wanted, ListType) else 1
                if has_numbers(wanted):
                    values = {value: [float(index)] * axes for index, value in enumerate(type_.values[:MOST_POINTS])}
                    yield Candidate({cls.kind: {"variable": path, "field": name, "values": values}})

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        content = {"variable": name, "field": spot.target, "values": {"low": [0.0]}}
        return content if spot.open or spot.is_incoming else None


def _coordinates(context: Context, name: SourceText, at: Sequence[float], type_: FieldType) -> Numbers | None:
    """A point as it is sent; None, and findings, where the field cannot have it."""
    if not isinstance(type_, IntegerRange):
        return tuple(at)
    strange = [number for number in at if not number.is_integer() or not type_.minimum <= number <= type_.maximum]
    for number in strange:
        context.found(name.place, message("wrong.coordinate", name=str(name), number=f"{number:g}", range=str(type_)))
    return None if strange else tuple(map(int, at))


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


# What both have in common: points with names, and numbers as a field has them.


def _are_names(context: Context, where: SourceText, names: Iterable[SourceText], type_: FieldType) -> bool:
    if not isinstance(type_, EnumerationType):
        context.found(where.place, message("wrong.points-have-names", type=str(type_)))
        return False
    return values_of(context, type_, list(names), where.place) is not None


def _of_type(numbers: Numbers, type_: FieldType) -> Numbers:
    """`numbers` as the field can have them: rounded where it has integers."""
    element = type_.element if isinstance(type_, ListType) else type_
    return tuple(map(round, numbers)) if isinstance(element, IntegerRange) else numbers


def _as_field(numbers: Numbers, type_: FieldType) -> object:
    return list(numbers) if isinstance(type_, ListType) else numbers[0]
