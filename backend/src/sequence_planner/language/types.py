"""Finite domain types of the language (boolean, enumeration, integer range), and source positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from sequence_planner.core.immutable import Immutable
from sequence_planner.texts.late import message

if TYPE_CHECKING:
    from sequence_planner.texts.message import Message

# Where a text was written.


class Place(NamedTuple):
    """The place where something stands; line and column count from 1. What stands in the type of a resource is known
    by the `instance`, in words, for which it was read.
    """

    file: str
    line: int
    column: int
    instance: str = ""

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


# Types of the language: every variable ranges over a finite domain.

Value = bool | int | str


class BooleanType(Immutable):
    """`false` and `true`."""

    @property
    def domain(self) -> tuple[Value, ...]:
        """All values, in order."""
        return (False, True)

    def __str__(self) -> str:
        return "bool"


class EnumerationType(Immutable):
    """Named values. Two enumerations are comparable when they share a name: values are their names."""

    values: tuple[str, ...]

    @property
    def domain(self) -> tuple[Value, ...]:
        """All values, in order of declaration."""
        return self.values

    def __str__(self) -> str:
        return "{" + ", ".join(self.values) + "}"


class IntegerRange(Immutable):
    """The integers from `minimum` to `maximum`, both included."""

    minimum: int
    maximum: int

    @property
    def domain(self) -> tuple[Value, ...]:
        """All values, ascending."""
        return tuple(range(self.minimum, self.maximum + 1))

    def __str__(self) -> str:
        return f"{self.minimum}..{self.maximum}"


Type = BooleanType | EnumerationType | IntegerRange

BOOLEAN = BooleanType()


def contains(domain: Type, value: object) -> bool:
    """Return whether `value` belongs to the type; `True` is not the integer 1 here."""
    if isinstance(domain, BooleanType):
        return isinstance(value, bool)
    if isinstance(domain, IntegerRange):
        if not isinstance(value, int) or isinstance(value, bool):
            return False
        return domain.minimum <= value <= domain.maximum
    return isinstance(value, str) and value in domain.values


def overlap(one: Type, other: Type) -> bool:
    """Return whether the two have a value in common."""
    if isinstance(one, IntegerRange) and isinstance(other, IntegerRange):
        return one.minimum <= other.maximum and other.minimum <= one.maximum
    if isinstance(one, EnumerationType) and isinstance(other, EnumerationType):
        return not set(one.values).isdisjoint(other.values)
    return type(one) is type(other)


def described(type_: Type) -> Message:
    """A type, for people."""
    match type_:
        case BooleanType():
            return message("type.truth-value")
        case IntegerRange(minimum, maximum):
            if minimum == maximum:
                return message("type.integer", value=minimum)
            return message("type.range", range=str(type_))
        case EnumerationType((single,)):
            return message("type.value", value=single)
        case EnumerationType():
            return message("type.one-of", values=str(type_))
