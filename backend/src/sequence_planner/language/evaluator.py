"""Values of expressions over three truth values (Kleene): `None` is *unknown*, and what it decides stays unknown."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping
from typing import Any

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
)
from sequence_planner.language.types import Value

Valuation = Mapping[str, Value | None]

# What each comparison asks of two known values; which values it is asked of, resolution has checked.
RELATIONS: Mapping[str, Callable[[Any, Any], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


def evaluate(expression: Expression, valuation: Valuation) -> Value | None:
    """The value of a resolved expression, or None where unknown variables leave it open.

    Raises KeyError for a variable that `valuation` does not have, TypeError for an unresolved name and for a temporal
    formula, which has a value only over a trace (see `traces`).
    """
    # What is most frequent comes first, and is asked for without patterns, which take several times as long to match.
    # From none of these classes others are derived.
    if type(expression) is And:
        unknown = False
        for part in expression.operands:
            truth = evaluate(part, valuation)
            if truth is False:
                return False
            unknown = unknown or truth is None
        return None if unknown else True
    if type(expression) is Comparison:
        left, right = expression.left, expression.right
        a = valuation[left.name] if type(left) is Variable else evaluate(left, valuation)
        b = right.value if type(right) is Constant else evaluate(right, valuation)
        return None if a is None or b is None else RELATIONS[expression.operator](a, b)
    if type(expression) is Variable:
        return valuation[expression.name]
    if type(expression) is Not:
        truth = evaluate(expression.operand, valuation)
        return None if truth is None else not truth
    if type(expression) is Or:
        unknown = False
        for part in expression.operands:
            truth = evaluate(part, valuation)
            if truth is True:
                return True
            unknown = unknown or truth is None
        return None if unknown else False
    if type(expression) is Constant:
        return expression.value
    return _less_frequent(expression, valuation)


def _less_frequent(expression: Expression, valuation: Valuation) -> Value | None:
    match expression:
        case Implies(left, right):
            premise = evaluate(left, valuation)
            return greatest((None if premise is None else not premise, evaluate(right, valuation)))
        case Membership(left, options):
            a = evaluate(left, valuation)
            if a is None:
                return None
            found = (evaluate(option, valuation) for option in options)
            return greatest(None if b is None else a == b for b in found)
        case Arithmetic(sign, left, right):
            a, b = evaluate(left, valuation), evaluate(right, valuation)
            if a is None or b is None:
                return None
            return int(a) + int(b) if sign == "+" else int(a) - int(b)
        case UnaryTemporal(operator_) | BinaryTemporal(operator_):
            raise TypeError(f"a formula with `{operator_}` has no value in a single state")
    raise TypeError(f"unresolved name {expression}")


def holds(expression: Expression, valuation: Valuation) -> bool:
    """Return whether a predicate is true for certain: what is undetermined does not hold."""
    return evaluate(expression, valuation) is True


def least(truths: Iterable[Value | None]) -> bool | None:
    """Conjunction over three truth values."""
    unknown = False
    for truth in truths:
        if truth is False:
            return False
        unknown = unknown or truth is None
    return None if unknown else True


def greatest(truths: Iterable[Value | None]) -> bool | None:
    """Disjunction over three truth values."""
    unknown = False
    for truth in truths:
        if truth is True:
            return True
        unknown = unknown or truth is None
    return None if unknown else False
