"""Values of fields: whether they are of a type, how they are written in documents, and how they are shown to people."""

from __future__ import annotations

import math
import reprlib
import sys
from collections.abc import Iterable

from sequence_planner.expressions.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, contains
from sequence_planner.pipelines.record import FieldType, ListType, NestedType, RealType, TextType

REAL = RealType()
TEXT = TextType()

LONGEST_SHOWN = 60  # characters of a value in what is told to people
MOST_VALUES = 256  # of an integer that is tried value by value

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = LONGEST_SHOWN


def shown(value: object) -> str:
    """`value` for people, shortened: what a device sends may be of any length."""
    text = _SHORT.repr(value)
    return text if len(text) <= LONGEST_SHOWN else f"{text[: LONGEST_SHOWN - 3]}..."


def as_written(value: object) -> str:
    """`value` as a document has it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def is_number(value: object) -> bool:
    """Whether `value` is a finite number, of a size that a real one can have; a truth value is none."""
    if isinstance(value, float):
        return math.isfinite(value)
    return isinstance(value, int) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def fits(type_: FieldType, value: object) -> bool:
    """Whether `value` is one of `type_`."""
    match type_:
        case RealType():
            return is_number(value)
        case TextType():
            return isinstance(value, str)
        case ListType(element, length):
            if not isinstance(value, list) or length not in (None, len(value)):
                return False
            return all(fits(element, item) for item in value)
        case NestedType(_, fields):
            if not isinstance(value, dict):
                return False
            return all(name in fields and fits(fields[name], part) for name, part in value.items())
    return contains(type_, value)


def is_numeric(type_: FieldType) -> bool:
    """Whether the values of `type_` are numbers."""
    return isinstance(type_, RealType | IntegerRange)


def is_textual(type_: FieldType) -> bool:
    """Whether the values of `type_` are texts, or names."""
    return isinstance(type_, TextType | EnumerationType)


def written(type_: FieldType, value: object) -> object:
    """What `value`, as a document has it, means where a value of `type_` stands; None when it is none.

    Keys of a document are texts whatever they mean, so a text is also read as a number or a truth value.
    """
    meant: object = value
    if isinstance(value, str):
        meant = str(value)
        if isinstance(type_, BooleanType):
            meant = {"true": True, "false": False}.get(meant)
        elif is_numeric(type_):
            meant = _number(meant, type_)
    return meant if fits(type_, meant) else None


def _number(text: str, type_: FieldType) -> int | float | None:
    try:
        return int(text) if isinstance(type_, IntegerRange) else float(text)
    except ValueError:
        return None


def common_type(values: Iterable[object]) -> FieldType | None:
    """The narrowest type that has all of `values`; None when they are of different kinds."""
    known = list(values)
    if all(isinstance(value, bool) for value in known):
        return BOOLEAN
    if all(isinstance(value, str) for value in known):
        return EnumerationType(tuple(dict.fromkeys(str(value) for value in known)))
    numbers = [value for value in known if isinstance(value, int | float) and not isinstance(value, bool)]
    if len(numbers) != len(known):
        return None
    integers = [value for value in numbers if isinstance(value, int)]
    return IntegerRange(min(integers), max(integers)) if len(integers) == len(numbers) else REAL


def domain(type_: FieldType) -> tuple[object, ...] | None:
    """All values of a type with few of them; None for any other."""
    if isinstance(type_, IntegerRange) and type_.maximum - type_.minimum >= MOST_VALUES:
        return None
    return type_.domain if isinstance(type_, BooleanType | EnumerationType | IntegerRange) else None
