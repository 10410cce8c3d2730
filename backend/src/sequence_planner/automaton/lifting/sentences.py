"""Ground conditions as sentences for people, in each language that people read: `pairs 1 to 3 are tight`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton, Operation
from sequence_planner.automaton.lifting.normal_form import (
    ALWAYS,
    NEVER,
    Junction,
    NormalForm,
    ValueLiteral,
    junction,
    negated,
    normal_form,
)
from sequence_planner.automaton.lifting.spoken_names import SpokenNames
from sequence_planner.automaton.lifting.wording import Same, untrue, wording_of
from sequence_planner.language.evaluator import Valuation, evaluate
from sequence_planner.language.printer import print_expression, print_value
from sequence_planner.language.shorthand.titles import Words, in_language
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    BinaryTemporal,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    UnaryTemporal,
    Variable,
    conjunction,
    conjuncts,
)
from sequence_planner.language.types import EnumerationType, Value
from sequence_planner.texts.grammar import ENGLISH, GRAMMARS, OF_WHAT_IS_SO, Clause, Grammar
from sequence_planner.texts.message import Message, Sentence, Title, Wording, message
from sequence_planner.texts.names import within_sentence

MOST_KNOWN = 2000  # sentences that are kept
# With one of these in it, a statement does not become its contrary by `not` behind its verb: `all pairs are tight`.
_QUANTIFYING = re.compile(
    r"\b(all|every|each|both|any|none?|some|no|and|n?or|n?either|"
    r"all[at]|varje|båda|någo[nt]|några|ing[ae]n?|inget|och|eller)\b",
    re.IGNORECASE,
)

# Between two sentences.
_NEXT = re.compile(r"(?<=[.!?])\s+(?=[A-ZÅÄÖ])")

# What a condition is made of, in the order in which it is written.


class SaidPredicate(NamedTuple):
    """A predicate that has a title, with the values of its parameters; or that it does not hold."""

    words: Words
    parameters: tuple[tuple[str, EnumerationType, str], ...]
    holds: bool
    form: NormalForm


class SaidComparison(NamedTuple):
    """A comparison of what several variables have, or that it does not hold."""

    comparison: Comparison
    holds: bool
    form: NormalForm


class SaidJunction(NamedTuple):
    """That all of some parts hold, or that one does."""

    is_all: bool
    parts: tuple[Part, ...]
    form: NormalForm


class SaidCondition(NamedTuple):
    """That one thing holds if another does."""

    condition: Part
    then: Part
    form: NormalForm


class SaidFormula(NamedTuple):
    """Something about the course of events, or what else there may be, with its `parts`."""

    operator: str
    parts: tuple[Part, ...]
    form: NormalForm


Part = ValueLiteral | SaidPredicate | SaidComparison | SaidJunction | SaidCondition | SaidFormula | Junction
"""A `Junction` is what always holds, or never does."""


def _leading(text: str) -> str:
    """Its first sentence, without the full stop."""
    return _NEXT.split(text, maxsplit=1)[0].removesuffix(".")


def _form(part: Part) -> NormalForm:
    return part if isinstance(part, ValueLiteral | Junction) else part.form


class Sentences:
    """Tells people the conditions of `automaton`."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._names = SpokenNames(automaton)
        self._known: dict[tuple[int, ...], tuple[tuple[Expression, ...], Wording]] = {}
        self._groups: dict[int, tuple[Expression, Sequence[frozenset[int]]]] = {}
        self._titled = dict(self._predicates())
        self._long = sorted(
            ((form, named) for form, named in self._titled.items() if isinstance(form, Junction)),
            key=lambda each: -len(each[0].parts),
        )

    def tell_missing(self, condition: Expression, state: Valuation, written: str) -> Sentence:
        """Say what of a condition does not hold for certain, with what a title puts together with it; all of it where
        nothing is to be told. What is to end is denied as what is so: `no longer`.
        """
        missing = untrue(condition, state)
        ends = bool(missing) and all(evaluate(each, state) is False for each in missing)
        told = [id(each) for each in missing]
        for group in self._spoken_together(condition):
            if not group.isdisjoint(told):
                told += group
        parts = [each for each in conjuncts(condition) if id(each) in told] or [condition]
        return Sentence(self.tell_conditions(*parts, ends=ends).words, written)

    def _spoken_together(self, condition: Expression) -> Sequence[frozenset[int]]:
        """The parts of a condition, by their ids, that predicates with a title put together."""
        known = self._groups.get(id(condition))
        if known is None or known[0] is not condition:
            if len(self._groups) >= MOST_KNOWN:
                self._groups.clear()
            forms = [(normal_form(each), id(each)) for each in conjuncts(condition)] if self._long else []
            every = {form for form, _ in forms}
            wholes = [whole.parts for whole, _ in self._long if whole.is_all and whole.parts <= every]
            groups = [frozenset(each for form, each in forms if form in parts) for parts in wholes]
            known = self._groups[id(condition)] = condition, groups
        return known[1]

    def tell_operation(
        self, operation: Operation, state: Valuation, goal: str, precondition: str, *, active: bool
    ) -> Message | None:
        """Say what is still missing of its goal, or of its precondition; None of one that could become active, and of
        one whose goal holds. These are written as `goal` and `precondition`.
        """
        if active:
            return message("sentence.goal", condition=self.tell_missing(operation.goal, state, goal))
        if evaluate(operation.goal, state) is True or evaluate(operation.precondition, state) is True:
            return None
        return message("sentence.until", conditions=[self.tell_missing(operation.precondition, state, precondition)])

    def tell_so(self, conditions: Iterable[Expression], written: str) -> Sentence:
        """Say that all of some conditions hold, which the model writes so."""
        return Sentence(self.tell_conditions(*conditions).words, written)

    def tell_conditions(self, *conditions: Expression, ends: bool = False) -> Wording:
        """Say that all of some conditions hold; with `ends` none does, and what is denied is so now. What is said of
        the same objects again is known.
        """
        key = (ends, *map(id, conditions))
        known = self._known.get(key)
        if known is None or any(one is not other for one, other in zip(known[0], conditions, strict=True)):
            if len(self._known) >= MOST_KNOWN:
                self._known.clear()
            part = self._read(conjunction(*conditions), True)
            grammars = OF_WHAT_IS_SO if ends else GRAMMARS
            told = Wording({grammar.language: self._told(part, grammar) for grammar in grammars})
            known = self._known[key] = conditions, told
        return known[1]

    def tell_value(self, name: str, value: Value) -> Sentence:
        """Say that a variable has a value."""
        return self.tell_values([(name, value)], self.write_value(name, value))

    def tell_values(self, values: Iterable[tuple[str, Value]], written: str) -> Sentence:
        """Say that variables have values."""
        types = self._automaton.types
        literals = [ValueLiteral(name, types[name], frozenset((value,))) for name, value in values]
        several = SaidJunction(True, tuple(literals), junction(True, literals))
        part = literals[0] if len(literals) == 1 else several
        return Sentence({grammar.language: self._told(part, grammar) for grammar in GRAMMARS}, written)

    def write_value(self, name: str, value: Value) -> str:
        """That a variable has a value in the model's language: `robot.pose == home`, or `not tool_is_idle`."""
        variable: Expression = Variable(name, self._automaton.types[name])
        if isinstance(value, bool):
            return print_expression(variable if value else Not(variable))
        return print_expression(Comparison("==", variable, Constant(value)))

    def call_variable(self, variable: str) -> Sentence:
        """What a variable is called, where its value is said apart from it."""
        return Sentence({each.language: self._names.spoken_title(variable, each) for each in GRAMMARS}, variable)

    def call_value(self, variable: str, value: Value) -> Sentence:
        """What a value of a variable is called, where it is said apart from it."""
        type_ = self._automaton.types[variable]
        words = {each.language: self._names.words(variable, type_, each).get(value, str(value)) for each in GRAMMARS}
        return Sentence(words, print_value(value))

    def call_part(self, name: str, title: str) -> Sentence:
        """What a part of the model is called that is no variable; it is written by its name."""
        return Sentence(title.words if isinstance(title, Title) else {ENGLISH.language: title}, name)

    def tell_by_hand(self, variable: str, value: Value) -> Sentence | None:
        """What a person does so that a variable gets a value, where the model says so."""
        words = {each.language: self._names.by_hand(variable, value, each) for each in GRAMMARS}
        said = {language: text for language, text in words.items() if text is not None}
        return Sentence(said, said[ENGLISH.language]) if ENGLISH.language in said else None

    def call_by_hand(self, variable: str, value: Value) -> Sentence | None:
        """What that is called in short: the first sentence of it, as it stands within another."""
        how = self.tell_by_hand(variable, value)
        if how is None:
            return None
        words = {language: within_sentence(_leading(text)) for language, text in how.words.items()}
        return Sentence(words, f"see to it that {variable} is {print_value(value)}")

    def _predicates(self) -> Iterator[tuple[NormalForm, SaidPredicate]]:
        """The predicates with a title for all values of their parameters, by what they mean."""
        wording, titles = wording_of(self._automaton), self._automaton.titles.predicates
        for predicate in self._automaton.vocabulary.predicates.values():
            if predicate.name not in titles:
                continue
            for form, call in wording.calls_of(predicate):
                if form not in (ALWAYS, NEVER):
                    values = map(str, call.path[-1].arguments)
                    parameters = predicate.parameters.items()
                    called = tuple(
                        (word, type_, value) for (word, type_), value in zip(parameters, values, strict=True)
                    )
                    yield form, SaidPredicate(titles[predicate.name], called, True, form)

    # From a condition to its parts

    def _read(self, condition: Expression, positive: bool) -> Part:
        form = normal_form(condition, positive)
        if form in (ALWAYS, NEVER):
            assert isinstance(form, Junction)
            return form
        if (named := self._named(form)) is not None:
            return named
        match condition:
            case Not(operand):
                return self._read(operand, not positive)
            case And(operands):
                return self._joined([self._read(each, positive) for each in operands], is_all=positive)
            case Or(operands):
                return self._joined([self._read(each, positive) for each in operands], is_all=not positive)
            case Implies(left, right) if positive:
                return SaidCondition(self._read(left, True), self._read(right, True), form)
            case Implies(left, right):
                return self._joined([self._read(left, True), self._read(right, False)], is_all=True)
            case _ if isinstance(form, ValueLiteral):
                return form
            case Membership(left, options):
                equal = [self._read(Comparison("==", left, each), positive) for each in options]
                return self._joined(equal, is_all=not positive)
            case Comparison():
                return SaidComparison(condition, positive, form)
            case UnaryTemporal(operator, operand):
                return self._formula(operator, (operand,), positive, form)
            case BinaryTemporal(operator, left, right):
                return self._formula(operator, (left, right), positive, form)
        raise TypeError(f"{type(condition).__name__} is no part of a resolved condition")

    def _formula(self, operator: str, parts: Sequence[Expression], positive: bool, form: NormalForm) -> SaidFormula:
        said = SaidFormula(operator, tuple(self._read(each, True) for each in parts), form)
        return said if positive else SaidFormula("not", (said,), form)

    def _named(self, form: NormalForm) -> SaidPredicate | None:
        """What a predicate with a title says, or its contrary where that can be said of the title."""
        if (found := self._titled.get(form)) is not None:
            return found
        if isinstance(form, ValueLiteral) and len(form.values) == 1 and isinstance(form.type, EnumerationType):
            return None  # the value says it plainly
        if (found := self._titled.get(negated(form))) is not None and self._can_be_denied(found.words):
            return found._replace(holds=False, form=form)
        return None

    def _can_be_denied(self, words: Words) -> bool:
        """Return whether `not` behind its verb makes a title its contrary."""
        said = [(grammar, in_language(words, grammar.language) or "") for grammar in GRAMMARS]
        return all(grammar.clause(text).verb and not _QUANTIFYING.search(text) for grammar, text in said)

    def _joined(self, parts: Iterable[Part], *, is_all: bool) -> Part:
        """All of some parts, or one of them, with what is said of one variable in one."""
        found: dict[NormalForm, Part] = {}
        literals: dict[str, NormalForm] = {}
        for part in self._flat(parts, is_all=is_all):
            if isinstance(part, ValueLiteral) and (before := literals.get(part.variable)) is not None:
                together = junction(is_all, (before, part))
                assert isinstance(together, ValueLiteral)  # else all of it were always so, or never
                found = {
                    (together if each is before else each): (together if each is before else one)
                    for each, one in found.items()
                }
                literals[part.variable] = together
            else:
                found.setdefault(_form(part), part)
                if isinstance(part, ValueLiteral):
                    literals[part.variable] = part
        found = {form: self._named(form) or part for form, part in found.items()}
        for whole, named in self._long:
            if whole.is_all is is_all and whole.parts <= found.keys():
                first = next(form for form in found if form in whole.parts)
                found = {
                    (whole if form == first else form): (named if form == first else part)
                    for form, part in found.items()
                    if form == first or form not in whole.parts
                }
        if len(found) == 1:
            return next(iter(found.values()))
        return SaidJunction(is_all, tuple(found.values()), junction(is_all, found))

    def _flat(self, parts: Iterable[Part], *, is_all: bool) -> Iterator[Part]:
        for part in parts:
            if isinstance(part, SaidJunction) and part.is_all is is_all:
                yield from part.parts
            elif part != (ALWAYS if is_all else NEVER):
                yield part

    # From the parts to a sentence

    def _told(self, part: Part, grammar: Grammar) -> str:
        if isinstance(part, SaidJunction):
            return self._grouped(part, grammar, is_inside=False)
        return str(self._clause(part, grammar))

    def _clause(self, part: Part, grammar: Grammar) -> Clause:
        match part:
            case ValueLiteral():
                return self._names.statement(part, grammar)
            case SaidPredicate(words, parameters, holds):
                text = self._names.filled(in_language(words, grammar.language) or "", parameters, grammar)
                clause = grammar.clause(within_sentence(text))
                return clause if holds else grammar.denied(clause) or clause
            case SaidComparison(comparison, holds):
                return self._related(comparison, grammar, holds=holds)
            case SaidJunction():
                return Clause(self._grouped(part, grammar, is_inside=True))
            case SaidCondition(condition, then):
                said = grammar.if_.format(then=self._told(then, grammar), condition=self._told(condition, grammar))
                return Clause(said)
            case SaidFormula(operator, parts):
                names = ("formula",) if len(parts) == 1 else ("left", "right")
                told = {name: self._told(each, grammar) for name, each in zip(names, parts, strict=True)}
                return Clause(grammar.words[operator].format(**told))
            case Junction():
                return Clause(grammar.always if part == ALWAYS else grammar.never)

    def _grouped(self, group: SaidJunction, grammar: Grammar, *, is_inside: bool) -> str:
        clauses = grammar.all_together([self._clause(each, grammar) for each in group.parts], is_all=group.is_all)
        texts = list(map(str, clauses))
        last = grammar.conjunction if group.is_all else grammar.disjunction
        has_lists = any(f" {word} " in text for text in texts for word in (grammar.conjunction, grammar.disjunction))
        said = (grammar.apart if has_lists else grammar.listed)(texts, last)
        return f"{grammar.either}{said}" if is_inside and not group.is_all and len(texts) > 1 else said

    def _related(self, comparison: Comparison, grammar: Grammar, *, holds: bool) -> Clause:
        operator = comparison.operator
        if operator == "!=":
            operator, holds = "==", not holds
        left, right = (self._term(each, grammar) for each in (comparison.left, comparison.right))
        clause = Clause(left, grammar.be, f"{grammar.words[operator]} {right}")
        return clause if holds else grammar.denied(clause) or clause

    def _term(self, term: Expression, grammar: Grammar) -> str:
        match term:
            case Variable(name):
                return self._names.spoken_title(name, grammar)
            case Constant(value):
                return self._names.word(value, grammar)
            case Arithmetic(operator, left, right):
                return f"{self._term(left, grammar)} {grammar.words[operator]} {self._term(right, grammar)}"
        return self._told(self._read(term, True), grammar)


def sentences_of(automaton: Automaton) -> Sentences:
    """How the conditions of `automaton` are told, which is found out once for each of the last few."""
    return _sentences_of(Same(automaton))


@lru_cache(maxsize=4)
def _sentences_of(same: Same) -> Sentences:
    return Sentences(same.automaton)
