"""Scope of a draft: declared names visible at each document field, and their shortest form."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice, product
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.declarations import FLAGS, OPERATION, Declarations
from sequence_planner.automaton.findings import Findings, instance_name, with_arguments
from sequence_planner.automaton.grounding import (
    CANCEL,
    EFFECT,
    FINISH,
    START,
    Meaning,
    Writing,
    alarm_condition,
    check_acknowledgement,
    exclusive_abilities,
    observable_condition,
)
from sequence_planner.editor.language.field import (
    FieldKind,
    TextField,
    all_of,
    condition,
    field_of_parameter,
    placed,
    with_text,
)
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.sequences import field_of_sequence, field_of_work_master
from sequence_planner.language.resolver import NameScope
from sequence_planner.language.suggestions import beginning_with
from sequence_planner.language.types import BOOLEAN, EnumerationType, Place, Type, Value
from sequence_planner.model.documents import (
    AbilityDocument,
    Parameters,
    ResourceDocument,
    SpecificationDocument,
    VariableDocument,
)
from sequence_planner.model.fields import Predicate
from sequence_planner.model.loader import Station
from sequence_planner.model.source import ModelError, SourceText
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.pipelines.builder import load_messages
from sequence_planner.pipelines.inference import variables_inferred
from sequence_planner.ros.types.messages import MessageRegistry

# What is declared in a draft, one entry for each declaration: a variable, a flag or an activity.


@dataclass(frozen=True)
class Family:
    """The names of one declaration: `bolts[…]`, or the flag `robot.move(…).executing`.

    A full name is `name`, its arguments, and `suffix`; `arguments` are the enumerations these are of. `owner` is the
    resource, or None for what belongs to the station, and `indexed` whether brackets are around the arguments.
    """

    name: str
    kind: NameKind
    type: Type
    place: Place
    arguments: tuple[str, ...] = ()
    suffix: str = ""
    indexed: bool = False
    owner: str | None = None
    initial: Value | None = None
    title: str | None = None

    @cached_property
    def skeleton(self) -> str:
        """The full name without arguments."""
        return self.name + self.suffix

    @cached_property
    def step(self) -> str:
        """The resource, or what stands for the operations, with its dot; empty for a variable of the station."""
        head, dot, _ = self.name.partition(".")
        return head + dot if dot else ""

    def instance(self, words: tuple[str, ...]) -> str:
        """The full name with these arguments."""
        return with_arguments(self.name, words, self.indexed) + self.suffix

    def instances(self, enumerations: Mapping[str, EnumerationType]) -> Iterator[str]:
        """All full names."""
        for words in product(*(enumerations[argument].values for argument in self.arguments)):
            yield self.instance(words)


class Visible(NamedTuple):
    """A family as it is seen from a resource: `short` is what its name is there without arguments.

    `own` says whether it belongs to that resource; the lower its `distance`, the likelier is it meant.
    """

    family: Family
    short: str
    own: bool
    distance: int

    @property
    def long(self) -> str:
        """The full name without arguments."""
        return self.family.skeleton


# Whose names come first, where all fit what is typed as well.
_DISTANCES = {NameKind.FLAG: 2, NameKind.ACTIVITY: 4}


def seen_from(resource: str | None, families: Iterable[Family]) -> Iterator[Visible]:
    """All families as they are seen from a resource, or from the station as a whole."""
    for family in families:
        own = resource is not None and family.owner == resource
        short = family.skeleton[len(family.step) :] if own else family.skeleton
        far = 0 if own else 1 if family.owner is None else 4
        yield Visible(family, short, own, far + _DISTANCES.get(family.kind, 0))


def families_of(station: Station, declarations: Declarations) -> Iterator[Family]:
    """Everything declared that has a type."""
    for name, document in station.station.estimated.items():
        yield from _variable(None, name, document, Kind.ESTIMATED, declarations)
    for resource, whole in station.resources.items():
        for kind in (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED):
            for name, document in getattr(whole, kind.value).items():
                yield from _variable(resource, name, document, kind, declarations)
        for name, ability in whole.abilities.items():
            if (arguments := _arguments(ability.parameters, declarations)) is not None:
                yield from _flags(resource, name, ability, arguments)
    for name, operation in station.operations.items():
        if (arguments := _arguments(operation.parameters, declarations)) is not None:
            title = None if operation.title is None else str(operation.title)
            full = f"{OPERATION}.{name}"
            yield Family(full, NameKind.ACTIVITY, BOOLEAN, name.place, arguments, ".active", title=title)


def _variable(
    resource: str | None, name: SourceText, document: VariableDocument, kind: Kind, declarations: Declarations
) -> Iterator[Family]:
    full = str(name) if resource is None else f"{resource}.{name}"
    arguments = _arguments(document.each, declarations)
    if arguments is None:
        return
    family = Family(full, NameKind(kind.value), BOOLEAN, name.place, arguments, indexed=True)
    first = next(family.instances(declarations.enumerations), "")
    declared = declarations.variables.get(first)
    if declared is not None and declared.kind is kind and declared.resource == resource:
        yield Family(
            full, family.kind, declared.type, name.place, arguments, "", True, resource, initial=declared.initial
        )


def _flags(resource: str, name: SourceText, document: AbilityDocument, arguments: tuple[str, ...]) -> Iterator[Family]:
    title = None if document.title is None else str(document.title)
    for flag in FLAGS:
        text = getattr(document, flag)
        place = text.place if isinstance(text, SourceText) else name.place
        yield Family(
            f"{resource}.{name}", NameKind.FLAG, BOOLEAN, place, arguments, f".{flag}", owner=resource, title=title
        )


def _arguments(parameters: Parameters, declarations: Declarations) -> tuple[str, ...] | None:
    """The enumerations of `parameters`, or None if one of them is unknown."""
    written = tuple(map(str, parameters.values()))
    return written if all(each in declarations.enumerations for each in written) else None


# The fields of a resource's document.

_SECTIONS = {kind.value: kind for kind in (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)}


def field_of_resource(
    resource: str, document: ResourceDocument, path: EntryPath, given: Parameters | None, meaning: Meaning
) -> TextField | None:
    """The field at `path` of a resource's document."""
    match path:
        case ("abilities", str(name), *rest):
            ability = document.abilities.get(placed(name)) or AbilityDocument()
            parameters = ability.parameters if given is None else given
            return _AbilityFields(resource, name, ability, parameters).at(tuple(rest))
        case (str(section), str(name), *rest) if section in _SECTIONS:
            written: Mapping[SourceText, VariableDocument] = getattr(document, section)
            return field_of_variable(resource, name, written, _SECTIONS[section], tuple(rest), meaning)
        case ("alarms", str(), "when"):
            return TextField(FieldKind.CONDITION, alarm_condition, resource=resource)
    return None


