"""Reads what a model calls its parts when it speaks to people."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.findings import Findings, without_arguments
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.shorthand.titles import Titles, VariableTitles, Words
from sequence_planner.language.types import BOOLEAN, EnumerationType, Type, Value
from sequence_planner.model import documents, fields
from sequence_planner.model.fields import by_language, words_of
from sequence_planner.model.loader import Station
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

VALUE = "value"  # stands in a phrase for what the variable is
_KINDS = (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)
_IN_BRACES = re.compile(r"\{([^{}]*)\}")


class TitleReader:
    """Reads the titles of `station`, whose names have these types; what is wrong is noted."""

    def __init__(
        self, station: Station, enumerations: Mapping[str, EnumerationType], types: Mapping[str, Type], found: Findings
    ) -> None:
        self._station = station
        self._enumerations = enumerations
        self._types = {without_arguments(name): type_ for name, type_ in types.items()}
        self._findings = found

    def read_titles(self) -> Titles:
        """Read all of them; those of parts that can have parameters are checked."""
        for text, parameters in _texts_of_parts(self._station):
            self._check_words(text, parameters)
        return Titles(dict(self._variables()), self._values(), self._sets(), dict(self._predicates()))

    def _variables(self) -> Iterator[tuple[str, VariableTitles]]:
        sections: list[tuple[str | None, bool, Mapping[SourceText, documents.VariableDocument]]]
        sections = [(None, False, self._station.station.estimated)]
        for resource, whole in self._station.resources.items():
            sections += [(resource, kind is Kind.MEASURED, getattr(whole, kind.value)) for kind in _KINDS]
        for owner, is_measured, section in sections:
            for name, document in section.items():
                full = str(name) if owner is None else f"{owner}.{name}"
                if document.title is not None or document.phrase is not None or document.titles or document.by_hand:
                    self._check_words(document.title, document.each)
                    self._check_words(document.phrase, {*document.each, VALUE})
                    self._check_phrase(document.phrase)
                    values = self._read_values(document.titles, self._types.get(full), full)
                    by_hand = self._read_by_hand(document, self._types.get(full), full, is_measured)
                    yield full, VariableTitles(words_of(document.title), words_of(document.phrase), values, by_hand)

    def _values(self) -> dict[EnumerationType, Mapping[Value, Words]]:
        """The titles of each enumeration's values: its own, then those of what it includes."""
        found: dict[EnumerationType, Mapping[Value, Words]] = {}
        for name in self._station.station.enumerations:
            document, type_ = self._station.station.enumerations[name], self._enumerations.get(str(name))
            if isinstance(document, documents.EnumerationDocument) and type_ is not None:
                self._read_values(document.titles, type_, str(name))
                found[type_] = {**found.get(type_, {}), **self._included(str(name), ())}
        for named, chosen in self._all_sets():
            if named in self._enumerations:
                found.setdefault(self._enumerations[named], self._of_domain(str(chosen.of), ()))
        return {type_: titles for type_, titles in found.items() if titles}

    def _of_domain(self, name: str, around: tuple[str, ...]) -> Mapping[Value, Words]:
        """The titles of the values of an enumeration, or of that which a set is of."""
        sets = {each: str(document.of) for each, document in self._all_sets()}
        return (
            self._of_domain(sets[name], (*around, name))
            if name in sets and name not in around
            else self._included(name, ())
        )

    def _included(self, name: str, around: tuple[str, ...]) -> dict[Value, Words]:
        document = {str(each): one for each, one in self._station.station.enumerations.items()}.get(name)
        if not isinstance(document, documents.EnumerationDocument) or name in around:
            return {}
        found: dict[Value, Words] = {}
        for each in document.includes:
            found |= {**self._included(str(each), (*around, name)), **found}
        return found | {str(value): words_of(text) for value, text in document.titles.items()}

    def _sets(self) -> dict[frozenset[Value], Words]:
        found: dict[frozenset[Value], Words] = {}
        for name, document in self._all_sets():
            if document.title is not None and name in self._enumerations:
                self._check_words(document.title, {})
                found.setdefault(frozenset(self._enumerations[name].values), words_of(document.title))
        return found

    def _all_sets(self) -> Iterator[tuple[str, documents.SetDocument]]:
        """The sets of the station, and those of its resources by their full names."""
        yield from ((str(name), document) for name, document in self._station.station.sets.items())
        for resource, whole in self._station.resources.items():
            yield from ((f"{resource}.{name}", document) for name, document in whole.sets.items())

    def _predicates(self) -> Iterator[tuple[str, Words]]:
        sections = [("", self._station.station.predicates)]
        sections += [(f"{resource}.", whole.predicates) for resource, whole in self._station.resources.items()]
        for prefix, section in sections:
            for name, document in section.items():
                if isinstance(document, documents.PredicateDocument) and document.title is not None:
                    self._check_words(document.title, document.parameters)
                    yield f"{prefix}{name}", words_of(document.title)

    # What is wrong with them

    def _read_values(self, titles: documents.ValueTitles, type_: Type | None, owner: str) -> dict[Value, Words]:
        """The words for values of `type_`, each of which has others in each language."""
        if type_ is None:
            return {}
        found: dict[Value, Words] = {}
        told: dict[tuple[str, str], SourceText] = {}
        for key, value, text in self._by_value(titles, type_, owner):
            found[value] = words_of(text)
            for language, said in by_language(text).items():
                before = told.setdefault((language, said.strip().casefold()), key)
                if before is not key:
                    self._findings.add(said, message("wrong.same-words", words=str(said), other=str(before)))
        return found

    def _read_by_hand(
        self, document: documents.VariableDocument, type_: Type | None, owner: str, is_measured: bool
    ) -> dict[Value, Words]:
        """What a person does so that a variable gets a value; one that is not measured has no value of the station."""
        if document.by_hand and not is_measured:
            self._findings.add(next(iter(document.by_hand)), message("wrong.by-hand", name=owner))
        if type_ is None:
            return {}
        found: dict[Value, Words] = {}
        for _, value, text in self._by_value(document.by_hand, type_, owner):
            self._check_words(text, document.each)
            found[value] = words_of(text)
        return found

    def _by_value(
        self, texts: documents.ValueTitles, type_: Type, owner: str
    ) -> Iterator[tuple[SourceText, Value, fields.Words]]:
        """The texts with their values; what is no value of `type_` is noted."""
        domain = {_written(type_, value): value for value in type_.domain}
        for key, text in texts.items():
            if str(key) in domain:
                yield key, domain[str(key)], text
            else:
                near = suggestion(str(key), domain)
                self._findings.add(
                    key, message("wrong.no-value-of", value=str(key), name=owner, range=str(type_), hint=near)
                )

    def _check_phrase(self, phrase: fields.Words | None) -> None:
        for said in by_language(phrase).values():
            if f"{{{VALUE}}}" not in said:
                self._findings.add(said, message("wrong.phrase", place=f"{{{VALUE}}}"))

    def _check_words(self, text: fields.Words | None, known: Collection[str]) -> None:
        for said in by_language(text).values():
            for match in _IN_BRACES.finditer(said):
                if match[1] not in known:
                    near = suggestion(match[1], map(str, known))
                    self._findings.add(said, message("wrong.no-parameter", text=match[0], hint=near))


def _written(type_: Type, value: Value) -> str:
    return str(value).lower() if type_ == BOOLEAN else str(value)


def _texts_of_parts(station: Station) -> Iterator[tuple[fields.Words | None, Collection[str]]]:
    """The titles of all parts that are there once for each value of their parameters, and the tasks of people."""
    for resource in station.resources.values():
        for ability in resource.abilities.values():
            yield ability.title, ability.parameters
            if ability.human is not None:
                yield ability.human.task, ability.parameters
    for operation in station.operations.values():
        yield operation.title, operation.parameters
    for specification in station.specifications.values():
        yield specification.title, specification.parameters
