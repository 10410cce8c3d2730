"""Formulas over runs as deterministic automata.

A state is what remains of the formula: alternatives, each a set of formulas that the rest of the run must satisfy
together. Steps follow the expansion laws of linear temporal logic over finite traces (De Giacomo and Vardi 2013); there
are finitely many states since only parts of the formula can remain. What unknown values leave open counts against
satisfaction, as in `language.ltl.progress` without doubt.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property, lru_cache
from itertools import product

from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import Valuation, evaluate
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    And,
    BinaryTemporal,
    Constant,
    Expression,
    Implies,
    Not,
    Or,
    UnaryTemporal,
    first_temporal,
)

MOST_STATES = 256  # of one automaton; nobody has written a formula that needs more


class TooManyStatesError(Exception):
    """The automaton of a formula would be too large to plan with."""


class Choice(Immutable):
    """A step that goes where a predicate decides: by whether it is certainly true, certainly false, or unknown."""

    predicate: Expression
    true: Decision
    false: Decision
    unknown: Decision


Decision = int | Choice


class Monitor(Immutable):
    """A complete deterministic automaton over the positions of a run; state 0 is the first.

    `steps` has for each state where a position leads that is not the last; `ends` whether a last position satisfies
    what remains: 1 or 0.
    """

    steps: tuple[Decision, ...]
    ends: tuple[Decision, ...]

    def step(self, state: int, position: Valuation) -> int:
        """The state after a `position` that is not the last."""
        return _monitor_decided(self.steps[state], position)

    def satisfied(self, state: int, position: Valuation) -> bool:
        """Return whether what remains in `state` is satisfied by `position` as the last one."""
        return _monitor_decided(self.ends[state], position) == 1

    @cached_property
    def predicates(self) -> tuple[Expression, ...]:
        """All predicates that decide a step or an end."""
        found: dict[Expression, None] = {}
        pending: list[Decision] = [*self.steps, *self.ends]
        while pending:
            match pending.pop():
                case Choice(predicate, true, false, unknown):
                    found[predicate] = None
                    pending += (true, false, unknown)
        return tuple(found)

    @cached_property
    def hopeless(self) -> frozenset[int]:
        """The states from which no last position is reached that satisfies what remains."""
        hopeful = {state for state, end in enumerate(self.ends) if 1 in leaves(end)}
        while True:
            more = {state for state, step in enumerate(self.steps) if not hopeful.isdisjoint(leaves(step))} - hopeful
            if not more:
                return frozenset(range(len(self.steps))) - hopeful
            hopeful |= more


@lru_cache(maxsize=1024)
def monitor_of(formula: Expression) -> Monitor:
    """The automaton of a resolved `formula`, the same in every process. Raises `TooManyStatesError`."""
    parts = _Parts()
    first = _reduced(parts.alternatives(_negation_normal(formula, negated=False)))
    numbers = {first: 0}
    steps: list[Decision] = []
    ends: list[Decision] = []
    for state in (pending := [first]):  # which grows meanwhile
        steps.append(_decision(parts.after(state, last=False), numbers, pending))
        ends.append(_decision(parts.after(state, last=True), {_NEVER: 0, _DONE: 1}, []))
        if len(pending) > MOST_STATES:
            raise TooManyStatesError(
                f"`{print_expression(formula)}` takes more than {MOST_STATES} states: say it with fewer operators"
            )
    return Monitor(tuple(steps), tuple(ends))


def leaves(decision: Decision) -> set[int]:
    """Everywhere a decision may lead."""
    if isinstance(decision, int):
        return {decision}
    return leaves(decision.true) | leaves(decision.false) | leaves(decision.unknown)


# What remains: sorted alternatives, each the sorted numbers of the formulas to be satisfied together.
_Remains = tuple[tuple[int, ...], ...]
_NEVER: _Remains = ()
_DONE: _Remains = ((),)


class _Term(Immutable):
    """One way to satisfy a formula: what must hold now, and what the rest of the run must satisfy."""

    now: tuple[Expression, ...]
    later: frozenset[int]

    def __and__(self, other: _Term) -> _Term:
        return _Term(tuple(dict.fromkeys((*self.now, *other.now))), self.later | other.later)


class _Parts:
    """The parts of one formula, numbered as they come up."""

    def __init__(self) -> None:
        self._numbers: dict[Expression, int] = {}
        self._formulas: list[Expression] = []

    def alternatives(self, formula: Expression) -> list[frozenset[int]]:
        """The sets of formulas of which one must be satisfied, all together."""
        match formula:
            case Constant(value):
                return [frozenset()] if value else []
            case Or(operands) if first_temporal(formula):
                return [each for operand in operands for each in self.alternatives(operand)]
            case And(operands) if first_temporal(formula):
                ways = product(*map(self.alternatives, operands))
                return [frozenset[int]().union(*each) for each in ways]
        number = self._numbers.setdefault(formula, len(self._formulas))
        if number == len(self._formulas):
            self._formulas.append(formula)
        return [frozenset({number})]

    def after(self, remains: _Remains, last: bool) -> list[_Term]:
        """The ways in which a position, and the run behind it, satisfy what remains."""
        found: list[_Term] = []
        for alternative in remains:
            found += _both(*(self._expanded(self._formulas[number], last) for number in alternative))
        return found

    def _expanded(self, formula: Expression, last: bool) -> list[_Term]:
        """The ways to satisfy a formula in negation normal form."""

        def part(operand: Expression) -> list[_Term]:
            return self._expanded(operand, last)

        def later(rest: Expression, without: bool) -> list[_Term]:
            """By a run that goes on and satisfies `rest`, or, with `without`, by one that does not go on."""
            if last:
                return [_Term((), frozenset())] if without else []
            return [_Term((), each) for each in self.alternatives(rest)]

        match formula:
            case And(operands) if first_temporal(formula):
                return _both(*map(part, operands))
            case Or(operands) if first_temporal(formula):
                return [term for operand in operands for term in part(operand)]
            case UnaryTemporal("X" | "N" as operator, operand):
                return later(operand, without=operator == "N")
            case UnaryTemporal("F", operand):
                return [*part(operand), *later(formula, without=False)]
            case UnaryTemporal(_, operand):
                return _both(part(operand), later(formula, without=True))
            case BinaryTemporal("R", left, right):
                return _both(part(right), [*part(left), *later(formula, without=True)])
            case BinaryTemporal(operator, left, right):
                return [*part(right), *_both(part(left), later(formula, without=operator == "W"))]
            case Constant(value):
                return [_Term((), frozenset())] if value else []
            case _:
                return [_Term((formula,), frozenset())]


def _both(*parts: list[_Term]) -> list[_Term]:
    """The ways to satisfy all of `parts`."""
    found: list[_Term] = []
    for terms in product(*parts):
        term = _Term((), frozenset())
        for each in terms:
            term = term & each
        found.append(term)
    return found


def _reduced(alternatives: Iterable[frozenset[int]]) -> _Remains:
    """Without alternatives that demand more than another."""
    different = sorted(set(alternatives), key=lambda each: (len(each), sorted(each)))
    kept: list[frozenset[int]] = []
    for each in different:
        if not any(other <= each for other in kept):
            kept.append(each)
    return tuple(sorted(tuple(sorted(each)) for each in kept))


def _decision(terms: list[_Term], numbers: dict[_Remains, int], pending: list[_Remains]) -> Decision:
    """Decides what must hold now, one predicate after the other; new remains are numbered and become `pending`."""
    first = next((literal for term in terms for literal in term.now), None)
    if first is None:
        remains = _reduced(term.later for term in terms)
        if remains not in numbers:
            numbers[remains] = len(numbers)
            pending.append(remains)
        return numbers[remains]
    predicate = first.operand if isinstance(first, Not) else first
    true, false, unknown = (
        _decision(_given(terms, predicate, truth), numbers, pending) for truth in (True, False, None)
    )
    return true if true == false == unknown else Choice(predicate, true, false, unknown)


def _given(terms: list[_Term], predicate: Expression, truth: bool | None) -> list[_Term]:
    """The ways that are left when the predicate has that truth value."""
    known = {predicate: truth is True, Not(predicate): truth is False}
    return [
        _Term(tuple(literal for literal in term.now if literal not in known), term.later)
        for term in terms
        if all(known.get(literal, True) for literal in term.now)
    ]


def _negation_normal(formula: Expression, negated: bool) -> Expression:
    """The formula, or its negation, with negations before predicates only; implications are resolved."""

    def same(operand: Expression) -> Expression:
        return _negation_normal(operand, negated)

    def opposed(operand: Expression) -> Expression:
        return _negation_normal(operand, not negated)

    match formula:
        case Constant(value):
            return Constant(bool(value) != negated)
        case Not(operand):
            return opposed(operand)
        case _ if first_temporal(formula) is None:
            return Not(formula) if negated else formula
        case And(operands) | Or(operands):
            return (Or if isinstance(formula, And) == negated else And)(tuple(map(same, operands)))
        case Implies(left, right):
            return (And if negated else Or)((opposed(left), same(right)))
        case UnaryTemporal(operator, operand):
            return UnaryTemporal(_DUAL[operator] if negated else operator, same(operand))
        case BinaryTemporal("W", left, right) if negated:
            return BinaryTemporal("U", same(right), And((same(left), same(right))))
        case BinaryTemporal(operator, left, right):
            return BinaryTemporal(_DUAL[operator] if negated else operator, same(left), same(right))
        case _:
            raise TypeError(f"no formula: {formula}")


_DUAL = {"X": "N", "N": "X", "F": "G", "G": "F", "U": "R", "R": "U", "W": "W"}


def _monitor_decided(decision: Decision, position: Valuation) -> int:
    while isinstance(decision, Choice):
        truth = evaluate(decision.predicate, position)
        decision = decision.unknown if truth is None else decision.true if truth else decision.false
    return decision
