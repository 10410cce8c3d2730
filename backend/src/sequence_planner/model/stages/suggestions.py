"""What suggests a stage: the record at an edge of a pipeline, what there is a use for, and names that are free."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from sequence_planner.language.records.field_paths import domain, is_numeric
from sequence_planner.language.records.record import FieldType, ListType, NestedType, RealType, RecordType, TextType
from sequence_planner.language.types import BooleanType, EnumerationType, IntegerRange

DEEPEST = 3  # messages within messages
MOST_SUBJECTS = 12  # fields that are tried for a kind of stage
MOST_SUGGESTED = 10  # stages of one kind
MOST_POINTS = 40  # values that are written out


@dataclass(frozen=True)
class Candidate:
    """A stage as a document has it, and the variables that it needs declared, with their types."""

    stage: Mapping[str, object]
    declares: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Spot:
    """The place for a stage: its record, what there is a use for at the end, `open` what of it nothing gives yet (of a
    message then the rest), taken names. `enumerations` are those of the station.
    """

    is_incoming: bool
    fields: RecordType
    wanted: RecordType
    open: RecordType
    taken: frozenset[str]
    enumerations: Mapping[str, tuple[str, ...]]
    folder: Path

    def name(self, stem: str) -> str:
        """A name that is free."""
        stem = re.sub(r"\W+", "_", stem).strip("_") or "value"
        names = (stem, *(f"{stem}_{number}" for number in range(2, 1000)))
        return next(each for each in names if each not in self.taken and each not in self.fields)

    def type_name(self, type_: FieldType) -> str | None:
        """Return how a variable's document writes a type."""
        match type_:
            case BooleanType():
                return "bool"
            case IntegerRange() if domain(type_) is not None:
                return str(type_)
            case EnumerationType():
                return next((name for name, values in self.enumerations.items() if values == type_.values), None)
        return None

    @property
    def target(self) -> str:
        """The first name that nothing gives yet."""
        return next(iter(self.open), "")

    def subjects(self, fits: Callable[[FieldType], bool] | None = None) -> list[tuple[str, FieldType]]:
        """The first of the fields that fit."""
        return [each for each in self.leaves if fits is None or fits(each[1])][:MOST_SUBJECTS]

    @property
    def leaves(self) -> list[tuple[str, FieldType]]:
        """The fields, those within messages too, the most telling first: those that nobody else has taken."""
        found = list(_leaves(self.fields))
        return sorted(found, key=lambda each: each[0] in self.taken)


def _leaves(fields: RecordType, above: str = "", depth: int = 0) -> Iterator[tuple[str, FieldType]]:
    for name, type_ in fields.items():
        path = f"{above}{name}"
        if not isinstance(type_, NestedType):
            yield path, type_
        elif depth < DEEPEST:
            yield from _leaves(type_.fields, f"{path}.", depth + 1)


def truth(path: str, type_: FieldType) -> str | None:
    """A condition on a field."""
    match type_:
        case BooleanType():
            return path
        case EnumerationType():
            return f"{path} == {type_.values[0]}"
        case IntegerRange() | RealType():
            return f"{path} > 0"
        case TextType():
            return f"{path} == 'ready'"
        case ListType(element=IntegerRange() | RealType()):
            return f"{path}[0] > 0"
        case ListType(element=BooleanType()):
            return f"{path}[0]"
    return None


def has_numbers(type_: FieldType) -> bool:
    """Return whether a field is a number, or a list of numbers."""
    return is_numeric(type_.element if isinstance(type_, ListType) else type_)


def some_values(type_: FieldType) -> list[object]:
    """Some values of a type, as a document has them."""
    match type_:
        case BooleanType():
            return [True, False]
        case EnumerationType():
            return list(type_.values)
        case IntegerRange():
            return list(domain(type_) or (max(type_.minimum, 0), min(type_.maximum, 1)))
        case RealType():
            return [0.0, 1.0]
        case TextType():
            return ["ready", "other"]
        case ListType(element, int(length)):
            return [[value] * length for value in some_values(element)]
    return []


def as_key(value: object) -> str:
    """A value where a name stands."""
    return str(value).lower() if isinstance(value, bool) else str(value)