class _AbilityFields:
    def __init__(self, resource: str, name: str, document: AbilityDocument, parameters: Parameters) -> None:
        self._document = document
        self._around: dict[str, Any] = {"resource": resource, "ability": name, "parameters": parameters}
        self._resource = resource

    def at(self, path: EntryPath) -> TextField | None:
        document, finish = self._document, self._document.finish
        match path:
            case (str(flag),) if flag in FLAGS:
                return TextField(FieldKind.CONDITION, condition, **self._around)
            case ("start" | "finish", "when"):
                return TextField(FieldKind.CONDITION, condition, **self._around)
            case ("start", "do", int(index)):
                guards = (document.enabled, document.start.when)
                return self._action(document.start.do, index, guards, START)
            case ("finish", "do", int(index)):
                texts = [] if finish is None else finish.do
                return self._action(texts, index, () if finish is None else (finish.when,), FINISH)
            case ("cancel", "do", int(index)):
                return self._action([] if document.cancel is None else document.cancel.do, index, (), CANCEL)
            case ("effects", str(), "when"):
                return TextField(FieldKind.CONDITION, observable_condition, **self._around)
            case ("effects", str(name), "do", int(index)):
                effect = document.effects.get(placed(name))
                if effect is None:
                    return self._action([], index, (), EFFECT)
                return self._action(effect.do, index, (effect.when,), EFFECT)
            case ("human", "acknowledgement"):
                return TextField(FieldKind.ACKNOWLEDGEMENT, self._acknowledgement, **self._around)
            case ("parameters", str(name)):
                return field_of_parameter(name)
        return None

    def _acknowledgement(self, meaning: Meaning, text: SourceText, scope: NameScope) -> None:
        check_acknowledgement(meaning, self._resource, text)

    def _action(
        self, texts: list[SourceText], index: int, guards: tuple[Predicate, ...], writing: Writing
    ) -> TextField:
        def read(meaning: Meaning, text: SourceText, scope: NameScope) -> object:
            return meaning.actions(with_text(texts, index, text), scope, all_of(meaning, guards, scope), writing)

        return TextField(FieldKind.ACTION, read, writing=writing, **self._around)


