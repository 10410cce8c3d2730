"""What the builders have in common: types of names, values as written, and complaints about them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import BooleanType, EnumerationType, IntegerRange
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.context import Context
from sequence_planner.pipelines.paths import FieldPath, NoFieldError, find_field
from sequence_planner.pipelines.record import FieldType
from sequence_planner.pipelines.stages.transparent import Passing
from sequence_planner.pipelines.stages.values import (
    as_written,
    common_type,
    domain,
    is_numeric,
    is_textual,
    shown,
    written,
)


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
    """Whether a value of the one type may be one of the other."""
    if isinstance(one, IntegerRange) or isinstance(other, IntegerRange):
        return is_numeric(one) and is_numeric(other)
    return type(one) is type(other) or (is_textual(one) and is_textual(other))


def place_of(values: Iterable[object], otherwise: Place) -> Place:
    """Where the first text among `values` stands."""
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
        text = as_written(value)
        what = f"none of {type_}" if isinstance(type_, EnumerationType | BooleanType) else f"no value of type {type_}"
        context.found(place_of([value], place), f"`{text}` is {what}{near}")
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
        context.found(name.place, f"the values of `{name}` are of different kinds: {kinds}")
    return type_


def passing(context: Context, names: Iterable[SourceText]) -> tuple[Passing, ...] | None:
    """The fields of these names; None, and findings, when some do not exist."""
    found = [context.field(name) for name in names]
    known = [Passing(*field) for field in found if field is not None]
    return tuple(known) if len(known) == len(found) else None


def only(context: Context, place: Place, incoming: bool, kind: str, instead: str = "") -> bool:
    """Whether the stage is of the right direction; a finding when it is not."""
    if context.is_incoming is not incoming:
        use = f"; use `{instead}` here" if instead else ""
        context.found(place, f"`{kind}` is for {'incoming' if incoming else 'outgoing'} topics{use}")
    return context.is_incoming is incoming
