"""Stages with memory or time: `remember`, `debounce`, `limit`, `tick`, `override`, `fold`, `timeout`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from pydantic import Field, model_validator

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import (
    FieldPath,
    as_written,
    domain,
    fits,
    is_numeric,
    shown,
    written,
)
from sequence_planner.language.records.record import FieldType, ListType, RealType, Record
from sequence_planner.language.types import EnumerationType, IntegerRange, Place
from sequence_planner.model.fields import DocumentPart, Given
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, Override, StageDeclaration, StageInstance
from sequence_planner.model.stages.map import is_same
from sequence_planner.model.stages.marks import (
    READ_VALUE,
    ExampleValue,
    KeptField,
    NameMark,
    NameUse,
    ReadField,
    Scalar,
)
from sequence_planner.model.stages.suggestions import MOST_POINTS, MOST_SUBJECTS, Candidate, Spot, some_values
from sequence_planner.model.stages.support import (
    Passing,
    PassingDeclaration,
    PassingStage,
    again,
    are_alike,
    narrowest,
    values_of,
    wanted_type,
)
from sequence_planner.texts.message import message

Period = Annotated[float, Field(gt=0, le=86_400)]
KeptFields = Annotated[list[KeptField], Field(min_length=1)]
_NOTHING = Record({})

# `remember`: values of earlier records.


class RememberDocument(StageDeclaration):
    """A variable keeps the last value of another, but for the values in `except`."""

    kind: ClassVar[str] = "remember"
    about: ClassVar[str] = "Keep the last value of another variable; for incoming topics."
    direction: ClassVar = "incoming"

    variable: Annotated[SourceText, NameMark(NameUse.GIVEN, NameUse.GIVEN, alike=True)]
    """The variable that keeps the value."""
    of: ReadField
    """The field or variable, of the same pipeline, whose value is kept."""
    ignored: list[Annotated[SourceText, READ_VALUE]] = Field(default_factory=list, alias="except")
    """Values that are not kept."""

    def check(self, context: Context) -> RememberStage | None:
        """A variable that keeps the last value of another."""
        if not self.is_for(context):
            return None
        found = context.field(self.of)
        if found is None:
            return None
        path, given = found
        of = narrowest(context, path, given)
        type_ = wanted_type(context, self.variable) or of
        if not are_alike(of, type_):
            said = message(
                "wrong.unlike", name=str(path), type=str(of), other=str(self.variable), other_type=str(type_)
            )
            context.found(self.of.place, said)
            return None
        ignored = {value: written(of, value) for value in self.ignored}
        for value, meant in ignored.items():
            if meant is None:
                near = suggestion(value, of.values) if isinstance(of, EnumerationType) else ""
                context.found(
                    value.place, message("wrong.no-value-of-field", value=str(value), name=str(self.of), hint=near)
                )
        kept = set(domain(of) or ()) - set(ignored.values())
        if (holds := domain(type_)) is not None and (extra := kept - set(holds)):
            names = ", ".join(sorted(map(as_written, extra)))
            context.found(self.variable.place, message("wrong.put-into-except", name=str(self.variable), values=names))
            return None
        if None in ignored.values():
            return None
        return RememberStage(context.place, str(self.variable), type_, path, frozenset(ignored.values()))

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path, type_ in spot.subjects():
            narrow = spot.open.get(path, type_)
            if (written := spot.type_name(narrow)) is not None:
                name = spot.name(f"last_{path}")
                yield Candidate({cls.kind: {"variable": name, "of": path}}, {name: written})


@dataclass(frozen=True)
class RememberStage:
    """A variable keeps the last known value of another field, but for those that are ignored."""

    place: Place
    variable: str
    type: FieldType
    of: FieldPath
    ignored: frozenset[object]
    kind: ClassVar[str] = "remember"
    is_timed: ClassVar[bool] = False

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
class RememberCourse(StageInstance):
    """Has the value that is kept."""

    stage: RememberStage
    kept: object = None

    def take(self, record: Record, now: float) -> Record:
        """The record with the value kept, after this one has been looked at."""
        value = self.stage.of.read(record.values, record.troubles)
        if value is not None and value not in self.stage.ignored:
            self.kept = value
        record.values[self.stage.variable] = self.kept
        return record


# `debounce`, `limit` and `tick`: when values count, and when records go on.


class DebounceDocument(PassingDeclaration):
    """A new value counts when it has been there for some time; until then the old one does."""

    kind: ClassVar[str] = "debounce"
    about: ClassVar[str] = "A new value counts when it has been there for some time; for incoming topics."
    direction: ClassVar = "incoming"

    fields: KeptFields
    """The fields, which change together."""
    seconds: Annotated[Period, ExampleValue(0.1)]
    """How long it must have been there."""

    def begin(self, stage: PassingStage) -> StageInstance:
        """Begin with no value that counts."""
        return DebounceCourse(stage, self.seconds)


@dataclass(slots=True)
class DebounceCourse(StageInstance):
    """Has the values that count and, with the time when they came, those that may soon.

    The first one counts at once, for there is no old one; what becomes unknown is so at once.
    """

    stage: PassingStage
    seconds: float
    due: float | None = None
    _counting: tuple[object, ...] | None = None
    _coming: tuple[object, ...] = ()
    _last: Record = field(default_factory=lambda: _NOTHING)

    def take(self, record: Record, now: float) -> Record:
        """The record with the values that count."""
        self._settle(now)
        values = self.stage.get(record)
        counting = values if self._counting is None else self._counting
        counting = tuple(None if new is None else old for old, new in zip(counting, values, strict=True))
        if values == counting:
            self.due = None
        elif self.due is None or values != self._coming:
            self._coming, self.due = values, now + self.seconds
        self._counting = counting
        self._last = again(record)
        return self.stage.put(record, counting)

    def wake(self, now: float) -> Record | None:
        """The last record with the values that have been there for long enough."""
        return self.stage.put(again(self._last), self._counting or ()) if self._settle(now) else None

    def _settle(self, now: float) -> bool:
        if self.due is None or now < self.due:
            return False
        self._counting, self.due = self._coming, None
        return True


class EveryDocument(DocumentPart):
    """A period."""

    every: Period
    """Seconds between two records."""


class LimitDocument(PassingDeclaration):
    """At most one record in a period, the newest; the last one held back goes on when its time comes."""

    kind: ClassVar[str] = "limit"
    about: ClassVar[str] = "At most one record per time, the newest."
    is_bare: ClassVar[bool] = True

    period: Annotated[EveryDocument, ExampleValue({"every": 1.0})]

    def begin(self, stage: PassingStage) -> StageInstance:
        """Begin with the way free."""
        return LimitCourse(self.period.every)


@dataclass(slots=True)
class LimitCourse(StageInstance):
    """Has the record held back, and from when on the next may go."""

    every: float
    _free: float | None = None
    _held: Record | None = None

    @property
    def due(self) -> float | None:
        """The time at which the record held back may go."""
        return None if self._held is None else self._free

    def take(self, record: Record, now: float) -> Record | None:
        """The record, if enough time has passed since the last."""
        if self._held is not None:  # what made no sense is not lost with the record that is
            record.troubles = record.troubles or self._held.troubles
        self._held = record
        return self.wake(now)

    def wake(self, now: float) -> Record | None:
        """The record held back, if its time has come."""
        if self._held is None or (self._free is not None and now < self._free):
            return None
        record, self._held = self._held, None
        self._free = now + self.every
        return record


class TickDocument(PassingDeclaration):
    """The last record again, a period after it last went on."""

    kind: ClassVar[str] = "tick"
    about: ClassVar[str] = "The last record again, every so often."
    is_bare: ClassVar[bool] = True

    period: Annotated[EveryDocument, ExampleValue({"every": 1.0})]

    def begin(self, stage: PassingStage) -> StageInstance:
        """Begin with no record."""
        return TickCourse(self.period.every)


@dataclass(slots=True)
class TickCourse(StageInstance):
    """Has the last record."""

    every: float
    due: float | None = None
    _last: Record = field(default_factory=lambda: _NOTHING)

    def take(self, record: Record, now: float) -> Record:
        """The record, at once."""
        self._last = again(record)
        self.due = now + self.every
        return record

    def wake(self, now: float) -> Record | None:
        """The last record again."""
        if self.due is None or now < self.due:
            return None
        self.due = now + self.every
        return again(self._last)


# `override`: a person's live values, within bounds, for a while.


class BoundsDocument(DocumentPart):
    """Which values a person may give to a field."""

    between: Given[Annotated[tuple[float, float], Field(strict=False)]] = None
    """The least and the greatest number."""
    among: Given[Annotated[list[Annotated[Scalar, READ_VALUE]], Field(min_length=1)]] = Field(default=None, alias="in")
    """The values themselves."""

    @model_validator(mode="after")
    def _one_kind(self) -> BoundsDocument:
        if (self.between is None) == (self.among is None):
            raise ValueError(message("form.bounds"))
        if self.between is not None and self.between[0] > self.between[1]:
            raise ValueError(message("form.between"))
        return self


class OverrideDocument(PassingDeclaration):
    """A person's live values for some fields, within bounds, for a while."""

    kind: ClassVar[str] = "override"
    about: ClassVar[str] = "A person's live values, within bounds."

    name: SourceText
    """What it is called where it is set."""
    fields: Annotated[dict[KeptField, BoundsDocument], Field(min_length=1)]
    """The fields, each with the values allowed."""
    expires: Period
    """Seconds after which it is gone."""

    def check(self, context: Context) -> OverrideStage | None:
        """Fields that a person may set. One that no record has yet must be a field of the message."""
        fields: list[Passing] = []
        bounds: dict[str, Bounds] = {}
        for name, written_bounds in self.fields.items():
            wanted = wanted_type(context, name)
            is_new = not context.is_incoming and wanted is not None and str(name) not in context.fields
            found = (FieldPath(str(name), str(name)), wanted) if is_new and wanted is not None else context.field(name)
            if found is None:
                continue
            path, type_ = found
            allowed = _bounds(context, name, written_bounds, narrowest(context, path, type_))
            if allowed is not None:
                fields.append(Passing(path, type_))
                bounds[str(name)] = allowed
        if len(fields) != len(self.fields):
            return None
        return OverrideStage(context.place, tuple(fields), self, bounds)

    def begin(self, stage: PassingStage) -> StageInstance:
        """Begin with nothing set."""
        assert isinstance(stage, OverrideStage)
        return OverrideCourse(stage)

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        among = spot.leaves if spot.is_incoming else [*spot.open.items(), *spot.leaves]
        for path, type_ in among[:MOST_SUBJECTS]:
            bounds: dict[str, object] | None = None
            if isinstance(type_, RealType):
                bounds = {"between": [0.0, 1.0]}
            elif not isinstance(type_, ListType) and (values := some_values(type_)):
                bounds = {"in": values[:MOST_POINTS]}
            if bounds is not None:
                yield Candidate({cls.kind: {"name": spot.name(path), "fields": {path: bounds}, "expires": 60}})

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        return {"name": spot.name(name), "fields": {name: {"in": [0]}}, "expires": 60}


