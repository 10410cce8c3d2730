"""What is made of a document with parameters for the arguments of one instance: a document without any.

Where a parameter may stand follows from what the parts of documents declare: by its name in conditions and actions, and
where a value, a type or a number stands; in braces in all other texts. Each text keeps its place in the type.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from decimal import Decimal
from enum import IntEnum
from functools import cache
from types import UnionType
from typing import Annotated, Any, NamedTuple, Union, get_args, get_origin

from pydantic import BaseModel

from sequence_planner.language.syntax import Span
from sequence_planner.language.types import Place
from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.fields import TextUse
from sequence_planner.model.source import ExpandedText, Piece, SourceText, with_given_at
from sequence_planner.model.stages.marks import FormulaMark, ValueMark
from sequence_planner.model.yaml.reader import EntryPath, MadePlaces, YamlDocument

# What stands where in a document, as far as parameters are concerned.


class ParameterUse(IntEnum):
    """Where a parameter stands in a text; the later ones go first where a text may be several."""

    NAMES = 0  # in braces
    TYPE = 1  # the same, or a type by its name alone
    VALUE = 2  # the same, or a value by its name alone
    EXPRESSION = 3  # by its name


@dataclass(frozen=True)
class DocumentShape:
    """What may stand at an entry: how its text is read, whether it can be a number, and what is within it."""

    text: ParameterUse = ParameterUse.NAMES
    is_number: bool = False
    keys: ParameterUse = ParameterUse.NAMES
    fields: Mapping[str, DocumentShape] = field(default_factory=dict)
    entries: DocumentShape | None = None

    def step_into(self, step: str | int) -> DocumentShape:
        """Return what may stand at a step within it."""
        return self.fields.get(str(step)) or self.entries or ANYTHING

    def with_either(self, other: DocumentShape) -> DocumentShape:
        """Return what may stand where one of both does."""
        return DocumentShape(
            max(self.text, other.text),
            self.is_number or other.is_number,
            max(self.keys, other.keys),
            {**self.fields, **other.fields},
            self.entries or other.entries,
        )


ANYTHING = DocumentShape()
_MARKED = {
    TextUse.TYPE: ParameterUse.TYPE,
    TextUse.CONDITION: ParameterUse.EXPRESSION,
    TextUse.ACTION: ParameterUse.EXPRESSION,
}


@cache
def resource_shape() -> DocumentShape:
    """The shape of a resource."""
    return _shape_of(ResourceDocument)


def _pieces_of(text: SourceText, made: SourceText) -> Iterator[tuple[str, Span]]:
    for piece in made.pieces if isinstance(made, ExpandedText) else ():
        written = text[piece.begin : piece.stop]
        inset = len(written) - len(written.lstrip("{"))
        yield written.strip("{}"), Span(piece.begin + inset, piece.stop - inset)


def _shape_at(path: EntryPath) -> DocumentShape:
    shape = resource_shape()
    for step in path:
        shape = shape.step_into(step)
    return shape


def _placed(name: str) -> SourceText:
    return SourceText(name, Place("", 1, 1), name)


def _shape_of(annotation: object) -> DocumentShape:
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _marked(_shape_of(arguments[0]), arguments[1:])
    if origin in (Union, UnionType):
        shapes = [_shape_of(each) for each in arguments]
        made = shapes[0]
        for each in shapes[1:]:
            made = made.with_either(each)
        # A text beside numbers is a value, unless it is marked as something else.
        is_value = made.is_number and SourceText in map(_plain, arguments)
        return replace(made, text=max(made.text, ParameterUse.VALUE)) if is_value else made
    if origin in (dict, Mapping):
        return DocumentShape(keys=_shape_of(arguments[0]).text, entries=_shape_of(arguments[1]))
    if origin in (list, tuple):
        entries = _shape_of(arguments[0])
        return DocumentShape(is_number=origin is tuple and entries.is_number, entries=entries)
    if annotation in (int, float):
        return DocumentShape(is_number=True)
    if annotation is Any:
        return DocumentShape(ParameterUse.VALUE, True, entries=DocumentShape(ParameterUse.VALUE, True))
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        fields = annotation.model_fields.items()
        return DocumentShape(
            fields={
                info.alias or name: _marked(_shape_of(info.annotation), tuple(info.metadata)) for name, info in fields
            }
        )
    return ANYTHING


def _plain(annotation: object) -> object:
    return get_args(annotation)[0] if get_origin(annotation) is Annotated else annotation


def _marked(shape: DocumentShape, marks: tuple[object, ...]) -> DocumentShape:
    for mark in marks:
        if isinstance(mark, FormulaMark):
            return replace(shape, text=ParameterUse.EXPRESSION)
        if isinstance(mark, ValueMark):
            return replace(shape, text=ParameterUse.VALUE)
        if isinstance(mark, TextUse):
            return replace(shape, text=_MARKED[mark])
    return shape


# Documents with something else in the place of parameters.


class GivenArgument(NamedTuple):
    """What a parameter is for an instance. `text` is that as it is written in a text, `source` what was given if it was
    a text, and `place` where.
    """

    kind: str
    content: SourceText | int | float
    source: SourceText | None
    text: str
    place: Place | None


def given_argument(kind: str, content: SourceText | int | float, place: Place | None) -> GivenArgument:
    """An argument as it was read, at `place`; a number that nobody gives has none."""
    text = format(Decimal(repr(content)), "f") if isinstance(content, float) else str(content)
    source = content if isinstance(content, SourceText) else None
    return GivenArgument(kind, content, source, text, place if source is None else source.place)


_IN_BRACES = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)\}")
_WORDS = re.compile(r"'[^']*'|[A-Za-z_][A-Za-z0-9_]*")
# What each kind of parameter can stand for by its name.
_VALUES = frozenset({"value", "number", "text"})


class Expansion:
    """A document of a type, instance by instance. `duplicates` are names that became the same, and `unknown` what
    stands in braces and is no parameter. With `places` it is noted where what is made of the `document` stands.
    """

    def __init__(
        self,
        instance: str,
        arguments: Mapping[str, GivenArgument],
        document: YamlDocument | None = None,
        places: MadePlaces | None = None,
    ) -> None:
        self._instance = instance
        self._arguments = arguments
        self._words = re.compile(rf"(?<!\w)(?:{'|'.join(map(re.escape, arguments))})(?!\w)") if arguments else None
        self._document = document
        self._places = places
        self.duplicates: list[SourceText] = []
        self.unknown: list[SourceText] = []

    def expanded(self, content: object, shape: DocumentShape, path: EntryPath = (), made_at: EntryPath = ()) -> object:
        """The content of the type for this instance. What stands at `path` stands at `made_at` then."""
        if self._places is not None and self._document is not None:
            self._places.copy_from(self._document, path, made_at, self._instance)
        if isinstance(content, SourceText):
            scalar = self._scalar(content, shape)
            if self._places is not None:
                self._places.give(made_at, self._instance_of(content, scalar))
            return scalar
        if isinstance(content, dict):
            made: dict[SourceText, object] = {}
            for key, value in content.items():
                name = self._text(key, shape.keys)
                if name in made:
                    self.duplicates.append(name)
                within = shape.step_into(key)
                made[name] = self.expanded(value, within, (*path, str(key)), (*made_at, str(name)))
                if self._places is not None:
                    self._places.give((*made_at, str(name)), name.place.instance, of_name=True)
            return made
        if isinstance(content, list):
            entries = shape.entries or ANYTHING
            found = [
                self.expanded(each, entries, (*path, index), (*made_at, index)) for index, each in enumerate(content)
            ]
            if self._places is not None and shape.is_number:  # a list in place of a number is right or wrong as a whole
                given = (self._instance_of(*each) for each in zip(content, found, strict=True))
                self._places.give(made_at, next((each for each in given if each != self._instance), self._instance))
            return found
        return content

    def text_at(self, text: SourceText, path: EntryPath) -> SourceText:
        """A text that stands at an entry of the type, with arguments in the place of parameters."""
        return self._text(text, _shape_at(path).text)

    def made_path(self, path: EntryPath) -> EntryPath:
        """Return where an entry of the type stands in the resource that is made."""
        return tuple(
            step if isinstance(step, int) else str(self._text(_placed(step), _shape_at(path[:depth]).keys))
            for depth, step in enumerate(path)
        )

    def parameters_in(self, text: SourceText, path: EntryPath, *, is_name: bool) -> Iterator[tuple[str, Span]]:
        """The parameters that stand in a text at an entry of the type, or in its name, each with where."""
        shape = _shape_at(path[:-1] if is_name else path)
        if not is_name and shape.is_number and text in self._arguments and self._arguments[text].kind == "number":
            yield str(text), Span(0, len(text))
        else:
            yield from _pieces_of(text, self._text(text, shape.keys if is_name else shape.text))

    def parameters_given(self, text: SourceText) -> Iterator[tuple[str, Span]]:
        """The same in an argument that is given to another type."""
        if text in self._arguments:
            yield str(text), Span(0, len(text))
        else:
            yield from _pieces_of(text, self.with_arguments(text))

    def _instance_of(self, written: object, made: object) -> str:
        """The instance, with the place of the argument that stands for what was `written`, if one does."""
        if isinstance(made, SourceText):
            return made.place.instance
        found = self._arguments.get(written) if isinstance(written, SourceText) else None
        return with_given_at(self._instance, None if found is None else found.place)

    def with_arguments(self, text: SourceText) -> SourceText:
        """A text that is given to another type."""
        return self._text(text, ParameterUse.VALUE)

    def _scalar(self, text: SourceText, shape: DocumentShape) -> object:
        if shape.is_number and (found := self._arguments.get(text)) is not None and found.kind == "number":
            return found.content
        return self._text(text, shape.text)

    def _text(self, text: SourceText, use: ParameterUse) -> SourceText:
        pieces: tuple[Piece, ...] = ()
        if use == ParameterUse.EXPRESSION:
            if self._words is not None and self._words.search(text):
                pieces = tuple(self._named(text))
        elif self._stands_for(text, use):
            pieces = (self._piece(0, len(text), 0, self._arguments[text]),)
        elif "{" in text:
            pieces = tuple(self._braced(text))
        if not pieces:
            return SourceText(text, text.place._replace(instance=self._instance), text.raw)
        made, end = "", 0
        for piece in pieces:
            name = text[piece.begin : piece.stop].strip("{}")
            made += text[end : piece.begin] + self._arguments[name].text
            end = piece.stop
        is_whole = len(pieces) == 1 and pieces[0].stop - pieces[0].begin == len(text)
        given = {piece.given for piece in pieces} if is_whole or use != ParameterUse.EXPRESSION else set()
        one = next(iter(given)) if len(given) == 1 else None
        place = text.place._replace(instance=with_given_at(self._instance, one))
        return ExpandedText(text, made + text[end:], pieces, place)

    def _stands_for(self, text: SourceText, use: ParameterUse) -> bool:
        """Return whether a text that stands alone is the name of a parameter."""
        found = self._arguments.get(text)
        if found is None or use == ParameterUse.NAMES:
            return False
        return found.kind in _VALUES if use == ParameterUse.VALUE else found.kind == "enumeration"

    def _named(self, text: SourceText) -> Iterator[Piece]:
        """Parameters by their names: no parts of longer ones, and nothing that is called."""
        shift = 0
        for word in _WORDS.finditer(text):
            found = self._arguments.get(word[0])
            if found is None or found.kind == "text" or text[: word.start()].rstrip().endswith("."):
                continue
            following = text[word.end() :].lstrip()[:1]
            if following in ("(", "[") or (following == "." and found.kind != "resource"):
                continue
            yield (made := self._piece(word.start(), word.end(), shift, found))
            shift = made.end - made.stop

    def _braced(self, text: SourceText) -> Iterator[Piece]:
        shift = 0
        for braces in _IN_BRACES.finditer(text):
            found = self._arguments.get(braces[1])
            if found is None:
                self.unknown.append(SourceText(braces[1], text.at(Span(*braces.span(1))), braces[1]))
                continue
            yield (made := self._piece(*braces.span(), shift, found))
            shift = made.end - made.stop

    def _piece(self, begin: int, stop: int, shift: int, found: GivenArgument) -> Piece:
        return Piece(begin + shift, begin + shift + len(found.text), begin, stop, found.source, found.place)
