"""Formula progression: what remains to be satisfied after a position of a trace that is still going on.

Bacchus and Kabanza, *Using temporal logics to express search control knowledge for planning*, Artificial Intelligence
116 (2000), over finite traces (`traces`). What an unknown value leaves open counts as the caller says, so that one
progression tells what holds for certain and another what may still hold.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain

from sequence_planner.expressions.evaluation import Valuation, evaluate
from sequence_planner.expressions.simplification import simplify
from sequence_planner.expressions.syntax import (
    FALSE,
    TRUE,
    And,
    BinaryTemporal,
    Constant,
    Expression,
    Implies,
    Not,
    Or,
    UnaryTemporal,
)


def progress(formula: Expression, valuation: Valuation, last: bool, doubt: bool = False) -> Expression:
    """What the rest of a trace must satisfy so that the whole, which begins with `valuation`, satisfies `formula`.

    `TRUE` or `FALSE` when that is decided, as it always is at the `last` position. A predicate that unknown values
    leave open counts as `doubt`: with False the whole is satisfied for certain just when the rest is, with True the
    whole is violated for certain just when the rest is.
    """
    match formula:
        case Not(operand):
            return _not(progress(operand, valuation, last, not doubt))
        case And(operands):
            return _all(progress(part, valuation, last, doubt) for part in operands)
        case Or(operands):
            return _any(progress(part, valuation, last, doubt) for part in operands)
        case Implies(left, right):
            premise = progress(left, valuation, last, not doubt)
            return _any((_not(premise), progress(right, valuation, last, doubt)))
        case UnaryTemporal(operator, operand):
            return _prefixed(operator, operand, formula, valuation, last, doubt)
        case BinaryTemporal(operator, left, right):
            here = progress(left, valuation, last, doubt), progress(right, valuation, last, doubt)
            return _infixed(operator, *here, Constant(operator != "U") if last else formula)
        case _:
            truth = evaluate(formula, valuation)
            return Constant(doubt if truth is None else bool(truth))


def _prefixed(
    operator: str, operand: Expression, formula: Expression, valuation: Valuation, last: bool, doubt: bool
) -> Expression:
    if operator in "XN":
        return Constant(operator == "N") if last else simplify(operand)
    here = progress(operand, valuation, last, doubt)
    if last:
        return here
    return _any((here, formula)) if operator == "F" else _all((here, formula))


def _infixed(operator: str, left: Expression, right: Expression, later: Expression) -> Expression:
    """The expansion law of each operator, with what its sides have become, and the formula itself `later`."""
    if operator == "R":
        return _all((right, _any((left, later))))
    return _any((right, _all((left, later))))


def _not(operand: Expression) -> Expression:
    return Constant(not operand.value) if isinstance(operand, Constant) else Not(operand)


# The rest of a long trace is described by parts of the formula: each is kept once, so that it does not grow for ever.


def _all(parts: Iterable[Expression]) -> Expression:
    different = dict.fromkeys(chain.from_iterable(p.operands if isinstance(p, And) else (p,) for p in parts))
    return FALSE if FALSE in different else simplify(And(tuple(different)))


def _any(parts: Iterable[Expression]) -> Expression:
    different = dict.fromkeys(chain.from_iterable(p.operands if isinstance(p, Or) else (p,) for p in parts))
    return TRUE if TRUE in different else simplify(Or(tuple(different)))