def field_of_variable(
    resource: str | None,
    name: str,
    documents: Mapping[SourceText, VariableDocument],
    kind: Kind,
    path: EntryPath,
    meaning: Meaning,
) -> TextField | None:
    """The field at `path` of a variable, which need not be there yet."""
    document = documents.get(placed(name)) or VariableDocument()
    key = placed(name)
    full = name if resource is None else f"{resource}.{name}"
    match path:
        case ("type",):
            return TextField(FieldKind.TYPE, lambda found, text, scope: found.declarations.type_of(key, text, kind))
        case ("initial",):
            type_ = meaning.declarations.noting(Findings()).type_of(key, document.type, kind)
            return TextField(
                FieldKind.INITIAL,
                lambda found, text, scope: type_ and found.declarations.initial_of(key, full, text, type_),
                type=type_,
            )
        case ("for", str(parameter)):
            return field_of_parameter(parameter)
    return None


# The fields of the documents beside the resources: station, operations and specifications.


def field_of_station(station: Station, path: EntryPath, meaning: Meaning) -> TextField | None:
    """The field at `path` of `station.yaml`."""
    match path:
        case ("rest",):
            return TextField(FieldKind.CONDITION, condition)
        case ("alarms", str(), "when"):
            return TextField(FieldKind.CONDITION, alarm_condition)
        case ("estimated", str(name), *rest):
            documents = station.station.estimated
            return field_of_variable(None, name, documents, Kind.ESTIMATED, tuple(rest), meaning)
    return None


def field_of_operation(station: Station, path: EntryPath, given: Parameters | None) -> TextField | None:
    """The field at `path` of `operations.yaml`."""
    match path:
        case (str(name), "precondition" | "goal" | "local" as part):
            document = station.operations.get(placed(name))
            written = {} if document is None else document.parameters
            parameters = written if given is None else given
            if part == "local":
                return TextField(FieldKind.FORMULA, Meaning.formula, parameters, operation=name)
            return TextField(FieldKind.CONDITION, condition, parameters, operation=name)
        case (str(), "parameters", str(parameter)):
            return field_of_parameter(parameter)
    return None


def field_of_specification(station: Station, path: EntryPath, given: Parameters | None) -> TextField | None:
    """The field at `path` of `specifications.yaml`."""
    match path:
        case (str(name), *rest):
            document = station.specifications.get(placed(name))
            written = {} if document is None else document.parameters
            parameters = written if given is None else given
            return _of_specification(station, document, tuple(rest), parameters)
    return None


def _of_specification(
    station: Station, document: SpecificationDocument | None, path: EntryPath, parameters: Parameters
) -> TextField | None:
    match path:
        case ("forbidden" | "never" | "while",) | ("order", int()):
            return TextField(FieldKind.CONDITION, condition, parameters)
        case ("zone", str(resource)):
            # Where the resource is none, that is found at its name, and the condition is not read.
            read = condition if resource in station.resources else _unread
            return TextField(FieldKind.CONDITION, read, parameters, resource)
        case ("exclusive", int(index)):
            texts = (document and document.exclusive) or []
            return TextField(
                FieldKind.ABILITY,
                lambda meaning, text, scope: exclusive_abilities(meaning, with_text(texts, index, text), scope),
                parameters,
            )
        case ("parameters", str(parameter)):
            return field_of_parameter(parameter)
    return None


