"""Whether there is any state that satisfies something, reachable or not: one question to a SAT solver."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import prod

from pysat.solvers import Solver

from sequence_planner.automaton.structure import Automaton, Kind, State, target
from sequence_planner.expressions.syntax import (
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Membership,
    Variable,
    children,
    occurrences,
)
from sequence_planner.expressions.types import Value
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.symbolic import Reading, Symbol

MOST_COMBINATIONS = 100_000  # of the values in one comparison; beyond them a question is not asked
MOST_CONFLICTS = 50_000  # of the solver; beyond them a question is given up


class UndecidedError(Exception):
    """A question was given up: its answer would have taken too long."""


class Question:
    """A circuit over states of which only what is read exists."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._clauses: list[Sequence[int]] = []
        self.circuit = Circuit(self)
        self.reading = Reading(self.circuit)

    def add_clause(self, clause: Sequence[int]) -> None:
        """Take a clause of the circuit."""
        self._clauses.append(clause)

    def state(self) -> AnyState:
        """A state of any values; its flags follow from them."""
        state = AnyState(lambda name: self._flag(name, state) if self._is_flag(name) else self._any(self._type(name)))
        return state

    def with_old_flags(self) -> AnyState:
        """A state of any values whose flags may be anything, as if they were of any other state."""
        return AnyState(lambda name: self._any(self._type(name)))

    def sensed(self, before: AnyState) -> AnyState:
        """What a finish guard sees after `before`: new measured values, and all else as it was."""

        def made(name: str) -> Symbol:
            variable = self._automaton.variables.get(name)
            measured = variable is not None and variable.kind is Kind.MEASURED
            return self._any(self._type(name)) if measured else before[name]

        return AnyState(made)

    def after(self, actions: Sequence[Assignment], before: AnyState) -> AnyState:
        """The state after `actions`, all taken at once in `before`, and after synchronisation."""
        after = AnyState(lambda name: self._flag(name, after) if self._is_flag(name) else before[name])
        for action in actions:
            value = self.reading.symbol(action.value, before)
            if action.condition is not None:
                condition = self.reading.truth(action.condition, before).yes
                value = self.reading.chosen(condition, value, before[target(action)])
            after[target(action)] = value
        return after

    def models(self, *assumed: int) -> Iterator[frozenset[int] | None]:
        """For each literal of `assumed`, the literals that are true in a solution with it, or None.

        Raises `UndecidedError` when that is not known after `MOST_CONFLICTS`.
        """
        with Solver("minisat22", bootstrap_with=self._clauses) as solver:
            for literal in assumed:
                solver.conf_budget(MOST_CONFLICTS)
                answer = solver.solve_limited([literal])
                if answer is None:
                    raise UndecidedError
                yield frozenset(solver.get_model() or ()) if answer else None

    def model(self) -> frozenset[int] | None:
        """The literals that are true in a solution, or None if there is none. Raises `UndecidedError`."""
        return next(self.models(self.circuit.TRUE))

    def _is_flag(self, name: str) -> bool:
        return name in self._automaton.flag_predicates

    def _type(self, name: str) -> Sequence[Value]:
        return self._automaton.types[name].domain

    def _flag(self, name: str, state: AnyState) -> Symbol:
        truth = self.reading.truth(self._automaton.flag_predicates[name], state)
        return Symbol({False: truth.no, True: truth.yes})

    def _any(self, domain: Sequence[Value]) -> Symbol:
        circuit = self.circuit
        if len(domain) == 2:
            literal = circuit.fresh()
            return Symbol({domain[0]: -literal, domain[1]: literal})
        literals = {value: circuit.fresh() for value in domain}
        circuit.require(*literals.values())
        seen = Circuit.FALSE  # one of the values before
        for literal in literals.values():
            circuit.require(-literal, -seen)
            seen = circuit.disjunction((seen, literal))
        return Symbol(literals)


class AnyState(dict[str, Symbol]):
    """The values of a state, each made when it is first read."""

    def __init__(self, made: Callable[[str], Symbol]) -> None:
        super().__init__()
        self._made = made

    def __missing__(self, name: str) -> Symbol:
        self[name] = self._made(name)
        return self[name]

    def valuation(self, model: frozenset[int]) -> State:
        """What has been read of this state, as it is in a solution."""
        return {
            name: next((value for value, literal in symbol.literals.items() if _holds(literal, model)), None)
            for name, symbol in self.items()
        }


def _holds(literal: int, model: frozenset[int]) -> bool:
    return literal in model if literal > 0 else -literal not in model


def satisfying(automaton: Automaton, predicate: Expression) -> State | None:
    """A state, of any values, in which `predicate` holds, or None if there is none. Raises `UndecidedError`."""
    question = Question(automaton)
    state = question.state()
    question.circuit.require(question.reading.truth(predicate, state).yes)
    model = question.model()
    return None if model is None else state.valuation(model)


def differ(automaton: Automaton, one: Expression, other: Expression) -> bool:
    """Whether there is a state, of any values, in which one of two predicates holds and the other does not.

    Raises `UndecidedError`.
    """
    question = Question(automaton)
    state, circuit = question.state(), question.circuit
    first, second = (question.reading.truth(each, state) for each in (one, other))
    either = (first.yes, second.no), (first.no, second.yes)
    circuit.require(circuit.disjunction(tuple(circuit.conjunction(each) for each in either)))
    return question.model() is not None


def can_be_asked(automaton: Automaton, *expressions: Expression) -> bool:
    """Whether `expressions`, and the predicates of the flags that they read, are small enough for a circuit."""
    seen: set[str] = set()
    pending = list(expressions)
    while pending:
        expression = pending.pop()
        match expression:
            case Variable(name) if name in automaton.flag_predicates and name not in seen:
                seen.add(name)
                pending.append(automaton.flag_predicates[name])
            case Comparison(_, Variable(), Constant()):
                continue
            case Comparison() | Arithmetic() | Membership():
                if prod({v.name: len(v.type.domain) for v in occurrences(expression)}.values()) > MOST_COMBINATIONS:
                    return False
            case _:
                pending.extend(children(expression))
    return True


Shape = tuple[object, ...]


def shape(automaton: Automaton, expression: Expression) -> Shape:
    """What makes the answer about `expression`: two with the same shape differ in the names of variables alone."""
    numbers: dict[str, int] = {}

    def of(part: Expression) -> Shape:
        match part:
            case Constant(value):
                return (type(value), value)
            case Variable(name):
                if name in numbers:
                    return (numbers[name],)
                numbers[name] = len(numbers)
                if name in automaton.variables:
                    return (automaton.variables[name].kind, part.type)
                return ("flag", of(automaton.flag_predicates[name]))
            case Comparison(operator) | Arithmetic(operator):
                return (operator, *map(of, children(part)))
            case _:
                return (type(part), *map(of, children(part)))

    return of(expression)
