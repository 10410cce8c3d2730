"""Types of resources and their parameters as parts of a model: where each is declared, and where it is named."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.editor.symbols.index import Declared, Gathered, ModelPart, Occurrence, Where, parse_part
from sequence_planner.editor.symbols.texts import ModelContent, entry, pairs
from sequence_planner.language.syntax import Span
from sequence_planner.language.types import Place
from sequence_planner.model.paths import resource_of
from sequence_planner.model.source import ExpandedText, SourceText
from sequence_planner.model.types.documents import ParameterDocument
from sequence_planner.model.types.expansion import Expansion, GivenArgument
from sequence_planner.model.types.layers import Layer, WrittenInstance
from sequence_planner.model.yaml.reader import EntryPath

_NOTHING = SourceText("_", Place("", 1, 1), "_")


def type_part(name: str) -> ModelPart:
    """A type, by its name or `package.name`."""
    return parse_part(f"type:{name}")


class TypeCollector:
    """Notes the types of a station, their parameters, and where both are named."""

    def __init__(self, declared: Declared, gathered: Gathered, content: ModelContent) -> None:
        self._declared = declared
        self._gathered = gathered
        self._content = content

    def collect(self, file: str | None) -> None:
        """Note what is in one file, or in all."""
        for name, written in self._content.types.items():
            part, at = type_part(name), written.document.file
            self._declared.parts.append(part)
            self._declared.parts += [ModelPart("parameter", part.id, str(each)) for each in written.parameters]
            if written.package:
                self._gathered.tie(part, _why(written.package))
            if file in (None, at):
                self._type(part, written)
        for at, written in self._content.instances.items():
            where = Where(at, (), f"resource {resource_of(at)}", 0)
            if file in (None, at):
                self._head(written, where, None)
            if file is None or self._content.is_made_of(at, file):
                for layer in self._content.layers[at][1:]:
                    self._given(layer, where)

    def _type(self, part: ModelPart, written: WrittenInstance) -> None:
        document, none = written.document, Span(0, 0)
        top = Where(document.file, (), f"type {part.full}", 0)
        self._gathered.occurrences.append(Occurrence(part, top, None, none, none, True))
        self._head(written, top, part)
        given = {name: _any_argument(parameter) for name, parameter in _named(written)}
        for name, parameter in written.parameters.items():
            own = ModelPart("parameter", part.id, str(name))
            self._gathered.add(own, top.to("parameters", name), name, declares=True)
            if written.package:
                self._gathered.tie(own, _why(written.package))
            if parameter.of is not None and parameter.of in given:
                of = ModelPart("parameter", part.id, str(parameter.of))
                self._gathered.add(of, top.to("parameters", name, "of"), parameter.of)
            elif parameter.of is not None:
                self._gathered.add(self._declared.domain(str(parameter.of)), top.to("parameters", name), parameter.of)
            if name in written.meanings:
                self._gathered.hidden.add((own, ModelPart("variable", part.full, str(name))))
        expansion = Expansion("", given)
        for path, text, is_name in _texts(written.own, ()):
            for parameter_name, span in expansion.parameters_in(text, path, is_name=is_name):
                self._gathered.add(ModelPart("parameter", part.id, parameter_name), top.to(*path), text, span)

    def _head(self, written: WrittenInstance, where: Where, own: ModelPart | None) -> None:
        """The type that something is of, and the arguments that it gives."""
        named, full = written.head.type, written.base
        if named is None or full is None or (type_ := self._content.types.get(full)) is None:
            return
        part = type_part(full)
        self._gathered.add(part, where.to("type"), named, Span(len(named) - len(part.name), len(named)))
        given = {} if own is None else {name: _any_argument(parameter) for name, parameter in _named(written)}
        expansion = Expansion("", given)
        for name, value in pairs(entry(written.document.content, "arguments")):
            if name in type_.parameters:
                self._gathered.add(ModelPart("parameter", part.id, str(name)), where.to("arguments", name), name)
            if own is not None and isinstance(value, SourceText):
                for parameter, span in expansion.parameters_given(value):
                    at = where.to("arguments", name)
                    self._gathered.add(ModelPart("parameter", own.id, parameter), at, value, span)

    def _given(self, layer: Layer, where: Where) -> None:
        """The things that the arguments of a type name for one instance, also where nothing in the type uses them."""
        for name, parameter in layer.written.parameters.items():
            given = layer.arguments.get(str(name))
            if given is None or given.source is None or given.kind != parameter.kind:
                continue
            at = where.to("arguments", name)
            if parameter.kind == "resource" and given.text in self._declared.resources:
                self._gathered.add(ModelPart("resource", None, given.text), at, given.source)
            elif parameter.kind == "enumeration" and given.text in self._declared.homes:
                self._gathered.add(self._declared.domain(given.text), at, given.source)
            elif parameter.kind == "value":
                of = layer.arguments.get(str(parameter.of))
                domain = str(parameter.of) if of is None else of.text
                if given.text in self._declared.homes.get(domain, ()):
                    self._gathered.add(self._declared.value(domain, given.text), at, given.source)


def _named(written: WrittenInstance) -> Iterator[tuple[str, ParameterDocument]]:
    return ((str(name), parameter) for name, parameter in written.parameters.items())


def _any_argument(parameter: ParameterDocument) -> GivenArgument:
    """Something in the place of a parameter: only where it stands is looked at."""
    return GivenArgument(parameter.kind, _NOTHING, None, "_", None)


def _texts(content: object, path: EntryPath) -> Iterator[tuple[EntryPath, SourceText, bool]]:
    """All texts within some content, and whether each is the name of the entry that it stands at."""
    if isinstance(content, SourceText):
        if not isinstance(content, ExpandedText):
            yield path, content, False
    elif isinstance(content, dict):
        for key, value in content.items():
            yield (*path, str(key)), key, True
            yield from _texts(value, (*path, str(key)))
    elif isinstance(content, list):
        for index, each in enumerate(content):
            yield from _texts(each, (*path, index))


def _why(package: str) -> str:
    return f"it belongs to the package `{package}`, whose files are compared with their hash: change it at its source"