def _bounds(context: Context, name: SourceText, document: BoundsDocument, type_: FieldType) -> Bounds | None:
    if document.between is None:
        among = values_of(context, type_, document.among or [], name.place)
        return None if among is None else Bounds(among=tuple(among))
    if not is_numeric(type_):
        context.found(name.place, message("wrong.not-between", name=str(name), type=str(type_)))
        return None
    return Bounds(document.between) if _reachable(context, name.place, document.between, type_) else None


def _reachable(context: Context, place: Place, between: tuple[float, float], type_: FieldType) -> bool:
    if not isinstance(type_, IntegerRange):
        return True
    beyond = [bound for bound in between if not type_.minimum <= bound <= type_.maximum]
    for bound in beyond:
        context.found(place, message("wrong.field-range", range=str(type_), value=f"{bound:g}"))
    return not beyond


@dataclass(frozen=True)
class Bounds:
    """The values that are allowed: the numbers `between` two, or one of `among`."""

    between: tuple[float, float] | None = None
    among: tuple[object, ...] = ()

    def allow(self, type_: FieldType, value: object) -> bool:
        """Return whether a field of `type_` may be given `value`."""
        if not fits(type_, value):
            return False
        if self.between is None:
            return any(is_same(value, allowed) for allowed in self.among)
        return isinstance(value, int | float) and self.between[0] <= value <= self.between[1]

    def described(self, type_: FieldType) -> str:
        """Say, for people, what a field of `type_` may be given."""
        if self.between is None:
            return f"one of {', '.join(map(as_written, self.among))}"
        kind = "an integer" if isinstance(type_, IntegerRange) else "a number"
        return f"{kind} from {self.between[0]:g} to {self.between[1]:g}"


