"""The names of a station that stand for something longer: named sets, relations, maps and predicates, read from their
documents and checked.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Protocol, TypeVar

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.findings import Findings
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.parser import parse
from sequence_planner.language.shorthand.vocabulary import NamedPredicate, ValueMap, ValueRelation
from sequence_planner.language.syntax import FALSE, TRUE, Expression, ExpressionError
from sequence_planner.language.types import EnumerationType, Place, Type, Value, contains
from sequence_planner.model.documents import (
    EnumerationDocument,
    NamedCondition,
    PredicateDocument,
    RelationDocument,
    SetDocument,
    ValueMapDocument,
)
from sequence_planner.model.fields import Predicate
from sequence_planner.model.loader import Station
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

D = TypeVar("D")

# Enumerations and named sets.


def read_enumerations(station: Station, findings: Findings, unusable: set[str]) -> dict[str, EnumerationType]:
    """The type of each enumeration; what is wrong with what it includes is noted, and it is `unusable` then, as are
    those that include it.
    """
    found: dict[str, EnumerationType] = {}
    written = station.station.enumerations
    for name, document in written.items():
        before = len(findings.all)
        if isinstance(document, EnumerationDocument):
            check_included(name, document, station, findings)
        if len(findings.all) > before:
            unusable.add(str(name))
    for name, values in station.station.enumeration_values().items():
        if not unusable.isdisjoint(_reached(name, station)):
            unusable.add(str(name))
        elif values:
            found[str(name)] = EnumerationType(tuple(map(str, values)))
    return found


def own_values(document: list[SourceText] | EnumerationDocument) -> list[SourceText]:
    """The values that an enumeration has itself."""
    return document.values if isinstance(document, EnumerationDocument) else document


def check_included(name: SourceText, document: EnumerationDocument, station: Station, findings: Findings) -> None:
    """Note what an enumeration includes and cannot."""
    enumerations = station.station.enumerations
    for each in document.includes:
        if each not in enumerations:
            findings.add(
                each, message("wrong.unknown-enumeration", name=str(each), hint=suggestion(each, enumerations))
            )
        elif name in _reached(each, station):
            findings.add(each, message("wrong.includes-itself", name=str(name)))


def _reached(name: str, station: Station) -> set[str]:
    """The enumerations that `name` includes, itself among them, over any number of steps."""
    found: set[str] = set()
    pending = [name]
    while pending:
        if (each := pending.pop()) not in found:
            found.add(each)
            written = station.station.enumerations.get(SourceText(each, Place("", 1, 1), each))
            pending += map(str, written.includes) if isinstance(written, EnumerationDocument) else ()
    return found


class DeclaredTypes(Protocol):
    """The types that are declared so far, and how parameters and types are checked."""

    enumerations: dict[str, EnumerationType]
    unusable: set[str]

    def check_parameters(self, parameters: Mapping[SourceText, SourceText], *prefixes: str) -> None:
        """Note parameters that are none, or hide something."""

    def type_of(self, name: SourceText, text: SourceText | None, kind: Kind | None) -> Type | None:
        """The type that `text` means; if it means none, that is noted."""


class ShorthandReader:
    """Reads the documents of names that stand for something longer; what is wrong is noted."""

    def __init__(self, declarations: DeclaredTypes, station: Station, findings: Findings) -> None:
        self._declarations = declarations
        self._station = station.station
        self._resources = station.resources
        self._findings = findings
        self._domains = declarations.enumerations
        self._unusable = declarations.unusable

    def read_sets(self) -> Iterator[tuple[SourceText, EnumerationType]]:
        """Each named set with its values, in the order of its enumeration; those of resources by their full names."""
        written = written_in(self._station.sets, self._of_resources("sets"))
        pending = {SourceText(full, name.place, name.raw): document for full, name, document in written}
        while pending:
            ready = [name for name, document in pending.items() if not self._needs(document) & set(map(str, pending))]
            for name in ready or pending:
                if not ready:
                    self._findings.add(name, message("wrong.part-of-itself", name=str(name)))
                    self._unusable.add(str(name))
                elif (type_ := self.read_set(name, pending[name])) is None:
                    self._unusable.add(str(name))
                else:
                    yield name, type_
            pending = {name: document for name, document in pending.items() if ready and name not in ready}

    def _needs(self, document: SetDocument) -> set[str]:
        return {str(document.of), *map(str, document.values or document.excludes or ())}

    def read_set(self, name: SourceText, document: SetDocument) -> EnumerationType | None:
        """The values of one set; None where something is wrong with it, or nothing is left."""
        texts = document.values or document.excludes or []
        if (whole := self._domain(document.of)) is None:
            return None
        before = len(self._findings.all)
        named = self._values_among(texts, whole)
        if len(self._findings.all) > before or any(str(text) in self._unusable for text in texts):
            return None
        is_kept = document.values is not None
        values = tuple(value for value in whole.values if (value in named) is is_kept)
        if not values:
            self._findings.add(name, message("wrong.empty-set", of=str(document.of), name=str(name)))
            return None
        return EnumerationType(values)

    def _values_among(self, texts: Iterable[SourceText], whole: EnumerationType) -> dict[str, None]:
        """The values that `texts` name, each itself or by a set; what is none of `whole` is noted."""
        found: dict[str, None] = {}
        for text in texts:
            if text in whole.values:
                found[str(text)] = None
            elif str(text) in self._domains:
                found |= dict.fromkeys(value for value in self._domains[str(text)].values if value in whole.values)
                if strangers := [value for value in self._domains[str(text)].values if value not in whole.values]:
                    self._findings.add(text, message("wrong.strangers", name=str(text), value=strangers[0]))
            elif str(text) not in self._unusable:
                owner = next((name for name, each in self._domains.items() if text in each.values), None)
                near = suggestion(text, [*whole.values, *self._domains])
                near = near if owner is None else message("hint.one-of-set", name=owner)
                self._findings.add(
                    text, message("wrong.no-value-and-no-set", name=str(text), values=_shortly(whole), hint=near)
                )
        return found

    def _domain(self, name: SourceText) -> EnumerationType | None:
        if str(name) not in self._domains and str(name) not in self._unusable:
            near = suggestion(name, self._domains)
            self._findings.add(name, message("wrong.unknown-domain", name=str(name), hint=near))
        return self._domains.get(str(name))

    # Relations and maps

    def read_relations(self) -> Iterator[tuple[str, ValueRelation]]:
        """Each relation with its pairs, by its full name."""
        for full, _, document in written_in(self._station.relations, self._of_resources("relations")):
            if (relation := self.read_relation(document)) is not None:
                yield full, relation

    def read_relation(self, document: RelationDocument) -> ValueRelation | None:
        """One relation; None where one of its enumerations is unknown."""
        first, second = map(self._domain, document.between)
        if first is None or second is None:
            return None
        pairs: set[tuple[str, str]] = set()
        for one, other in document.pairs:
            for left in self._values_among(one if isinstance(one, list) else [one], first):
                for right in self._values_among(other if isinstance(other, list) else [other], second):
                    pairs.add((left, right))
                    if document.symmetric:
                        pairs.add((right, left))
        if document.symmetric and set(first.values) != set(second.values):
            said = message("wrong.symmetric", one=_shortly(first), other=_shortly(second))
            self._findings.add(document.between[1], said)
        return ValueRelation((first, second), frozenset(pairs))

    def read_maps(self) -> Iterator[tuple[str, ValueMap]]:
        """Each map with its table, by its full name."""
        for full, name, document in written_in(self._station.maps, self._of_resources("maps")):
            if (found := self.read_map(name, document)) is not None:
                yield full, found

    def _of_resources(self, section: str) -> Mapping[str, Mapping[SourceText, Any]]:
        return {resource: getattr(document, section) for resource, document in self._resources.items()}

    def read_map(self, name: SourceText, document: ValueMapDocument) -> ValueMap | None:
        """One map; None where what it is from or to is unknown."""
        source = self._domain(document.source)
        target = self._declarations.type_of(name, document.to, None)
        if source is None or target is None:
            return None
        return ValueMap(source, target, self._table(name, document, source, target))

    def _table(
        self, name: SourceText, document: ValueMapDocument, source: EnumerationType, target: Type
    ) -> Mapping[str, Value]:
        table: dict[str, Value] = {}
        before = len(self._findings.all)
        is_whole = not any(str(key) in self._unusable for key in document.values)
        for key, value in document.values.items():
            self._check_value(key, value, target)
            for each in self._values_among([key], source):
                if each in table:
                    self._findings.add(key, message("wrong.mapped-already", value=each, name=str(name)))
                table[each] = str(value) if isinstance(value, SourceText) else value
        missing = [value for value in source.values if value not in table]
        if document.otherwise is not None:
            self._check_value(name, document.otherwise, target)
            rest = document.otherwise
            table |= dict.fromkeys(missing, str(rest) if isinstance(rest, SourceText) else rest)
        elif missing and is_whole and len(self._findings.all) == before:
            shown = [f"`{value}`" for value in missing]
            said = message("wrong.nothing-for", name=str(name), values=shown, count=len(missing))
            self._findings.add(name, said)
        return table

    def _check_value(self, key: SourceText, value: Value | SourceText, target: Type) -> None:
        plain = str(value) if isinstance(value, SourceText) else value
        if not contains(target, plain):
            where = value if isinstance(value, SourceText) else key
            near = suggestion(str(plain), map(str, target.domain))
            self._findings.add(where, message("wrong.not-in", value=str(plain), range=str(target), hint=near))

    # Predicates

    def read_predicates(
        self, resources: Mapping[str, Mapping[SourceText, NamedCondition]]
    ) -> dict[str, NamedPredicate]:
        """Each predicate by its full name. What is wrong with its condition is noted when it is checked."""
        found: dict[str, NamedPredicate] = {}
        for resource, name, document in written_predicates(self._station.predicates, resources):
            full = str(name) if resource is None else f"{resource}.{name}"
            prefixes = () if resource is None else (f"{resource}.",)
            parameters, condition = parts_of(document)
            self._declarations.check_parameters(parameters, *prefixes)
            types = {str(each): self._domains.get(str(of)) for each, of in parameters.items()}
            known = {each: type_ for each, type_ in types.items() if type_ is not None}
            body = _body(condition)
            if len(known) == len(types) and body is not None:
                found[full] = NamedPredicate(full, known, body, prefixes)
        return found


def _body(text: Predicate) -> Expression | None:
    if not isinstance(text, SourceText):
        return TRUE if text else FALSE
    try:
        return parse(text)
    except ExpressionError:
        return None


def written_predicates(
    station: Mapping[SourceText, NamedCondition], resources: Mapping[str, Mapping[SourceText, NamedCondition]]
) -> Iterator[tuple[str | None, SourceText, Predicate | PredicateDocument]]:
    """Each predicate as it is written, with its resource."""
    for resource, documents in ((None, station), *resources.items()):
        for name, document in documents.items():
            yield resource, name, document


def written_in(
    station: Mapping[SourceText, D], resources: Mapping[str, Mapping[SourceText, D]]
) -> Iterator[tuple[str, SourceText, D]]:
    """Each document of what the station and its resources declare: its full name, its name as written, and itself."""
    yield from ((str(name), name, document) for name, document in station.items())
    for resource, documents in resources.items():
        yield from ((f"{resource}.{name}", name, document) for name, document in documents.items())


def parts_of(document: Predicate | PredicateDocument) -> tuple[dict[SourceText, SourceText], Predicate]:
    """The parameters and the condition of a predicate as they are written."""
    return (document.parameters, document.when) if isinstance(document, PredicateDocument) else ({}, document)


def _shortly(type_: EnumerationType) -> str:
    values = type_.values
    return str(type_) if len(values) <= 5 else f"{{{', '.join(values[:3])}, … {values[-1]}}}"
