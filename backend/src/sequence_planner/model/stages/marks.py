"""Marks on what a stage declares: what it does with each name and value that an engineer writes in it.

All that others must know of a stage follows from them: which fields become variables by themselves, what renaming looks
at, what may stand where.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from types import UnionType
from typing import Annotated, Literal, NamedTuple, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel

from sequence_planner.language.records.record import FieldType
from sequence_planner.model.source import SourceText


class NameUse(Enum):
    """The use of a name: a field before the stage, or, where it is given, behind it."""

    READ = "read"  # it is looked at, and stays what it is
    KEPT = "kept"  # it is given again, from itself alone
    COMBINED = "combined"  # something else is made of it and others
    CONSUMED = "consumed"  # something else is made of it
    RENAMED = "renamed"  # it goes on under another name
    GIVEN = "given"


@dataclass(frozen=True)
class NameMark:
    """Marks a text of a declaration as a name in the record: its use in an incoming pipeline, and in an outgoing one.

    A field must `fit`, and findings call what does `what`. A name that is given `alike` has the values of what is read;
    of `outsider`, who knows the name from elsewhere, renaming tells people.
    """

    incoming: NameUse | None
    outgoing: NameUse | None
    fits: Callable[[FieldType], bool] | None = None
    what: str = ""
    alike: bool = False
    outsider: str | None = None

    def use(self, is_incoming: bool) -> NameUse | None:
        """Its use in a pipeline of this direction."""
        return self.incoming if is_incoming else self.outgoing


@dataclass(frozen=True)
class ValueMark:
    """Marks a text as a value of what the stage reads, or of what it gives; `but` is a word that is none. One that is
    `of_variable` is of what is given in an incoming pipeline, and of what is read in an outgoing one.
    """

    of_given: bool
    but: str | None = None
    of_variable: bool = False

    def is_of_given(self, is_incoming: bool) -> bool:
        """Return whether it is a value of what the stage gives."""
        return is_incoming if self.of_variable else self.of_given


@dataclass(frozen=True)
class NamesMark:
    """Marks a name in the record whose values are said in messages as they are called in the model."""


@dataclass(frozen=True)
class FormulaMark:
    """Marks a text as an expression over the record; the name that is given at the same place has its value."""


@dataclass(frozen=True)
class TableMark:
    """Marks a text as the name of a map or a relation of the station, whose table is meant: its `kind`."""

    kind: Literal["map", "relation"]


@dataclass(frozen=True, eq=False)  # equal only to itself: a value may be a mapping
class ExampleValue:
    """Marks a setting with a value to begin with, where a stage is suggested."""

    value: object


# Names of the message's side and of the model's, of which each is read or given as the pipeline goes.
MessageField = Annotated[SourceText, NameMark(NameUse.CONSUMED, NameUse.GIVEN)]
ModelVariable = Annotated[SourceText, NameMark(NameUse.GIVEN, NameUse.CONSUMED)]
# Names of which a stage does the same whichever way the pipeline goes.
ReadField = Annotated[SourceText, NameMark(NameUse.READ, NameUse.READ)]
KeptField = Annotated[SourceText, NameMark(NameUse.KEPT, NameUse.KEPT)]
CombinedField = Annotated[SourceText, NameMark(NameUse.COMBINED, NameUse.COMBINED)]
GivenField = Annotated[SourceText, NameMark(NameUse.GIVEN, NameUse.GIVEN)]

Scalar = SourceText | bool | int | float
READ_VALUE, GIVEN_VALUE = ValueMark(of_given=False), ValueMark(of_given=True)
ReadValue = Annotated[SourceText, READ_VALUE]
GivenValue = Annotated[SourceText, GIVEN_VALUE]
VariableValue = Annotated[SourceText, ValueMark(of_given=True, of_variable=True)]

# Tables of the station, by their names.
NamedMap = Annotated[SourceText, TableMark("map")]
NamedRelation = Annotated[SourceText, TableMark("relation")]


class Within(Enum):
    """A step into a mapping or a list, whatever is in it."""

    KEYS = "keys"
    ENTRIES = "entries"


Mark = NameMark | ValueMark | FormulaMark | TableMark | NamesMark
Steps = tuple[str | Within, ...]
EntryPath = tuple[str | int, ...]


class Marked(NamedTuple):
    """A text of a stage as written, where it stands in it (a key at the path of its entry), and what it is."""

    text: SourceText
    path: EntryPath
    mark: Mark


def _marks(annotation: object, steps: Steps) -> Iterator[tuple[Steps, Mark]]:
    """The marks within an annotation, each with the steps to what it marks."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        found = (each for each in arguments[1:] if isinstance(each, Mark))
        yield from ((steps, each) for each in found)
        yield from _marks(arguments[0], steps)
    elif origin in (Union, UnionType):
        for each in arguments:
            yield from _marks(each, steps)
    elif origin in (dict, Mapping):
        yield from _marks(arguments[0], (*steps, Within.KEYS))
        yield from _marks(arguments[1], (*steps, Within.ENTRIES))
    elif origin is list:
        yield from _marks(arguments[0], (*steps, Within.ENTRIES))
    elif isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield from marks_of(annotation, steps)


def marks_of(part: type[BaseModel], steps: Steps = ()) -> Iterator[tuple[Steps, Mark]]:
    """The marks of what a document may hold, each with the steps to what it marks."""
    hints = get_type_hints(part, include_extras=True)
    for name, info in part.model_fields.items():
        yield from _marks(hints[name], (*steps, info.alias or name))


def texts_at(content: object, steps: Steps, path: EntryPath = ()) -> Iterator[tuple[SourceText, EntryPath]]:
    """The texts at these steps, in a document or in what may become one, of whatever form it is."""
    if not steps:
        if isinstance(content, SourceText):
            yield content, path
        return
    step, rest = steps[0], steps[1:]
    match content:
        case dict() if step is Within.KEYS:
            yield from ((key, (*path, str(key))) for key in content if isinstance(key, SourceText))
        case dict() if step is Within.ENTRIES:
            for key, each in content.items():
                yield from texts_at(each, rest, (*path, str(key)))
        case dict() if step in content and isinstance(step, str):
            yield from texts_at(content[step], rest, (*path, step))
        case list() if step is Within.ENTRIES:
            for index, each in enumerate(content):
                yield from texts_at(each, rest, (*path, index))
        case BaseModel() if isinstance(step, str):
            fields = type(content).model_fields
            name = next(name for name, info in fields.items() if (info.alias or name) == step)
            yield from texts_at(getattr(content, name), rest, (*path, step))


def with_names_said(marked: list[Marked], content: object, table: str) -> list[Marked]:
    """What is marked in a stage; without a `table` messages have the names of its variable's values, which is added."""
    written = content.get(table) if isinstance(content, dict) else getattr(content, table, None)
    variables = [each for each in marked if each.path == ("variable",)] if written is None else []
    return [*marked, *(each._replace(mark=NamesMark()) for each in variables)]