def _unread(meaning: Meaning, text: SourceText, scope: NameScope) -> object:
    return None


# Everything that names mean in one draft of a station.


class Lexicon:
    """The declarations of a draft, which may be as wrong as drafts are; made when it is first asked for."""

    def __init__(self, station: Station, registry: MessageRegistry | None = None) -> None:
        self._written = station
        self._registry = registry
        self._seen: dict[str | None, tuple[Visible, ...]] = {}

    @classmethod
    def of(cls, station: Station, registry: MessageRegistry | None = None) -> Lexicon:
        """The lexicon of a draft; `registry` has its message types where they are read already."""
        return cls(station, registry)

    @cached_property
    def station(self) -> Station:
        """The draft with the variables that follow from its message types, as far as these are known."""
        registry = messages_of(self._written) if self._registry is None else self._registry
        return variables_inferred(self._written, registry)[0]

    @cached_property
    def declarations(self) -> Declarations:
        """Its names."""
        return Declarations(self.station, Findings())

    @cached_property
    def operations(self) -> tuple[str, ...]:
        """The ground operations."""
        return tuple(
            instance_name(name, binding)
            for name, document in self.station.operations.items()
            for binding in self.declarations.bindings(document.parameters)
        )

    @cached_property
    def families(self) -> tuple[Family, ...]:
        """All that is declared and can be read or written, in order of declaration."""
        return tuple(families_of(self.station, self.declarations))

    @cached_property
    def family(self) -> Mapping[str, Family]:
        """The family that each full name is one of."""
        return {name: family for family in self.families for name in family.instances(self.declarations.enumerations)}

    def seen_from(self, resource: str | None) -> tuple[Visible, ...]:
        """The same as they are seen from a resource, or from the station as a whole."""
        if resource not in self._seen:
            self._seen[resource] = tuple(seen_from(resource, self.families))
        return self._seen[resource]

    def field(self, file: str, path: EntryPath, parameters: Mapping[str, str] | None = None) -> TextField | None:
        """Return what stands at an entry of a file of the station, or None where no names stand.

        What the entry belongs to may be new; its `parameters` can then be given, as the enumeration of each.
        """
        given = None if parameters is None else {placed(name): placed(each) for name, each in parameters.items()}
        station, meaning = self.station, Meaning(self.declarations, Findings())
        at = PurePosixPath(file)
        match at.parts:
            case ("resources", _) if at.suffix == ".yaml":
                document = station.resources.get(at.stem) or ResourceDocument()
                return field_of_resource(at.stem, document, path, given, meaning)
            case ("station.yaml",):
                return field_of_station(station, path, meaning)
            case ("operations.yaml",):
                return field_of_sequence(station, path, self.operations) or field_of_operation(station, path, given)
            case ("specifications.yaml",):
                return field_of_specification(station, path, given)
            case ("work_masters.yaml",):
                return field_of_work_master(station, path, self.operations, meaning)
        return None

    def meaning(self, field: TextField, findings: Findings | None = None) -> Meaning:
        """Return what texts mean at a field; what is wrong with them is noted in `findings`."""
        noted = findings or Findings()
        return Meaning(self.declarations.noting(noted, self._types(field)), noted)

    def within(self, place: Place) -> Place:
        """A place with its file as it is called within the station."""
        return place._replace(file=place.file.removeprefix(f"{self._written.folder}/"))

    def _types(self, field: TextField) -> dict[str, Type]:
        """The type of everything that can be read, with what the field's own part adds if it is new."""
        types = self.declarations.types
        own: list[str] = []
        for binding in self.declarations.bindings(field.parameters):
            if field.ability:
                own += (field.prefixes(binding)[0] + flag for flag in FLAGS)
            elif field.operation:
                own.append(f"{OPERATION}.{instance_name(field.operation, binding)}.active")
        new = [name for name in own if name not in types]
        return types | dict.fromkeys(new, BOOLEAN) if new else types


