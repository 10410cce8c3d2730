"""Field paths of records (`joints[0].position`), and types and formats of field values."""

from __future__ import annotations

import math
import re
import reprlib
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.record import FieldType, ListType, NestedType, RealType, RecordType, TextType
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, Type, contains
from sequence_planner.texts.late import message

# Fields of a record by their paths, such as `pose.position.x`, `joints[0]` or `transforms[0].header.frame_id`.
#
# A path is found once, in the types; reading by it is then a few look-ups. What a stage gives is a field by the whole
# of its name, so that `pose.position.x` given by a stage stands before that of the nested message.

_STEP = re.compile(r"\.([A-Za-z_]\w*)|\[(\d+)\]")


@dataclass(frozen=True)
class FieldPath:
    """The path to a field: its key in the record, and from there through nested messages (names) and lists
    (indices).
    """

    text: str
    key: str
    steps: tuple[str | int, ...] = ()

    def get(self, values: Mapping[str, object]) -> object:
        """Its value in a record; None where it is unknown or there is none."""
        value = values.get(self.key)
        for step in self.steps:
            if isinstance(step, int):
                value = value[step] if isinstance(value, list) and step < len(value) else None
            else:
                value = value.get(step) if isinstance(value, dict) else None
        return value

    def read(self, values: Mapping[str, object], troubles: list[str]) -> object:
        """The same for what makes something of the value: a number that is not finite is unknown, and a trouble."""
        value = self.get(values)
        if isinstance(value, float) and not math.isfinite(value):
            troubles.append(f"{self} is {value}")
            return None
        return value

    def __str__(self) -> str:
        return self.text


class NoFieldError(Exception):
    """A record has no field of that path; the text says which part is missing, with what may have been meant."""

    def __init__(self, why: str) -> None:
        super().__init__(why)
        self.why = why


def find_field(fields: RecordType, text: str) -> tuple[FieldPath, FieldType]:
    """The path written `text`, and its type. Raises `NoFieldError`."""
    text = str(text)
    for key, rest in _divisions(text):
        if key in fields:
            steps = _steps(rest)
            if steps is None:
                raise NoFieldError(message("wrong.no-path", text=text))
            return FieldPath(text, key, steps), _follow(fields[key], key, steps)
    key = re.split(r"[.\[]", text)[0]
    hint = suggestion(key if "." not in text else text, fields)
    raise NoFieldError(message("wrong.no-field", name=text, hint=hint))


def _divisions(text: str) -> list[tuple[str, str]]:
    """Every way to cut a path into a key and the steps behind it, the longest key first."""
    cuts = [match.start() for match in re.finditer(r"[.\[]", text) if match.start()]
    return [(text, ""), *((text[:cut], text[cut:]) for cut in reversed(cuts))]


def _steps(rest: str) -> tuple[str | int, ...] | None:
    steps: list[str | int] = []
    position = 0
    while position < len(rest):
        match = _STEP.match(rest, position)
        if match is None:
            return None
        steps.append(match[1] if match[1] is not None else int(match[2]))
        position = match.end()
    return tuple(steps)


def _follow(type_: FieldType, above: str, steps: tuple[str | int, ...]) -> FieldType:
    for step in steps:
        if isinstance(step, int):
            if not isinstance(type_, ListType):
                raise NoFieldError(message("wrong.no-list", name=above, type=str(type_)))
            if type_.length is not None and step >= type_.length:
                raise NoFieldError(message("wrong.few-items", name=above, count=type_.length))
            type_, above = type_.element, f"{above}[{step}]"
        else:
            if not isinstance(type_, NestedType):
                raise NoFieldError(message("wrong.no-fields", name=above, type=str(type_)))
            if step not in type_.fields:
                raise NoFieldError(
                    message("wrong.no-field-of", name=above, field=step, hint=suggestion(step, type_.fields))
                )
            type_, above = type_.fields[step], f"{above}.{step}"
    return type_


# Values of fields: whether they are of a type, how they are written in documents, and how they are shown to people.

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
    """Return whether `value` is a finite number, of a size that a real one can have; a truth value is none."""
    if isinstance(value, float):
        return math.isfinite(value)
    return isinstance(value, int) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def fits(type_: FieldType, value: object) -> bool:
    """Return whether `value` is one of `type_`."""
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
    """Return whether the values of `type_` are numbers."""
    return isinstance(type_, RealType | IntegerRange)


def is_textual(type_: FieldType) -> bool:
    """Return whether the values of `type_` are texts, or names."""
    return isinstance(type_, TextType | EnumerationType)


def written(type_: FieldType, value: object) -> object:
    """Return what `value`, as a document has it, means where a value of `type_` stands; None when it is none.

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


# Which fields and variables correspond.


def feeds(field: FieldType, variable: Type) -> bool:
    """Return whether values of a field can be those of a variable; which of them are none shows when they come."""
    match field, variable:
        case BooleanType(), BooleanType():
            return True
        case TextType(), EnumerationType():
            return True
        case EnumerationType(), EnumerationType():
            return set(field.values) <= set(variable.values)
        case IntegerRange(), IntegerRange():
            return _within(field, variable) or _within(variable, field)
    return False


def fills(value: FieldType, field: FieldType) -> bool:
    """Return whether values of the type of a record's field can be sent in a field of a message."""
    match value, field:
        case IntegerRange(), IntegerRange():
            return _within(value, field)
        case (IntegerRange(), RealType()) | (EnumerationType(), TextType()):
            return True
        case ListType(), ListType():
            return fills(value.element, field.element) and (None in (value.length, field.length) or _same(value, field))
        case NestedType(), NestedType():
            return value.name == field.name
    return type(value) is type(field) and not isinstance(field, EnumerationType)


def _same(value: ListType, field: ListType) -> bool:
    return value.length == field.length


def _within(inner: IntegerRange, outer: IntegerRange) -> bool:
    return outer.minimum <= inner.minimum and inner.maximum <= outer.maximum
