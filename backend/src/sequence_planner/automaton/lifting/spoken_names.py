"""What variables and values are called in sentences: by the titles of the model, or else by their names in words."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.automaton.lifting.normal_form import ValueLiteral
from sequence_planner.language.shorthand.titles import VALUE_IN_PHRASE, VariableTitles, in_language
from sequence_planner.language.types import BooleanType, EnumerationType, IntegerRange, Type, Value
from sequence_planner.texts.grammar import ENGLISH, GRAMMARS, Clause, Grammar
from sequence_planner.texts.message import Title
from sequence_planner.texts.names import in_words, within_sentence

_ARGUMENTS = re.compile(r"[\[(]([^\])]*)[\])]")
_NO_TITLES = VariableTitles()
_VALUE = f"{{{VALUE_IN_PHRASE}}}"

Called = Iterable[tuple[str, Type | None, str]]
"""Parameters, each with its type and its value."""


def title_in(title: str, language: str) -> str:
    """The title of a part as it is in a language."""
    return in_language(title.words, language) or title if isinstance(title, Title) else title


class SpokenNames:
    """What the variables and values of `automaton` are called."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._titles = automaton.titles
        self._words: dict[tuple[Type, str, str], Mapping[Value, str]] = {}

    def titles(self, name: str) -> VariableTitles:
        """What is written of a variable."""
        return self._titles.variables.get(without_arguments(name), _NO_TITLES)

    def is_titled(self, name: str) -> bool:
        """Return whether the model says what a variable is called."""
        titles = self.titles(name)
        return bool(titles.title or titles.phrase)

    # Statements

    def statement(self, literal: ValueLiteral, grammar: Grammar) -> Clause:
        """Say that a variable has one of some values."""
        if isinstance(literal.type, BooleanType):
            return self._truth(literal.variable, literal.type, True in literal.values, grammar)
        if isinstance(literal.type, IntegerRange):
            said = self._number(literal, grammar)
            if said is not None:
                return self._phrased(literal.variable, said, grammar)
        words = self.words(literal.variable, literal.type, grammar)
        held = [value for value in literal.type.domain if value in literal.values]
        others = [value for value in literal.type.domain if value not in literal.values]
        if len(others) < len(held) and self._set_title(held, grammar) is None:
            rest = self._one_of(others, words, grammar)
            if (denied := grammar.denied(self._phrased(literal.variable, rest, grammar))) is not None:
                return denied
        return self._phrased(literal.variable, self._one_of(held, words, grammar), grammar)

    def _one_of(self, values: Sequence[Value], words: Mapping[Value, str], grammar: Grammar) -> str:
        return self._set_title(values, grammar) or grammar.one([words[value] for value in values])

    def _set_title(self, values: Sequence[Value], grammar: Grammar) -> str | None:
        """What several values are called together."""
        title = self._titles.sets.get(frozenset(values)) if len(values) > 1 else None
        said = None if title is None else in_language(title, grammar.language)
        return None if said is None else within_sentence(said)

    def _number(self, literal: ValueLiteral, grammar: Grammar) -> str | None:
        """What is said of several numbers that follow each other; None of others, and of a single one."""
        first, last = min(literal.values), max(literal.values)
        assert isinstance(first, int)
        assert isinstance(last, int)
        if last - first + 1 != len(literal.values) or first == last or self.titles(literal.variable).values:
            return None
        domain = literal.type.domain
        if first == domain[0]:
            return f"{grammar.words['<=']} {last}"
        if last == domain[-1]:
            return f"{grammar.words['>=']} {first}"
        return grammar.words["range"].format(first=first, last=last)

    def _truth(self, name: str, type_: Type, value: bool, grammar: Grammar) -> Clause:
        own = self.titles(name).values
        said = {each: in_language(own[each], grammar.language) for each in (False, True) if each in own}
        if (text := said.get(value)) is not None and text != said.get(not value):
            return self._phrased(name, text, grammar)
        if (text := said.get(not value)) is not None and text != said.get(value):
            denied = grammar.denied(self._phrased(name, text, grammar))
            return denied or self._phrased(name, grammar.holds[value], grammar)
        if self.titles(name).phrase:
            return self._phrased(name, grammar.holds[value], grammar)
        subject = self.subject(name, grammar)
        clause = grammar.clause(subject)
        if (contrary := grammar.denied(clause)) is not None:
            return clause if value else contrary
        return Clause(grammar.quoted.format(title=subject), grammar.be, grammar.holds[value])

    def _phrased(self, name: str, value: str, grammar: Grammar) -> Clause:
        phrase = in_language(self.titles(name).phrase, grammar.language)
        if phrase is None or _VALUE not in phrase:
            return Clause(self.subject(name, grammar), grammar.be, value)
        filled = within_sentence(self.filled(phrase, self._called(name), grammar))
        clause = grammar.clause(filled, _VALUE)
        return Clause(clause.subject.replace(_VALUE, value), clause.verb, clause.tail.replace(_VALUE, value))

    # Values

    def words(self, name: str, type_: Type, grammar: Grammar) -> Mapping[Value, str]:
        """What the values of a variable are called, each otherwise than all others."""
        family = without_arguments(name) if self.titles(name).values else ""
        key = (type_, family, grammar.language)
        if (known := self._words.get(key)) is None:
            known = self._words[key] = self._distinct(self.titles(name), type_, grammar)
        return known

    def _distinct(self, titles: VariableTitles, type_: Type, grammar: Grammar) -> Mapping[Value, str]:
        said: dict[Value, str] = {}
        for value in type_.domain:
            written = titles.values.get(value) or self._titles.of_value(type_, value)
            said[value] = in_language(written, grammar.language) or self.word(value, grammar)
        for otherwise in (lambda value: self.word(value, grammar), str):
            counts = Counter(each.casefold() for each in said.values())
            said = {value: text if counts[text.casefold()] == 1 else otherwise(value) for value, text in said.items()}
        unique = len({each.casefold() for each in said.values()}) == len(said)
        return said if unique else {value: str(value) for value in said}

    def word(self, value: Value, grammar: Grammar) -> str:
        """What a value is called that has no title."""
        if isinstance(value, bool):
            return grammar.holds[value]
        return in_words(value) if isinstance(value, str) else str(value)

    # Variables

    def subject(self, name: str, grammar: Grammar) -> str:
        """What a variable is called within a sentence."""
        title = in_language(self.titles(name).title, grammar.language)
        if title is not None:
            called = list(self._called(name))
            told = self.filled(title, called, grammar)
            if called and told == title:
                told = f"{title} {self._arguments(called, grammar)}"
            return within_sentence(told)
        if name in self._automaton.variables or name not in self._automaton.types:
            return self._untitled(name, grammar)
        ability, _, flag = name.rpartition(".")
        title = grammar.quoted.format(title=title_in(self._automaton.abilities[ability].title, grammar.language))
        return f"{title} {grammar.be} {grammar.words[flag]}"

    def heading(self, variable: str, grammar: Grammar) -> str:
        """What a variable is called in a table, below the title of its resource: `Ladder frame`, `Target pose`."""
        told = self.subject(variable, grammar) if self.is_titled(variable) else self._short(variable, 1, grammar)
        bare = grammar.bare(told)
        return bare[:1].upper() + bare[1:]

    def entries(self, variable: str, grammar: Grammar) -> Mapping[Value, str]:
        """What the values of a variable are called in a table, each otherwise than all others; only those of which the
        model has words.
        """
        type_ = self._automaton.types[variable]
        if not isinstance(type_, EnumerationType) and not self.titles(variable).values:
            return {}
        words = self.words(variable, type_, grammar)
        bare = {value: grammar.bare(text) for value, text in words.items()}
        return bare if len({each.casefold() for each in bare.values()}) == len(bare) else words

    def headings(self, variable: str) -> dict[str, str]:
        """What a variable is called at the head of a row, by language."""
        return {grammar.language: self.heading(variable, grammar) for grammar in GRAMMARS}

    def all_entries(self, variable: str) -> dict[Value, dict[str, str]]:
        """What the values of a variable are called in a table, each by language."""
        entries = {grammar.language: self.entries(variable, grammar) for grammar in GRAMMARS}
        return {value: {name: each[value] for name, each in entries.items()} for value in entries[ENGLISH.language]}

    def by_hand(self, variable: str, value: Value, grammar: Grammar) -> str | None:
        """What a person does so that a variable gets a value, where the model says so."""
        said = in_language(self.titles(variable).by_hand.get(value, {}), grammar.language)
        return None if said is None else self.filled(said, self._called(variable), grammar)

    def spoken_title(self, variable: str, grammar: Grammar) -> str:
        """What a variable is called that is told apart from its value: a statement in quotes."""
        subject = self.subject(variable, grammar)
        is_statement = isinstance(self._automaton.types[variable], BooleanType) and bool(grammar.clause(subject).verb)
        return grammar.quoted.format(title=subject) if is_statement else subject

    def filled(self, text: str, called: Called, grammar: Grammar) -> str:
        """A text with what the values of its parameters are called in their places."""
        for word, type_, value in called:
            text = text.replace(f"{{{word}}}", self._argument(type_, value, grammar))
        return text

    def _argument(self, type_: Type | None, value: str, grammar: Grammar) -> str:
        return in_language(self._titles.of_value(type_, value), grammar.language) or in_words(value)

    def _arguments(self, called: Called, grammar: Grammar) -> str:
        return ", ".join(self._argument(type_, value, grammar) for _, type_, value in called)

    def _called(self, name: str) -> Called:
        """The indices of a variable."""
        indices = self._automaton.indices.get(without_arguments(name), {})
        written = _ARGUMENTS.search(name)
        values = written[1].split(", ") if written is not None else []
        domains = self._automaton.vocabulary.domains
        return [(word, domains.get(of), value) for (word, of), value in zip(indices.items(), values, strict=False)]

    def _untitled(self, name: str, grammar: Grammar) -> str:
        if (operation := self._activities.get(name)) is not None:
            title = grammar.quoted.format(title=title_in(self._automaton.operations[operation].title, grammar.language))
            return f"{title} {grammar.be} {grammar.words['active']}"
        return self._short(name, self._levels.get(without_arguments(name), 2), grammar)

    def _short(self, name: str, level: int, grammar: Grammar) -> str:
        """A name in words: of an array the index alone, or with that of the array, or with its resource as well."""
        variable = self._automaton.variables.get(name)
        resource = None if variable is None else variable.resource
        own = in_words((name if resource is None else name.removeprefix(f"{resource}.")).partition("[")[0])
        arguments = self._arguments(self._called(name), grammar) or (
            in_words(written[1]) if (written := _ARGUMENTS.search(name)) else ""
        )
        if arguments and level == 0 and not (variable is not None and isinstance(variable.type, BooleanType)):
            return arguments
        told = f"{own} {arguments}".strip()
        if level < 2 or resource is None:
            return told
        title = within_sentence(title_in(self._automaton.resources.get(resource, resource), grammar.language))
        return grammar.of.format(part=told, whole=title)

    @cached_property
    def _activities(self) -> Mapping[str, str]:
        """The operations by the variables that say whether they are active."""
        activities = {each.activity: each.name for each in self._automaton.operations.values()}
        return {name: activities[name] for name in self._automaton.names(Kind.ACTIVITY) if name in activities}

    @cached_property
    def _levels(self) -> Mapping[str, int]:
        """How much of its name a variable without a title needs to be told from all others: see `_short`."""
        families: dict[str, list[str]] = {}
        for name in self._automaton.variables:
            families.setdefault(without_arguments(name), []).append(name)
        found: dict[str, int] = {}
        for level in (0, 1):
            told = {family: {self._short(name, level, ENGLISH) for name in names} for family, names in families.items()}
            counts = Counter(text for texts in told.values() for text in texts)
            for family, texts in told.items():
                if all(counts[text] == 1 for text in texts) and len(texts) == len(families[family]):
                    found.setdefault(family, level)
        return found
