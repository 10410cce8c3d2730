"""Instances and types as they are written, and the document that each instance has with its types."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.shorthand.titles import VALUE_IN_PHRASE
from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.paths import EditError, missing, parse_path, resource_of, type_of
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.types.documents import InstanceHead, ParameterDocument, ParameterKind, TypeHead
from sequence_planner.model.types.expansion import Expansion, GivenArgument, given_argument, resource_shape
from sequence_planner.model.validation import findings_of, shown
from sequence_planner.model.yaml.reader import MadePlaces, YamlDocument, read_yaml
from sequence_planner.texts.message import message

SECTIONS = ("measured", "output", "estimated")
OF_INSTANCES = frozenset(InstanceHead.model_fields)  # keys that no other resource has


@dataclass(frozen=True, eq=False)
class WrittenInstance:
    """A resource that is an instance, or a type, as written. A type may belong to a `package`."""

    document: YamlDocument
    head: InstanceHead
    package: str = ""

    @property
    def base(self) -> str | None:
        """The full name of the type that it is of, if it is of one."""
        named = self.head.type
        return None if named is None else str(named) if "." in named or not self.package else f"{self.package}.{named}"

    @cached_property
    def own(self) -> dict[SourceText, object]:
        """Return what it says itself of the resource."""
        content: Any = self.document.content
        return {key: value for key, value in content.items() if key not in TypeHead.model_fields}

    @cached_property
    def parameters(self) -> Mapping[SourceText, ParameterDocument]:
        """The parameters of a type; an instance has none."""
        return self.head.parameters if isinstance(self.head, TypeHead) else {}

    @cached_property
    def meanings(self) -> Mapping[str, str]:
        """The names that mean something in its conditions, each with what it is called."""
        found: dict[str, str] = {}
        for section in SECTIONS:
            for name, variable in _entries(self.own.get(section)):  # type: ignore[call-overload]
                found[str(name)] = "variable"
                found |= dict.fromkeys((str(each) for each, _ in _entries(_at(variable, "for"))), "parameter")
        for section, what in (("abilities", "ability"), ("predicates", "predicate"), ("sets", "set")):
            for name, part in _entries(_at(self.own, section)):
                found[str(name)] = what
                found |= dict.fromkeys((str(each) for each, _ in _entries(_at(part, "parameters"))), "parameter")
                for _, effect in _entries(_at(part, "effects")):
                    found |= dict.fromkeys((str(each) for each, _ in _entries(_at(effect, "for"))), "parameter")
        return found

    @cached_property
    def has_phrases(self) -> bool:
        """Whether people are told a variable's value by a phrase, in which `{value}` stands for it."""
        return any("phrase" in each for section in SECTIONS for _, each in _entries(self.own.get(section)))  # type: ignore[call-overload, operator]


def _at(content: object, name: str) -> object:
    return content.get(name) if isinstance(content, dict) else None


def _entries(content: object) -> Iterator[tuple[SourceText, object]]:
    return iter(content.items() if isinstance(content, dict) else ())


def read_instance(document: YamlDocument) -> tuple[object, list[Finding]]:
    """An instance, from the file of a resource that names a type."""
    return _read(document, InstanceHead, "")


def read_type(document: YamlDocument, package: str) -> tuple[object, list[Finding]]:
    """A type, from its file."""
    return _read(document, TypeHead, package)


def _read(document: YamlDocument, kind: type[InstanceHead], package: str) -> tuple[object, list[Finding]]:
    content = document.content
    if not isinstance(content, dict):
        said = message("wrong.expected", wanted=message("expected.names"), found=shown(content), hint="")
        return None, [Finding(document.place(()), said)]
    known = [*kind.model_fields, *ResourceDocument.model_fields]
    wrong = [
        Finding(document.place((key,)), message("wrong.unknown-key", name=str(key), hint=suggestion(key, known)))
        for key in content
        if key not in known
    ]
    try:
        head = kind.model_validate({key: value for key, value in content.items() if key in kind.model_fields})
    except ValidationError as error:
        return None, [*findings_of(error, document, (), kind), *wrong]
    if head.type is None and kind is InstanceHead:
        said = message("wrong.no-type")
        wrong.append(Finding(document.place(()), said))
    return None if wrong else WrittenInstance(document, head, package), wrong