def messages_of(station: Station) -> MessageRegistry:
    """The message types of a draft; the standard ones alone where a definition of its own is wrong."""
    try:
        return load_messages(station)
    except ModelError:
        return MessageRegistry.from_folder(None)


# How the names of a draft are written at a field: in their shortest form, with parameters where these can stand.

_MOST_FORMS = 2000  # of one family


class VisibleNames:
    """The names that can be seen from one field."""

    def __init__(self, lexicon: Lexicon, field: TextField) -> None:
        self._lexicon = lexicon
        self._field = field
        self._meaning = lexicon.meaning(field)

    @cached_property
    def scope(self) -> NameScope:
        """The meaning of names, for the first choice of the parameters."""
        first = next(self._field.scopes(self._meaning), None)
        return first or self._meaning.scope({}, *self._field.prefixes({}))

    @cached_property
    def parameters(self) -> Mapping[str, EnumerationType]:
        """The parameters with what they range over."""
        enumerations = self.enumerations
        written = ((str(name), enumerations.get(each)) for name, each in self._field.parameters.items())
        return {name: type_ for name, type_ in written if type_ is not None}

    @property
    def enumerations(self) -> Mapping[str, EnumerationType]:
        """The enumerations of the draft."""
        return self._lexicon.declarations.enumerations

    def flags(self) -> Iterator[str]:
        """The flags of the field's own ability, by their bare names."""
        if self._field.ability:
            own = self.scope.prefixes[0]
            yield from (name.removeprefix(own) for name in beginning_with(own, self.scope.names))

    def values(self) -> Iterator[tuple[str, str]]:
        """Each value of each enumeration, with the enumeration."""
        for name, type_ in self.enumerations.items():
            for value in type_.values:
                yield value, name

    @property
    def families(self) -> tuple[Visible, ...]:
        """All families that have a name here."""
        return self._lexicon.seen_from(self._field.resource)

    def forms(self, seen: Visible, long: bool = False) -> Iterator[str]:
        """The names of a family as they can be written here: one for each choice of values or parameters."""
        name = seen.family.name if long or not seen.own else seen.family.name.removeprefix(f"{self._field.resource}.")
        for words in islice(self._arguments(seen.family), _MOST_FORMS):
            written = with_arguments(name, words, seen.family.indexed) + seen.family.suffix
            if written not in self.parameters and self._found(name, words, seen.family) == seen.family.instance(
                tuple(map(self._value, words))
            ):
                yield written

    def has_parameter(self, form: str) -> bool:
        """Return whether a parameter is among the arguments of a name."""
        return any(word in self.parameters for word in re.findall(r"\w+", form))

    def _arguments(self, family: Family) -> Iterator[tuple[str, ...]]:
        if not family.arguments:
            return iter([()])
        choices: list[Sequence[str]] = []
        for argument in family.arguments:
            values = self.enumerations[argument].values
            fitting = [name for name, type_ in self.parameters.items() if set(type_.values) <= set(values)]
            choices.append([*fitting, *values])
        return product(*choices)

    def _value(self, word: str) -> str:
        return self.scope.parameters[word][0] if word in self.scope.parameters else word

    def _found(self, name: str, words: tuple[str, ...], family: Family) -> str | None:
        """The full name that a written one has here."""
        text = with_arguments(name, map(self._value, words), family.indexed) + family.suffix
        for prefix in (*self.scope.prefixes, ""):
            if prefix + text in self.scope.variables:
                return prefix + text
        return None


def abilities(families: Iterable[Visible]) -> Iterator[Visible]:
    """One of the families of each ability."""
    for seen in families:
        if seen.family.kind is NameKind.FLAG and seen.family.suffix == ".executing":
            yield seen
