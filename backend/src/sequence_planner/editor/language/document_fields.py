"""The fields of the documents of a station: what is written at each path of a file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.declarations import FLAGS
from sequence_planner.automaton.findings import Findings
from sequence_planner.automaton.grounding.abilities import CANCEL, EFFECT, FINISH, START, check_acknowledgement
from sequence_planner.automaton.grounding.meaning import Meaning, Writing, alarm_condition, observable_condition
from sequence_planner.automaton.grounding.specifications import exclusive_abilities
from sequence_planner.automaton.shorthand import parts_of
from sequence_planner.editor.language.field import (
    FieldKind,
    TextField,
    all_of,
    condition,
    field_of_parameter,
    placed,
    with_text,
)
from sequence_planner.editor.language.shorthand_fields import (
    field_of_enumeration,
    field_of_map,
    field_of_relation,
    field_of_set,
)
from sequence_planner.language.names.scope import NameScope
from sequence_planner.model.documents import (
    AbilityDocument,
    EffectDocument,
    NamedCondition,
    Parameters,
    ResourceDocument,
    SpecificationDocument,
    VariableDocument,
)
from sequence_planner.model.fields import Predicate
from sequence_planner.model.loader import Station
from sequence_planner.model.source import SourceText
from sequence_planner.model.yaml.reader import EntryPath

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
        case ("predicates", str(name), *rest):
            return field_of_predicate(resource, document.predicates.get(placed(name)), tuple(rest), given)
    return None


def field_of_predicate(
    resource: str | None, document: NamedCondition | None, path: EntryPath, given: Parameters | None
) -> TextField | None:
    """The field at `path` of a predicate, which need not be there yet."""
    written, _ = parts_of(True if document is None else document)
    match path:
        case () | ("when",):
            return TextField(FieldKind.CONDITION, condition, written if given is None else given, resource)
        case ("parameters", str(parameter)):
            return field_of_parameter(parameter, resource)
    return None


class _AbilityFields:
    def __init__(self, resource: str, name: str, document: AbilityDocument, parameters: Parameters) -> None:
        self._document = document
        self._around: dict[str, Any] = {"resource": resource, "ability": name, "parameters": parameters}
        self._resource = resource

    def at(self, path: EntryPath) -> TextField | None:
        document, finish = self._document, self._document.finish
        match path:
            case (str(flag),) if flag in (*FLAGS, "until"):
                return TextField(FieldKind.CONDITION, condition, **self._around)
            case ("start" | "finish", "when"):
                return TextField(FieldKind.CONDITION, condition, **self._around)
            case ("start", "do", int(index)):
                guards = (document.enabled, document.start.when)
                return self._action(document.start.do, index, guards, START)
            case ("finish", "do", int(index)):
                texts = [] if finish is None else finish.do
                until = () if document.until is None else (document.until,)
                return self._action(texts, index, until if finish is None else (*until, finish.when), FINISH)
            case ("cancel", "do", int(index)):
                return self._action([] if document.cancel is None else document.cancel.do, index, (), CANCEL)
            case ("effects", str(name), *rest):
                return self._of_effect(document.effects.get(placed(name)), tuple(rest))
            case ("human", "acknowledgement"):
                return TextField(FieldKind.ACKNOWLEDGEMENT, self._acknowledgement, **self._around)
            case ("parameters", str(name)):
                return field_of_parameter(name, self._resource)
        return None

    def _of_effect(self, effect: EffectDocument | None, path: EntryPath) -> TextField | None:
        each = {} if effect is None else effect.each
        around = {**self._around, "parameters": {**self._around["parameters"], **each}, "each": each}
        match path:
            case ("when",):
                return TextField(FieldKind.CONDITION, observable_condition, **around)
            case ("do", int(index)):
                guards = () if effect is None or effect.when is None else (effect.when,)
                return self._action([] if effect is None else effect.do, index, guards, EFFECT, around)
            case ("for", str(word)):
                return field_of_parameter(word, self._resource)
        return None

    def _acknowledgement(self, meaning: Meaning, text: SourceText, scope: NameScope) -> None:
        check_acknowledgement(meaning, self._resource, text)

    def _action(
        self,
        texts: list[SourceText],
        index: int,
        guards: tuple[Predicate, ...],
        writing: Writing,
        around: dict[str, Any] | None = None,
    ) -> TextField:
        def read(meaning: Meaning, text: SourceText, scope: NameScope) -> object:
            return meaning.actions(with_text(texts, index, text), scope, all_of(meaning, guards, scope), writing)

        return TextField(FieldKind.ACTION, read, writing=writing, **(around or self._around))


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
            return TextField(
                FieldKind.TYPE,
                lambda found, text, scope: found.declarations.type_of(
                    key, found.declarations.domain_in(text, resource), kind
                ),
                resource=resource,
            )
        case ("initial",):
            type_ = meaning.declarations.noting(Findings()).type_of(key, document.type, kind)
            return TextField(
                FieldKind.INITIAL,
                lambda found, text, scope: type_ and found.declarations.initial_of(key, full, text, type_),
                type=type_,
            )
        case ("for", str(parameter)):
            return field_of_parameter(parameter, resource)
    return None


# The fields of the documents beside the resources: station, operations and specifications.


def field_of_station(
    station: Station, path: EntryPath, meaning: Meaning, given: Parameters | None = None
) -> TextField | None:
    """The field at `path` of `station.yaml`."""
    match path:
        case ("rest",):
            return TextField(FieldKind.CONDITION, condition)
        case ("alarms", str(), "when"):
            return TextField(FieldKind.CONDITION, alarm_condition)
        case ("estimated", str(name), *rest):
            documents = station.station.estimated
            return field_of_variable(None, name, documents, Kind.ESTIMATED, tuple(rest), meaning)
        case ("predicates", str(name), *rest):
            return field_of_predicate(None, station.station.predicates.get(placed(name)), tuple(rest), given)
        case ("enumerations", str(name), "includes", int(index)):
            return field_of_enumeration(station, placed(name), index)
        case ("sets", str(name), *rest):
            return field_of_set(station, placed(name), tuple(rest), meaning)
        case ("relations", str(name), *rest):
            return field_of_relation(station, placed(name), tuple(rest), meaning)
        case ("maps", str(name), *rest):
            return field_of_map(station, placed(name), tuple(rest), meaning)
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
