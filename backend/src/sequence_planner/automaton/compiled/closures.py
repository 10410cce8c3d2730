"""Python functions from expressions without the compiler: made at once, and half as fast as compiled ones."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from operator import itemgetter
from typing import Any

from sequence_planner.automaton.compiled.functions import Evaluation, Function, Predicate, Truth
from sequence_planner.expressions.evaluation import RELATIONS, Valuation, evaluate
from sequence_planner.expressions.syntax import And, Comparison, Constant, Expression, Membership, Not, Or, Variable
from sequence_planner.expressions.types import Value


class Closures:
    """Makes functions as `Compiler` does, for states with any keys."""

    def predicates(self, expressions: Iterable[Expression]) -> list[Predicate]:
        """For each expression, whether it certainly holds."""
        return list(map(closure, expressions))

    def truths(self, expressions: Iterable[Expression]) -> list[Truth]:
        """For each expression its truth: True, False or None."""
        return list(map(closure, expressions))

    def values(self, expressions: Iterable[Expression]) -> list[Evaluation]:
        """For each expression its value, or None while it is unknown."""
        return list(map(closure, expressions))


def closure(expression: Expression) -> Function:
    """The value of a resolved expression as a function of the state, None where it is unknown."""
    match expression:
        case Constant(value):
            return lambda _: value
        case Variable(name):
            return itemgetter(name)
        case Not(operand):
            return partial(_negated, closure(operand))
        case And(operands):
            return partial(_decided, tuple(map(closure, operands)), False)
        case Or(operands):
            return partial(_decided, tuple(map(closure, operands)), True)
        case Comparison("==" | "!=" as relation, Variable(name), Constant(value)):
            return partial(_equal if relation == "==" else _differs, name, value)
        case Membership(Variable(name), options) if all(isinstance(option, Constant) for option in options):
            return partial(_among, name, frozenset(o.value for o in options if isinstance(o, Constant)))
        case Comparison(relation, left, right):
            return partial(_compared, RELATIONS[relation], closure(left), closure(right))
    return partial(evaluate, expression)


def _negated(operand: Function, state: Valuation) -> bool | None:
    truth: bool | None = operand(state)
    return None if truth is None else not truth


def _decided(operands: Sequence[Function], decisive: bool, state: Valuation) -> bool | None:
    """`decisive` if it is the truth of any operand, and else unknown if that of one is."""
    unknown = False
    for operand in operands:
        truth: bool | None = operand(state)
        if truth is decisive:
            return decisive
        if truth is None:
            unknown = True
    return None if unknown else not decisive


def _equal(name: str, value: Value, state: Valuation) -> bool | None:
    found = state[name]
    return None if found is None else found == value


def _differs(name: str, value: Value, state: Valuation) -> bool | None:
    found = state[name]
    return None if found is None else found != value


def _compared(relation: Callable[[Any, Any], bool], left: Function, right: Function, state: Valuation) -> bool | None:
    one, other = left(state), right(state)
    return None if one is None or other is None else bool(relation(one, other))


def _among(name: str, values: frozenset[Value], state: Valuation) -> bool | None:
    found = state[name]
    return None if found is None else found in values