class Layer(NamedTuple):
    """The instance itself, or a type that it has a part of, with the arguments for the parameters of that."""

    name: str
    written: WrittenInstance
    arguments: Mapping[str, GivenArgument]


@dataclass(frozen=True)
class UnusedType:
    """A type that no instance has: the resource that it makes where each parameter is given its own name, or 1 for a
    number; and of which kind its parameters are. It may belong to a `package`.
    """

    document: ResourceDocument
    kinds: Mapping[str, ParameterKind]
    package: str


def layers_of(
    instance: str, written: WrittenInstance, types: Mapping[str, WrittenInstance | None]
) -> tuple[list[Layer], Finding | None, bool]:
    """The instance and its types; what is wrong where a name is that of none; and whether these are all.

    Arguments are as they are given: of those that are missing and have no default there are none.
    """
    layers = [Layer("", written, {})]
    while (named := layers[-1].written.head.type) is not None and (full := layers[-1].written.base) is not None:
        chain = [each.name for each in layers[1:]]
        if full in chain:
            circle = " → ".join([*chain[chain.index(full) :], full])
            return layers, Finding(named.place, message("wrong.type-of-itself", name=full, names=circle)), False
        type_ = types.get(full)
        if type_ is None:
            unknown = message("wrong.no-resource-type", name=str(named), hint=suggestion(named, types))
            said = Finding(named.place, unknown)
            is_told = full in types or f"{full.partition('.')[0]}.*" in types  # or its whole package is unusable
            return layers, None if is_told else said, False
        layers.append(Layer(full, type_, _arguments(instance, type_, layers[-1], len(layers) > 1)))
    return layers, None, True


def _arguments(instance: str, type_: WrittenInstance, by: Layer, by_type: bool) -> dict[str, GivenArgument]:
    """The arguments that a layer gives to a type."""
    placing = Expansion(instance, by.arguments)
    made: dict[str, GivenArgument] = {}
    for name, parameter in type_.parameters.items():
        given = next((each for key, each in by.written.head.arguments.items() if key == name), None)
        content = parameter.default if given is None else given
        if content is None:
            continue
        if isinstance(content, SourceText) and (by_type or given is None):
            if (outer := by.arguments.get(content)) is not None:
                made[str(name)] = outer
                continue
            content = placing.with_arguments(content)
        place = None if given is None else by.written.document.place_of_value(("arguments", str(name)))
        made[str(name)] = given_argument(parameter.kind, content, place)
    return made


def content_of(
    instance: str, layers: list[Layer], found: list[Finding], places: MadePlaces | None = None
) -> dict[SourceText, object]:
    """What an instance has of itself and its types; what cannot be brought together is noted in `found`. With `places`
    it is noted there what stands where.
    """
    content: Any = {}
    for layer in reversed(layers):
        is_instance = layer is layers[0]
        for text in layer.written.head.remove:
            if (said := _without(content, text)) is not None:
                found.append(Finding(text.place if is_instance else text.place._replace(instance=instance), said))
        own: Any = layer.written.own
        document = layer.written.document
        if is_instance:
            if places is not None:
                places.overlay(document.places, document.values)
        else:
            expansion = Expansion(instance, layer.arguments, document, places)
            own = expansion.expanded(own, resource_shape())
            for name in expansion.duplicates:
                found.append(Finding(name.place, message("wrong.duplicate-by-arguments", name=str(name))))
            for name in expansion.unknown:
                if str(name) not in layer.written.meanings and not (
                    name == VALUE_IN_PHRASE and layer.written.has_phrases
                ):
                    near = suggestion(name, layer.written.parameters)
                    found.append(
                        Finding(
                            name.place._replace(instance=instance),
                            message("wrong.unknown-parameter", name=str(name), hint=near),
                        )
                    )
        content = _merged(content, own)
    made: dict[SourceText, object] = content
    return made


