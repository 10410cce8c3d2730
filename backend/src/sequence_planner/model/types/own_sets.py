"""Sets that a resource declares: by their own names within it, and by their full ones wherever types are read."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import TypeVar

from sequence_planner.model.documents import (
    AbilityDocument,
    Members,
    NamedCondition,
    Parameters,
    PredicateDocument,
    RelationDocument,
    ResourceDocument,
    SetDocument,
    ValueMapDocument,
    VariableDocument,
)
from sequence_planner.model.source import SourceText

T = TypeVar("T")
_SECTIONS = ("measured", "output", "estimated")


def with_own_sets(resource: str, document: ResourceDocument) -> ResourceDocument:
    """The same resource, with the full name wherever one of its own sets is named as a type or for its values.

    What conditions and actions name is found when they are read.
    """
    if not document.sets:
        return document
    return _Full(resource, document.sets).made_of(document)


class _Full:
    def __init__(self, resource: str, sets: Collection[SourceText]) -> None:
        self._resource = resource
        self._sets = frozenset(map(str, sets))

    def made_of(self, document: ResourceDocument) -> ResourceDocument:
        """The resource with full names of its sets."""
        return document.model_copy(
            update={
                **{key: self._each(getattr(document, key), self._variable) for key in _SECTIONS},
                "abilities": self._each(document.abilities, self._ability),
                "predicates": self._each(document.predicates, self._predicate),
                "sets": self._each(document.sets, self._set),
                "relations": self._each(document.relations, self._relation),
                "maps": self._each(document.maps, self._map),
            }
        )

    def _each(self, documents: Mapping[SourceText, T], made: Callable[[T], T]) -> dict[SourceText, T]:
        return {name: made(document) for name, document in documents.items()}

    def _named(self, text: SourceText) -> SourceText:
        return SourceText(f"{self._resource}.{text}", text.place, text.raw) if text in self._sets else text

    def _variable(self, document: VariableDocument) -> VariableDocument:
        type_ = None if document.type is None else self._named(document.type)
        return document.model_copy(update={"type": type_, "each": self._parameters(document.each)})

    def _ability(self, document: AbilityDocument) -> AbilityDocument:
        effects = {
            name: effect.model_copy(update={"each": self._parameters(effect.each)})
            for name, effect in document.effects.items()
        }
        return document.model_copy(update={"parameters": self._parameters(document.parameters), "effects": effects})

    def _predicate(self, document: NamedCondition) -> NamedCondition:
        if not isinstance(document, PredicateDocument):
            return document
        return document.model_copy(update={"parameters": self._parameters(document.parameters)})

    def _set(self, document: SetDocument) -> SetDocument:
        changed = {
            key: None if texts is None else list(map(self._named, texts))
            for key, texts in (("values", document.values), ("excludes", document.excludes))
        }
        return document.model_copy(update={"of": self._named(document.of), **changed})

    def _relation(self, document: RelationDocument) -> RelationDocument:
        pairs = [[self._members(each) for each in pair] for pair in document.pairs]
        return document.model_copy(update={"between": list(map(self._named, document.between)), "pairs": pairs})

    def _map(self, document: ValueMapDocument) -> ValueMapDocument:
        values = {self._named(key): value for key, value in document.values.items()}
        return document.model_copy(
            update={"source": self._named(document.source), "to": self._named(document.to), "values": values}
        )

    def _members(self, members: Members) -> Members:
        return list(map(self._named, members)) if isinstance(members, list) else self._named(members)

    def _parameters(self, parameters: Parameters) -> Parameters:
        return {name: self._named(of) for name, of in parameters.items()}
