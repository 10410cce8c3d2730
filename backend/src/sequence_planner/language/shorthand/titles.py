"""What a model calls its parts when it speaks to people: titles of variables, values, sets and predicates."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.types import EnumerationType, Value

VALUE_IN_PHRASE = "value"  # what stands in braces in a phrase, where the value is said

# A text by language; one that is written in no language in particular is under the empty one.
Words = Mapping[str, str]


def in_language(words: Words, language: str) -> str | None:
    """The text of a language, or what is told in its place; None where there is none at all."""
    for each in (language, "", "en"):
        if each in words:
            return words[each]
    return next(iter(words.values()), None)


class VariableTitles(Immutable):
    """What is written of a variable: its title, the phrase that says its value, words for values of its own, and what a
    person does at the station so that it gets a value.
    """

    title: Mapping[str, str] = {}
    phrase: Mapping[str, str] = {}
    values: Mapping[Value, Words] = {}
    by_hand: Mapping[Value, Words] = {}


class Titles(Immutable):
    """All that is written of a model. Variables are known by their full names, those of an array by its name alone."""

    variables: Mapping[str, VariableTitles] = {}
    values: Mapping[EnumerationType, Mapping[Value, Words]] = {}
    sets: Mapping[frozenset[Value], Words] = {}
    predicates: Mapping[str, Words] = {}

    def of_value(self, type_: object, value: Value) -> Words:
        """The words for a value: those of its enumeration, or else of another that has them."""
        if isinstance(type_, EnumerationType):
            if value in (own := self.values.get(type_, {})):
                return own[value]
            return next((each[value] for each in self.values.values() if value in each), {})
        return {}


NO_TITLES = Titles()