@dataclass(frozen=True)
class OverrideStage(PassingStage):
    """Fields that a person may set, each within its bounds."""

    written: OverrideDocument
    bounds: Mapping[str, Bounds]

    @property
    def name(self) -> str:
        """What it is called where it is set."""
        return str(self.written.name)

    @property
    def expires(self) -> float:
        """Seconds after which what is set is gone."""
        return self.written.expires

    def check(self, fields: Mapping[str, object]) -> None:
        """Raises ValueError, with what is allowed, unless all of these values are."""
        if not fields:
            raise ValueError(f"nothing is set: `{self.name}` has the fields {', '.join(self.bounds)}")
        for name, value in fields.items():
            if name not in self.bounds:
                near = suggestion(name, self.bounds) or f"; it has {', '.join(self.bounds)}"
                raise ValueError(f"`{self.name}` has no field `{name}`{near}")
            if not self.bounds[name].allow(self.gives[name], value):
                allowed = self.bounds[name].described(self.gives[name])
                raise ValueError(f"`{name}` cannot be {shown(value)}: it is {allowed}")


@dataclass(slots=True)
class OverrideCourse(StageInstance):
    """Has what is set, and the last record as it came."""

    stage: OverrideStage
    override: Override | None = None
    _last: Record | None = None

    @property
    def name(self) -> str:
        """What it is called where it is set."""
        return self.stage.name

    @property
    def due(self) -> float | None:
        """The time at which what is set expires."""
        return None if self.override is None else self.override.until

    def take(self, record: Record, now: float) -> Record:
        """The record with what is set."""
        self._expire(now)
        self._last = again(record)
        return self._apply(record)

    def wake(self, now: float) -> Record | None:
        """The last record as it came, once what was set has expired."""
        return self._repeat() if self._expire(now) else None

    def set_override(self, fields: Mapping[str, object], now: float, actor: str) -> Record | None:
        """Set these fields and no others; returns the last record with them. Raises ValueError: nothing changes."""
        self.stage.check(fields)
        self.override = Override(dict(fields), actor, now + self.stage.expires)
        return self._repeat()

    def clear_override(self, now: float) -> Record | None:
        """Take back what is set; returns the last record as it came."""
        if self.override is None:
            return None
        self.override = None
        return self._repeat()

    def restore(self, override: Override) -> None:
        """Go on with what was set before the pipeline began afresh."""
        self.override = override

    def _expire(self, now: float) -> bool:
        if self.override is None or now < self.override.until:
            return False
        self.override = None
        return True

    def _repeat(self) -> Record | None:
        return None if self._last is None else self._apply(again(self._last))

    def _apply(self, record: Record) -> Record:
        self.stage.put(record, self.stage.get(record))
        if self.override is not None:
            record.values.update(self.override.fields)
        return record