def _merged(base: object, own: object) -> Any:  # noqa: ANN401 (content of any form)
    """`base` with what `own` changes and adds: entries by their names, all else as a whole."""
    if not isinstance(base, dict) or not isinstance(own, dict):
        return own
    return {
        key: _merged(base[key], own[key]) if key in base and key in own else base[key] if key in base else own[key]
        for key in merged_order(list(base), list(own))
    }


def merged_order(base: Sequence[str], own: Sequence[str]) -> list[str]:
    """The names in `base` with those that `own` adds, each behind the one that is above it in `own`, or else before the
    one that is below it there.
    """
    order, above = list(base), None
    for key in own:
        if key not in base:
            below = None if above is not None else next((each for each in own if each in base), None)
            at = len(order) if above is below is None else order.index(above or below or "") + (above is not None)
            order.insert(at, key)
        above = key
    return order


def _without(content: Any, text: SourceText) -> str | None:  # noqa: ANN401
    """Take an entry out, or return why that cannot be."""
    try:
        path = parse_path(text)
    except EditError as error:
        return str(error)
    for depth, step in enumerate(path):
        if not isinstance(content, dict) or step not in content:
            return f"the type has nothing to remove here: {missing(path, depth, content)}"
        if depth < len(path) - 1:
            content = content[step]
    del content[path[-1]]
    return None


def document_of(instance: str, layers: list[Layer]) -> YamlDocument:
    """The resource as if it stood in a file, with the places of what stands in several."""
    places = MadePlaces({}, {})
    content = content_of(instance, layers, [], places)
    return YamlDocument(layers[0].written.document.file, content, places.names, places.values)


def written_types(folder: Path) -> dict[str, tuple[dict[str, str], list[str]]]:
    """The types of a station, each with its parameters and what they are, and its instances.

    Raises `ModelError` for files that cannot be read.
    """
    found: dict[str, tuple[dict[str, str], list[str]]] = {}
    for path in sorted([*folder.glob("types/*.yaml"), *folder.glob("packages/*/types/*.yaml")]):
        file = path.relative_to(folder).as_posix()
        written, _ = read_type(read_yaml(path, file), "")
        if isinstance(written, WrittenInstance) and (name := type_of(file)) is not None:
            found[name] = {str(each): _in_words(parameter) for each, parameter in written.parameters.items()}, []
    for path in sorted(folder.glob("resources/*.yaml")):
        content = read_yaml(path, path.name).content
        if isinstance(content, dict) and (kind := str(content.get("type"))) in found:
            found[kind][1].append(path.stem)
    return found


def _in_words(parameter: ParameterDocument) -> str:
    of = "" if parameter.of is None else f" of {parameter.of}"
    default = "" if parameter.default is None else f", {parameter.default} where it is not given"
    return f"{parameter.kind}{of}{default}"


class WrittenOut:
    """The files of a station with its instances written out, as far as that can be done: `documents`.

    `types` are those that can be read, by their names, `instances` those by their files. `files_of` has for each
    the files that it is made of, and `layers` itself with its types and what these are given.
    """

    def __init__(self, documents: Mapping[str, YamlDocument]) -> None:
        self.types: dict[str, WrittenInstance] = {}
        names: dict[str, WrittenInstance | None] = {}
        for file, document in documents.items():
            if (name := type_of(file)) is not None:
                read = read_type(document, name.rpartition(".")[0])[0]
                names[name] = read if isinstance(read, WrittenInstance) else None
                if isinstance(read, WrittenInstance):
                    self.types[name] = read
        self.documents = dict(documents)
        self.instances: dict[str, WrittenInstance] = {}
        self.files_of: dict[str, frozenset[str]] = {}
        self.layers: dict[str, list[Layer]] = {}
        for file, document in documents.items():
            if (resource := resource_of(file)) is None or not isinstance(document.content, dict):
                continue
            written = None if OF_INSTANCES.isdisjoint(document.content) else read_instance(document)[0]
            if isinstance(written, WrittenInstance) and written.head.type is not None:
                instance = f"{resource} ({written.head.type.place})"
                layers = layers_of(instance, written, names)[0]
                self.instances[file] = written
                self.layers[file] = layers
                self.files_of[file] = frozenset(each.written.document.file for each in layers)
                self.documents[file] = document_of(instance, layers)
