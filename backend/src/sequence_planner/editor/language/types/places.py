"""A text of a document and what can be asked of it, also where it stands in a type of resources."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from sequence_planner.editor.language.completion import (
    NO_MATCH,
    Completion,
    Option,
    complete,
    completion,
    likeness,
    option,
    word_at,
)
from sequence_planner.editor.language.families import predicate_of
from sequence_planner.editor.language.field import FieldKind, TextField, condition
from sequence_planner.editor.language.hover import Hover, hover
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.editor.language.service import TextProblem, check, formatted
from sequence_planner.language.syntax import Span
from sequence_planner.language.types import Place
from sequence_planner.model.paths import resource_of, type_of
from sequence_planner.model.source import ExpandedText, SourceText
from sequence_planner.model.types.documents import ParameterDocument
from sequence_planner.model.types.expansion import Expansion, GivenArgument
from sequence_planner.model.types.layers import Layer
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.texts.message import message

_MOST_INSTANCES = 10  # for which a text of a type is looked at while it is typed


class AskedPlace(ABC):
    """A place for a text in a document, and what can be asked of a text there."""

    @property
    @abstractmethod
    def field_kind(self) -> FieldKind:
        """The kind of text that stands there."""

    @abstractmethod
    def problems(self, text: str) -> tuple[TextProblem, ...]:
        """What is wrong with a text."""

    @abstractmethod
    def completion(self, text: str, offset: int) -> Completion:
        """What can be written in it at `offset`."""

    @abstractmethod
    def hover(self, text: str, offset: int) -> Hover | None:
        """What the name at `offset` is."""

    @abstractmethod
    def formatted(self, text: str) -> str:
        """The same in its usual form."""


def text_place(
    lexicon: Lexicon, file: str, path: EntryPath, parameters: Mapping[str, str] | None = None
) -> AskedPlace | None:
    """The place for a text at an entry of a file, or None where no names stand.

    A text of a type is what it is for each instance. Of a type without instances nothing is known but its form.
    """
    if (name := type_of(file)) is not None:
        return _place_in_type(lexicon, name, path, parameters)
    field = lexicon.field(file, path, parameters)
    if field is None and path[:1] == ("arguments",) and len(path) == 2:
        field = _field_of_argument(lexicon, resource_of(file) or "", str(path[1]))
    return None if field is None else _PlainPlace(lexicon, field)


def hover_of_part(lexicon: Lexicon, kind: str, full: str) -> Hover | None:
    """Say what a part of the model is, by its kind and its full name; None where there is nothing more to be said."""
    text, name = full, full.rpartition(".")[2]
    match kind:
        case "variable" | "relation" | "map":
            field = TextField(FieldKind.CONDITION, condition)
        case "predicate" if full in lexicon.short:
            parameters = predicate_of(lexicon.station, lexicon.short[full])[1]
            field = TextField(FieldKind.CONDITION, condition, parameters)
            text = f"{full}({', '.join(parameters)})" if parameters else full
        case "ability":
            field = TextField(FieldKind.ABILITY, condition)
        case "operation" | "sequence":
            field = TextField(FieldKind.OPERATION, condition)
        case "enumeration" | "set":
            field = TextField(FieldKind.ENUMERATION, condition)
        case "value":
            type_ = lexicon.declarations.enumerations.get(full.rpartition(".")[0])
            field, text = TextField(FieldKind.INITIAL, condition, type=type_), name
        case "parameter" if full.startswith("type:"):
            return _parameter_of_type(lexicon, full.removeprefix("type:").rpartition(".")[0], name)
        case _:
            return None
    return hover(lexicon, field, text, len(full) if text != name else len(text))


def _parameter_of_type(lexicon: Lexicon, type_: str, name: str) -> Hover | None:
    place = _place_in_type(lexicon, type_, ("title",), None, TextField(FieldKind.CONDITION, condition))
    return None if place is None else place.parameter(Span(0, len(name)), name)


def parameters_of(lexicon: Lexicon, file: str) -> Mapping[SourceText, ParameterDocument]:
    """The parameters that an instance, or a type, gives arguments to."""
    name = type_of(file)
    for resource, layers in lexicon.station.layers.items():
        for index, layer in enumerate(layers[:-1]):
            if layer.name == name or (index == 0 and resource == resource_of(file)):
                return layers[index + 1].written.parameters
    return {}


@dataclass(frozen=True)
class _PlainPlace(AskedPlace):
    """A place in a document that means what is written in it."""

    lexicon: Lexicon
    field: TextField

    @property
    def field_kind(self) -> FieldKind:
        return self.field.kind

    def problems(self, text: str) -> tuple[TextProblem, ...]:
        return check(self.lexicon, self.field, text)

    def completion(self, text: str, offset: int) -> Completion:
        return complete(self.lexicon, self.field, text, offset)

    def hover(self, text: str, offset: int) -> Hover | None:
        return hover(self.lexicon, self.field, text, offset)

    def formatted(self, text: str) -> str:
        return formatted(self.field, text)


def _field_of_argument(lexicon: Lexicon, resource: str, name: str) -> TextField | None:
    layers = lexicon.station.layers.get(resource, ())
    parameters = layers[1].written.parameters if len(layers) > 1 else {}
    parameter = next((each for key, each in parameters.items() if key == name), None)
    if parameter is None or parameter.kind not in ("enumeration", "value"):
        return None
    if parameter.kind == "enumeration":
        return TextField(FieldKind.ENUMERATION, lambda meaning, text, scope: None)
    of = layers[1].arguments.get(str(parameter.of))
    type_ = lexicon.declarations.enumerations.get(str(parameter.of) if of is None else of.text)
    return TextField(FieldKind.INITIAL, lambda meaning, text, scope: None, type=type_)


# In a type: what the text is for its instances, told at the places where it is written.


@dataclass(frozen=True)
class _MadeText:
    """A text of a type as it is for an instance."""

    written: SourceText
    made: SourceText

    def in_type(self, start: int, end: int) -> tuple[int, int]:
        """A span of what is made, as a span of what is written."""
        if not isinstance(self.made, ExpandedText):
            return start, end
        span = self.made.in_template(Span(start, max(start, end)))
        return span.start, max(span.start, span.end)


@dataclass(frozen=True)
class _Instance:
    """An instance of the type, with the field that the text stands in there."""

    name: str
    layer: Layer
    field: TextField
    path: EntryPath

    def made(self, text: str) -> _MadeText:
        written = SourceText(text, Place("", 1, 1), text)
        return _MadeText(written, Expansion(self.name, self.layer.arguments).text_at(written, self.path))


def _of(names: list[str], what: str) -> str:
    """Say of which instances something is said."""
    *most, last = names
    return message(
        "found.in", instances=message("list.and", most=" and ".join(most), last=last) if most else last, what=what
    )


@dataclass(frozen=True)
class _PlaceInType(AskedPlace):
    lexicon: Lexicon
    type: str
    instances: tuple[_Instance, ...]

    @property
    def field_kind(self) -> FieldKind:
        return self.instances[0].field.kind

    def problems(self, text: str) -> tuple[TextProblem, ...]:
        found: dict[TextProblem, list[str]] = {}
        for each in self.instances:
            made = each.made(text)
            for problem in check(self.lexicon, each.field, str(made.made)):
                start, end = made.in_type(problem.start, problem.end)
                found.setdefault(TextProblem(start, end, problem.message), []).append(each.name)
        everywhere = {problem for problem, names in found.items() if len(names) == len(self.instances)}
        return tuple(
            sorted(
                problem if problem in everywhere else replace(problem, message=_of(names, problem.message))
                for problem, names in found.items()
            )
        )

    def completion(self, text: str, offset: int) -> Completion:
        first = self.instances[0]
        word = word_at(text, offset)
        # What is being typed is not yet the name of a parameter.
        before = str(first.made(text[: word.start]).made)
        behind = str(first.made(text[word.end :]).made)
        shift = len(before) - word.start
        found = complete(self.lexicon, first.field, before + text[word.start : word.end] + behind, offset + shift)
        typed = text[word.start : offset]
        start, end = max(found.start - shift, 0), max(found.end - shift, offset)
        if found.start < len(before):  # a longer name, in which an argument may stand
            start = first.made(text[: word.start]).in_type(found.start, len(before))[0]
        return completion(start, end, [*self._parameters(typed, text[: word.start]), *found.options])

    def _parameters(self, typed: str, before: str) -> Iterator[Option]:
        """The parameters of the type that can stand there."""
        if before.rstrip().endswith("."):
            return
        arguments = self.instances[0].layer.arguments
        for name, parameter in self.instances[0].layer.written.parameters.items():
            if self._can_stand(parameter) and likeness(typed, str(name)) < NO_MATCH:
                given = arguments.get(str(name))
                yield option(str(name), NameKind.PARAMETER, parameter.kind if given is None else f"here {given.text}")

    def _can_stand(self, parameter: ParameterDocument) -> bool:
        match self.field_kind:
            case FieldKind.CONDITION | FieldKind.FORMULA | FieldKind.ACTION:
                return parameter.kind in ("value", "number", "resource")
            case FieldKind.TYPE | FieldKind.ENUMERATION:
                return parameter.kind == "enumeration"
            case FieldKind.INITIAL | FieldKind.MEMBER:
                return parameter.kind in ("value", "number")
        return False

    def hover(self, text: str, offset: int) -> Hover | None:
        made = self.instances[0].made(text)
        if isinstance(made.made, ExpandedText):
            for piece in made.made.pieces:
                if piece.begin <= offset <= piece.stop:
                    return self.parameter(Span(piece.begin, piece.stop), text[piece.begin : piece.stop])
        found = hover(self.lexicon, self.instances[0].field, str(made.made), self._offset(made, offset))
        if found is None:
            return None
        start, end = made.in_type(found.start, found.end)
        return replace(found, start=start, end=end)

    @staticmethod
    def _offset(made: _MadeText, offset: int) -> int:
        """The place in what is made of a place in what is written that no argument stands at."""
        shift = 0
        for piece in made.made.pieces if isinstance(made.made, ExpandedText) else ():
            if piece.stop <= offset:
                shift = piece.end - piece.stop
        return offset + shift

    def parameter(self, span: Span, written: str) -> Hover:
        """A parameter of the type, with what it is for instances."""
        name = written.strip("{}")
        layer = self.instances[0].layer
        key = next(key for key in layer.written.parameters if key == name)
        given = {each.name: each.layer.arguments[name].text for each in self.instances}
        counted = Counter(given.values())
        said = ", ".join(
            text if len(counted) == 1 else f"{text} in {' and '.join(each for each in given if given[each] == text)}"
            for text in counted
        )
        argument = layer.arguments[name]
        return Hover(
            span.start, span.end, name, NameKind.PARAMETER, name, expansion=said, title=_told(argument),
            place=self.lexicon.within(key.place), part=f"parameter:type:{self.type}.{name}",
        )  # fmt: skip

    def formatted(self, text: str) -> str:
        return formatted(self.instances[0].field, text)


def _told(given: GivenArgument) -> str:
    return {
        "text": "a text", "number": "a number", "enumeration": "an enumeration", "value": "a value",
        "resource": "a resource",
    }[given.kind]  # fmt: skip


def _place_in_type(
    lexicon: Lexicon,
    name: str,
    path: EntryPath,
    parameters: Mapping[str, str] | None,
    anyway: TextField | None = None,
) -> _PlaceInType | None:
    """The place at an entry of a type; `anyway` is the field where there is none."""
    found: list[_Instance] = []
    for resource, layers in lexicon.station.layers.items():
        for layer in layers[1:]:
            if layer.name != name or len(found) == _MOST_INSTANCES:
                continue
            given = parameters and {
                key: layer.arguments[each].text if each in layer.arguments else each for key, each in parameters.items()
            }
            at = Expansion(resource, layer.arguments).made_path(path)
            field = lexicon.field(f"resources/{resource}.yaml", at, given) or anyway
            if field is not None:
                found.append(_Instance(resource, layer, field, path))
    return _PlaceInType(lexicon, name, tuple(found)) if found else None
