"""The interpreter of ticks that one would write first: predicates as closures, and all of them evaluated in every tick.

It goes about it decently: one dictionary changed in place, no syntax tree looked at after the start, conjunctions and
disjunctions that stop at what decides them, comparisons with a constant as one closure, and every name one string.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from sys import intern
from typing import Any

from sequence_planner.automaton.automaton import Automaton, target
from sequence_planner.language.evaluator import RELATIONS
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
)
from sequence_planner.language.types import Value

Values = dict[str, Any]
Closure = Callable[[Values], Any]


class ClosureRun:
    """A run that evaluates everything in every tick."""

    def __init__(self, automaton: Automaton) -> None:
        abilities, operations = automaton.abilities.values(), automaton.operations.values()
        self.state: Values = {intern(name): value for name, value in automaton.initial_valuation.items()}
        self._flags = [(intern(flag.name), closure(flag.predicate)) for flag in automaton.flags]
        self._finishes = [
            (a.name, closure(a.finish_guard), _actions(a.finish_actions))
            for a in abilities
            if a.finish_guard is not None
        ]
        self._operations = [(o.name, closure(o.goal), closure(o.precondition)) for o in operations]
        self._starts = {
            a.name: (intern(a.flag("enabled")), closure(a.enabled), closure(a.start_guard), _actions(a.start_actions))
            for a in abilities
        }
        self.active: set[str] = set()

    def sense(self, measured: Mapping[str, Value | None]) -> None:
        """Step 1."""
        self.state.update(measured)

    def finish(self) -> list[str]:
        """Step 2: who finished."""
        state = self.state
        taken = [(name, _written(actions, state)) for name, guard, actions in self._finishes if guard(state) is True]
        together: Values = {}
        for _, written in taken:
            for name, value in (written or {}).items():
                if together.setdefault(name, value) != value:
                    raise ValueError(f"two finishes differ about {name}")  # which the stations measured here never do
        state.update(together)
        return [name for name, written in taken if written is not None]

    def synchronise(self) -> None:
        """Step 3."""
        state = self.state
        for name, predicate in self._flags:
            truth = predicate(state)
            if truth is not None:
                state[name] = truth

    def update_operations(self) -> None:
        """Step 4, on `active`."""
        state, active = self.state, self.active
        for name, goal, precondition in self._operations:
            reached = goal(state)
            if reached is True:
                active.discard(name)
            elif reached is False and precondition(state) is True:
                active.add(name)

    def may_start(self, name: str) -> bool:
        """Whether `enabled` and the written start guard hold."""
        state = self.state
        flag, enabled, guard, _ = self._starts[name]
        return state[flag] is True and enabled(state) is True and guard(state) is True

    def start(self, name: str) -> None:
        """Step 5, one start."""
        written = _written(self._starts[name][-1], self.state)
        if written is not None:
            self.state.update(written)
            self.synchronise()


def _actions(actions: Sequence[Assignment]) -> list[tuple[str, Closure | None, Closure]]:
    return [
        (intern(target(a)), None if a.condition is None else closure(a.condition), closure(a.value)) for a in actions
    ]


def _written(actions: Sequence[tuple[str, Closure | None, Closure]], state: Values) -> Values | None:
    written: Values = {}
    for name, condition, evaluated in actions:
        applies = True if condition is None else condition(state)
        if applies is None:
            return None
        if applies:
            value = evaluated(state)
            if value is None:
                return None
            written[name] = value
    return written


def closure(expression: Expression) -> Closure:
    """The value of `expression` over three truth values, as a function of the state."""
    match expression:
        case Constant(value):
            return lambda state: value
        case Variable(name):
            key = intern(name)
            return lambda state: state[key]
        case Not(operand):
            inner = closure(operand)
            return lambda state: None if (truth := inner(state)) is None else not truth
        case And(operands):
            return _deciding(False, [closure(each) for each in operands])
        case Or(operands):
            return _deciding(True, [closure(each) for each in operands])
        case Implies(left, right):
            return _deciding(True, [closure(Not(left)), closure(right)])
        case Comparison(relation, Variable(name), Constant(value)):
            return _compared(intern(name), RELATIONS[relation], value)
        case Comparison(relation, left, right):
            return _of_two(RELATIONS[relation], closure(left), closure(right))
        case Arithmetic(sign, left, right):
            return _of_two(int.__add__ if sign == "+" else int.__sub__, closure(left), closure(right))
        case Membership(left, options):
            return _deciding(True, [closure(Comparison("==", left, each)) for each in options])
        case _:
            raise TypeError(f"no predicate over one state: {expression}")


def _deciding(decisive: bool, parts: Sequence[Closure]) -> Closure:
    def truth(state: Values) -> bool | None:
        unknown = False
        for part in parts:
            value: bool | None = part(state)
            if value is decisive:
                return decisive
            if value is None:
                unknown = True
        return None if unknown else not decisive

    return truth


def _compared(name: str, relation: Callable[[Any, Any], bool], constant: Value) -> Closure:
    return lambda state: None if (value := state[name]) is None else relation(value, constant)


def _of_two(function: Callable[[Any, Any], Any], left: Closure, right: Closure) -> Closure:
    def value(state: Values) -> Any:  # noqa: ANN401 - a truth value or a number
        a = left(state)
        b = right(state)
        return None if a is None or b is None else function(a, b)

    return value
