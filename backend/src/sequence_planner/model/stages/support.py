"""Base classes and helpers of stages: builder context, stateless stages, inversion by trial."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import ClassVar

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import (
    FieldPath,
    NoFieldError,
    as_written,
    common_type,
    domain,
    find_field,
    fits,
    is_numeric,
    is_textual,
    shown,
    written,
)
from sequence_planner.language.records.record import FieldType, ListType, RealType, Record, TextType
from sequence_planner.language.types import BooleanType, EnumerationType, IntegerRange, Place
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, NotInvertibleError, Stage, StageDeclaration, StageInstance
from sequence_planner.model.stages.marks import Marked, NameMark, NameUse
from sequence_planner.texts.message import message

# Stages that remember nothing: what goes on is decided by the record alone, and at once.


@dataclass(frozen=True, slots=True)
class ImmediateCourse(StageInstance):
    """The course of a stage that changes each record and lets it go on."""

    apply: Callable[[Record], None]

    def take(self, record: Record, now: float) -> Record:
        """The record with what the stage gives."""
        self.apply(record)
        return record


@dataclass(frozen=True)
class ImmediateStage(ABC):
    """A stage without a memory."""

    place: Place
    is_timed: ClassVar[bool] = False

    @abstractmethod
    def apply(self, record: Record) -> None:
        """Add to `record` what the stage gives; it is unknown where that cannot be said."""

    def begin(self) -> StageInstance:
        """Its course, which has nothing to remember."""
        return ImmediateCourse(self.apply)


# Reading a stage backwards by trying: which values of its fields give what is wanted.

MOST_TRIED = 5000
MOST_NAMED = 5  # values of an enumeration in a finding


def candidates(type_: FieldType, mentioned: Iterable[object]) -> list[object]:
    """Values of a type worth trying: all of few; else those that are mentioned, and some about them."""
    known = [value for value in mentioned if value is not None]
    if (few := domain(type_)) is not None:
        return list(dict.fromkeys((*(value for value in known if fits(type_, value)), *few)))
    if isinstance(type_, TextType):
        texts = [value for value in known if isinstance(value, str)]
        return [*dict.fromkeys(texts), _other_text(texts)]
    if isinstance(type_, RealType | IntegerRange):
        numbers = [value for value in known if isinstance(value, int | float) and not isinstance(value, bool)]
        around = [number + step for number in numbers for step in (0, 1, -1)]
        return list(dict.fromkeys(value for value in (*numbers, 0, 1, *around) if fits(type_, value)))
    return [[]] if isinstance(type_, ListType) else []


def _other_text(texts: Sequence[str]) -> str:
    """A text that contains none of `texts`, and begins and ends as none of them."""
    tried = ("", "other", "-", "~")
    return next((text for text in tried if not any((known and known in text) or known == text for known in texts)), "·")


def put_at(record: dict[str, object], steps: Sequence[str | int], value: object) -> None:
    """Put `value` into a record under a path of names and indices, with all that must be around it."""
    within: dict[str, object] | list[object] = record
    for step, following in zip(steps, (*steps[1:], None), strict=True):
        inner: object = value
        if following is not None:
            inner = _at(within, step) or ([] if isinstance(following, int) else {})
        if isinstance(within, list) and isinstance(step, int):
            within.extend([None] * (step + 1 - len(within)))
            within[step] = inner
        elif isinstance(within, dict):
            within[str(step)] = inner
        if isinstance(inner, dict | list):
            within = inner


def _at(within: dict[str, object] | list[object], step: str | int) -> object:
    if isinstance(within, dict):
        return within.get(str(step))
    return within[step] if isinstance(step, int) and step < len(within) else None


def solve(
    tried: Mapping[str, Sequence[object]],
    agrees: Callable[[Mapping[str, object]], bool],
    values: dict[str, object],
    gives: Iterable[str],
    complaint: str,
) -> None:
    """Add to `values` the first combination of `tried` that agrees; fields that are in `values` already stay.

    Names in `gives` have there what the stage gives, and say nothing about a field of that name before it.
    Raises `NotInvertibleError` with `complaint` when there is no combination among the first five thousand.
    """
    known = {name: value for name, value in values.items() if value is not None and name not in gives}
    options = [[known[name]] if name in known else list(some) for name, some in tried.items()]
    for combination in islice(product(*options), MOST_TRIED):
        given = dict(zip(tried, combination, strict=True))
        if agrees(given):
            values |= given
            return
    raise NotInvertibleError(complaint)


# Types in findings about tables of the station.


def briefly(type_: FieldType) -> str:
    """A type for people, of which not all of many values are named."""
    if isinstance(type_, EnumerationType) and len(type_.values) > MOST_NAMED:
        first = ", ".join(type_.values[: MOST_NAMED - 1])
        return f"{{{first}, … {type_.values[-1]}}}"
    return str(type_)


# Stages through which the same fields pass, with other values or at other times.


@dataclass(frozen=True)
class Passing:
    """A field that a stage may hold back, with its type."""

    path: FieldPath
    type: FieldType


class PassingDeclaration(StageDeclaration):
    """A stage that gives the fields which it keeps, each from itself alone.

    Where it is not timed, the same record again makes no difference to it.
    """

    is_timed: ClassVar[bool] = True

    def check(self, context: Context) -> Stage | None:
        """The stage with its fields, each of which must be there and fit."""
        fields = self.passing(context) if self.is_for(context) else None
        return None if fields is None else PassingStage(context.place, fields, self)

    def passing(self, context: Context) -> tuple[Passing, ...] | None:
        """The fields that are kept; None, and findings, when some do not exist or fit."""
        return passing(context, self.marked(self))

    @abstractmethod
    def begin(self, stage: PassingStage) -> StageInstance:
        """Start it afresh, with nothing remembered."""


@dataclass(frozen=True)
class PassingStage:
    """A stage that gives what it reads. Read backwards nothing has to be added."""

    place: Place
    fields: tuple[Passing, ...]
    written: PassingDeclaration

    @property
    def kind(self) -> str:
        """The key by which documents name it."""
        return self.written.kind

    @property
    def is_timed(self) -> bool:
        """True if the same record again is news."""
        return self.written.is_timed

    @property
    def reads(self) -> frozenset[str]:
        """The fields it may hold back."""
        return frozenset(field.path.text for field in self.fields)

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The same."""
        return {field.path.text: field.type for field in self.fields}

    def begin(self) -> StageInstance:
        """Start it afresh, with nothing remembered."""
        return self.written.begin(self)

    def get(self, record: Record) -> tuple[object, ...]:
        """The values of the fields."""
        return tuple(field.path.read(record.values, record.troubles) for field in self.fields)

    def put(self, record: Record, values: tuple[object, ...]) -> Record:
        """Give `values` to the fields."""
        record.values.update(zip((field.path.text for field in self.fields), values, strict=True))
        return record

    def backwards(self, values: dict[str, object]) -> None:
        """Leave the values as they are: what it gives is what it reads."""


