"""The fields of a resource's document."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sequence_planner.automaton.grounding.abilities import (
    CANCEL,
    EFFECT,
    FINISH,
    START,
    check_acknowledgement,
    observable_condition,
)
from sequence_planner.automaton.grounding.declarations import FLAGS
from sequence_planner.automaton.grounding.findings import Findings
from sequence_planner.automaton.grounding.meaning import Meaning, Writing
from sequence_planner.automaton.structure import Kind
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import Scope
from sequence_planner.expressions.syntax import conjunction
from sequence_planner.model.documents import AbilityDocument, Parameters, Predicate, ResourceDocument, VariableDocument
from sequence_planner.model.reading import EntryPath
from sequence_planner.model.source import SourceText
from sequence_planner.workshop.language.field import Field, FieldKind, condition, with_text

_SECTIONS = {kind.value: kind for kind in (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)}


def field_of_resource(
    resource: str, document: ResourceDocument, path: EntryPath, given: Parameters | None, meaning: Meaning
) -> Field | None:
    """The field at `path` of a resource's document."""
    match path:
        case ("abilities", str(name), *rest):
            ability = document.abilities.get(placed(name)) or AbilityDocument()
            parameters = ability.parameters if given is None else given
            return _AbilityFields(resource, name, ability, parameters).at(tuple(rest))
        case (str(section), str(name), *rest) if section in _SECTIONS:
            written: Mapping[SourceText, VariableDocument] = getattr(document, section)
            return field_of_variable(resource, name, written, _SECTIONS[section], tuple(rest), meaning)
    return None


class _AbilityFields:
    def __init__(self, resource: str, name: str, document: AbilityDocument, parameters: Parameters) -> None:
        self._document = document
        self._around: dict[str, Any] = {"resource": resource, "ability": name, "parameters": parameters}
        self._resource = resource

    def at(self, path: EntryPath) -> Field | None:
        document, finish = self._document, self._document.finish
        match path:
            case (str(flag),) if flag in FLAGS:
                return Field(FieldKind.CONDITION, condition, **self._around)
            case ("start" | "finish", "when"):
                return Field(FieldKind.CONDITION, condition, **self._around)
            case ("start", "do", int(index)):
                guards = (document.enabled, document.start.when)
                return self._action(document.start.do, index, guards, START)
            case ("finish", "do", int(index)):
                texts = [] if finish is None else finish.do
                return self._action(texts, index, () if finish is None else (finish.when,), FINISH)
            case ("cancel", "do", int(index)):
                return self._action([] if document.cancel is None else document.cancel.do, index, (), CANCEL)
            case ("effects", str(), "when"):
                return Field(FieldKind.CONDITION, observable_condition, **self._around)
            case ("effects", str(name), "do", int(index)):
                effect = document.effects.get(placed(name))
                if effect is None:
                    return self._action([], index, (), EFFECT)
                return self._action(effect.do, index, (effect.when,), EFFECT)
            case ("human", "acknowledgement"):
                return Field(FieldKind.ACKNOWLEDGEMENT, self._acknowledgement, **self._around)
            case ("parameters", str(name)):
                return field_of_parameter(name)
        return None

    def _acknowledgement(self, meaning: Meaning, text: SourceText, scope: Scope) -> None:
        check_acknowledgement(meaning, self._resource, text)

    def _action(self, texts: list[SourceText], index: int, guards: tuple[Predicate, ...], writing: Writing) -> Field:
        def read(meaning: Meaning, text: SourceText, scope: Scope) -> object:
            holds = conjunction(*(meaning.predicate(guard, scope) for guard in guards))
            return meaning.actions(with_text(texts, index, text), scope, holds, writing)

        return Field(FieldKind.ACTION, read, writing=writing, **self._around)


def field_of_variable(
    resource: str | None,
    name: str,
    documents: Mapping[SourceText, VariableDocument],
    kind: Kind,
    path: EntryPath,
    meaning: Meaning,
) -> Field | None:
    """The field at `path` of a variable, which need not be there yet."""
    document = documents.get(placed(name)) or VariableDocument()
    key = placed(name)
    full = name if resource is None else f"{resource}.{name}"
    match path:
        case ("type",):
            return Field(FieldKind.TYPE, lambda found, text, scope: found.declarations.type_of(key, text, kind))
        case ("initial",):
            type_ = meaning.declarations.noting(Findings()).type_of(key, document.type, kind)
            return Field(
                FieldKind.INITIAL,
                lambda found, text, scope: type_ and found.declarations.initial_of(key, full, text, type_),
                type=type_,
            )
        case ("for", str(parameter)):
            return field_of_parameter(parameter)
    return None


def field_of_parameter(name: str) -> Field:
    """The enumeration of the parameter `name`."""
    key = placed(name)
    return Field(FieldKind.ENUMERATION, lambda meaning, text, scope: meaning.declarations.check_parameters({key: text}))


def placed(name: str) -> SourceText:
    """A name as a key of documents, at no place in particular."""
    return SourceText(name, Place("", 1, 1), name)