# `fold` and `timeout`: fields of which nothing comes.


class FoldDocument(PassingDeclaration):
    """Fields that are unknown or missing keep the value of the last record that had one."""

    kind: ClassVar[str] = "fold"
    about: ClassVar[str] = "Fields that are unknown keep their last value; an empty list means all."
    is_bare: ClassVar[bool] = True
    is_timed: ClassVar[bool] = False

    fields: list[KeptField]

    def passing(self, context: Context) -> tuple[Passing, ...] | None:
        """Those named, or all."""
        every = (Passing(FieldPath(name, name), type_) for name, type_ in context.fields.items())
        return super().passing(context) if self.fields else tuple(every)

    def begin(self, stage: PassingStage) -> StageInstance:
        """Begin with nothing remembered."""
        return FoldCourse(stage)

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path in list(spot.fields)[:MOST_SUBJECTS]:
            yield Candidate({cls.kind: [path]})
        yield Candidate({cls.kind: []})


@dataclass(slots=True)
class FoldCourse(StageInstance):
    """Has the last known value of each field."""

    stage: PassingStage
    known: dict[str, object] = field(default_factory=dict)

    def take(self, record: Record, now: float) -> Record:
        """The record with what earlier ones said where it says nothing."""
        values = record.values
        given = ((each.path.text, each.path.read(values, record.troubles)) for each in self.stage.fields)
        self.known |= {name: value for name, value in given if value is not None}
        values |= {each.path.text: self.known.get(each.path.text) for each in self.stage.fields}
        return record


class TimeoutDocument(PassingDeclaration):
    """Fields are unknown when no record has come for some time."""

    kind: ClassVar[str] = "timeout"
    about: ClassVar[str] = "Fields are unknown when no record has come for some time; for incoming topics."
    direction: ClassVar = "incoming"

    fields: KeptFields
    """The fields."""
    seconds: Annotated[Period, ExampleValue(1.0)]
    """How long they count."""

    def begin(self, stage: PassingStage) -> StageInstance:
        """Begin with no record."""
        return TimeoutCourse(stage, self.seconds)


@dataclass(slots=True)
class TimeoutCourse(StageInstance):
    """Has the last record, and when it counts no more."""

    stage: PassingStage
    seconds: float
    due: float | None = None
    _last: Record = field(default_factory=lambda: _NOTHING)

    def take(self, record: Record, now: float) -> Record:
        """The record as it is."""
        self._last = again(record)
        self.due = now + self.seconds
        return self.stage.put(record, self.stage.get(record))

    def wake(self, now: float) -> Record | None:
        """The last record, its fields unknown."""
        if self.due is None or now < self.due:
            return None
        self.due = None
        return self.stage.put(again(self._last), (None,) * len(self.stage.fields))