def again(record: Record) -> Record:
    """`record` once more; what made no sense in it has been said."""
    return Record(dict(record.values))


# What the builders have in common: types of names, values as written, and complaints about them.


def wanted_type(context: Context, name: str) -> FieldType | None:
    """The type that `name` has where it is used at the end; None where there is no such use."""
    try:
        return find_field(context.wanted, name)[1]
    except NoFieldError:
        return None


def narrowest(context: Context, path: FieldPath, type_: FieldType) -> FieldType:
    """The type of a field, as the variable of its name has it if there is one."""
    wanted = context.wanted.get(path.text)
    is_narrow = isinstance(wanted, EnumerationType) or (wanted is not None and domain(wanted) is not None)
    return wanted if wanted is not None and is_narrow and are_alike(type_, wanted) else type_


def are_alike(one: FieldType, other: FieldType) -> bool:
    """Return whether a value of the one type may be one of the other."""
    if isinstance(one, IntegerRange) or isinstance(other, IntegerRange):
        return is_numeric(one) and is_numeric(other)
    return type(one) is type(other) or (is_textual(one) and is_textual(other))


def place_of(values: Iterable[object], otherwise: Place) -> Place:
    """Return where the first text among `values` stands."""
    return next((value.place for value in values if isinstance(value, SourceText)), otherwise)


def plain(value: object) -> object:
    """`value` without the places of its texts."""
    match value:
        case Mapping():
            return {str(key): plain(entry) for key, entry in value.items()}
        case list():
            return [plain(entry) for entry in value]
        case SourceText():
            return str(value)
    return value


def value_of(context: Context, type_: FieldType, value: object, place: Place) -> object:
    """`value` as one of `type_`; None, and a finding, when it is none."""
    meant = written(type_, value)
    if meant is None:
        near = suggestion(str(value), type_.values) if isinstance(type_, EnumerationType) else ""
        id_ = "wrong.none-of" if isinstance(type_, EnumerationType | BooleanType) else "wrong.no-value"
        said = message(id_, value=as_written(value), type=str(type_), hint=near)
        context.found(place_of([value], place), said)
    return meant


def values_of(context: Context, type_: FieldType, values: Sequence[object], place: Place) -> list[object] | None:
    """All of `values` as ones of `type_`; None, and findings, when some are none."""
    meant = [value_of(context, type_, value, place) for value in values]
    return None if None in meant else meant


def type_for(context: Context, name: SourceText, values: Iterable[object]) -> FieldType | None:
    """The type of what a stage gives: that of its use, else the narrowest with all values; a finding when none is."""
    known = [plain(value) for value in values]
    type_ = wanted_type(context, name) or common_type(known)
    if type_ is None:
        kinds = ", ".join(shown(value) for value in known)
        context.found(name.place, message("wrong.different-kinds", name=str(name), values=kinds))
    return type_


def passing(context: Context, written: Iterable[Marked]) -> tuple[Passing, ...] | None:
    """The fields among what is written; None, and findings, when some do not exist, or are not what the stage needs."""
    known = []
    is_sound = True
    for text, _, mark in written:
        if not isinstance(mark, NameMark) or mark.use(context.is_incoming) is NameUse.GIVEN:
            continue
        found = context.field(text)
        if found is not None and mark.fits is not None and not mark.fits(found[1]):
            context.found(text.place, message("wrong.must-be", name=str(text), what=mark.what, type=str(found[1])))
            found = None
        is_sound = is_sound and found is not None
        if found is not None:
            known.append(Passing(*found))
    return tuple(known) if is_sound else None
