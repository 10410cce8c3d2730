"""The things that travel along the edges of a pipeline: records, and the types of their fields.

A record is a message, or what stages have made of it: named fields, each of a type. A model's variables are finite;
messages also carry real numbers, texts, lists and nested messages, so an edge has more types than the language has.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sequence_planner.language.types import Type


@dataclass(frozen=True)
class RealType:
    """A finite floating-point number."""

    def __str__(self) -> str:
        return "real"


@dataclass(frozen=True)
class TextType:
    """Any text."""

    def __str__(self) -> str:
        return "text"


@dataclass(frozen=True)
class ListType:
    """Items of one type: `length` of them, or any number where it is None."""

    element: FieldType
    length: int | None = None

    def __str__(self) -> str:
        return f"{self.element}[{'' if self.length is None else self.length}]"


@dataclass(frozen=True)
class NestedType:
    """A message within a message, `name` is its type as in `geometry_msgs/msg/Pose`."""

    name: str
    fields: Mapping[str, FieldType]

    def __str__(self) -> str:
        return self.name


FieldType = Type | RealType | TextType | ListType | NestedType

#: The fields of a record, by name.
RecordType = Mapping[str, FieldType]


@dataclass(slots=True)
class Record:
    """One record. A field whose value is None is unknown, as is one that is missing.

    `troubles` say what in it made no sense so far; they are for people, and go with the record to its end.
    """

    values: dict[str, object]
    troubles: list[str] = field(default_factory=list)

    def copy(self) -> Record:
        """One of its own for another branch."""
        return Record(dict(self.values), list(self.troubles))
