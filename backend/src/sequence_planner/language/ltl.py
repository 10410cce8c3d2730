"""Temporal logic LTLf: semantics over finite traces, and formula progression."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain

from sequence_planner.language.evaluator import Valuation, evaluate, greatest, least
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import (
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

# Formula progression: what remains to be satisfied after a position of a trace that is still going on.
#
# Bacchus and Kabanza, *Using temporal logics to express search control knowledge for planning*, Artificial Intelligence
# 116 (2000), over finite traces (`ltl`). What an unknown value leaves open counts as the caller says, so that one
# progression tells what holds for certain and another what may still hold.


def progress(formula: Expression, valuation: Valuation, last: bool, doubt: bool = False) -> Expression:
    """Return what the rest of a trace must satisfy so that the whole, which begins with `valuation`, satisfies
    `formula`.

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


# The meaning of formulas: linear temporal logic over finite traces (LTLf).
#
# A trace is a non-empty finite sequence of valuations, and a formula is satisfied at a position of it or not. The
# definition is that of De Giacomo and Vardi, *Linear Temporal Logic and Linear Dynamic Logic on Finite Traces*, IJCAI
# 2013, over the three truth values of `evaluator`: what an unknown value leaves open is None. This is the reference,
# written to be compared with the definition; it takes its time.


def satisfies(formula: Expression, trace: Sequence[Valuation], position: int = 0) -> bool | None:
    """Return whether a resolved `formula` is satisfied at `position` of `trace`, or None where unknown values leave it
    open.

    Raises ValueError for a position that the trace does not have; an empty trace has none.
    """
    if not 0 <= position < len(trace):
        raise ValueError(f"the trace has {len(trace)} positions, none of them {position}")

    def at(part: Expression, place: int) -> bool | None:
        return satisfies(part, trace, place)

    match formula:
        case Not(operand):
            return _negated(at(operand, position))
        case And(operands):
            return least(at(part, position) for part in operands)
        case Or(operands):
            return greatest(at(part, position) for part in operands)
        case Implies(left, right):
            return greatest((_negated(at(left, position)), at(right, position)))
        case UnaryTemporal(operator, operand):
            return _prefixed_trace(operator, operand, trace, position)
        case BinaryTemporal("U", left, right):
            return _until(left, right, trace, position)
        case BinaryTemporal("R", left, right):
            return _negated(_until(Not(left), Not(right), trace, position))
        case BinaryTemporal(_, left, right):
            for_ever = _prefixed_trace("G", left, trace, position)
            return greatest((_until(left, right, trace, position), for_ever))
        case _:
            truth = evaluate(formula, trace[position])
            return None if truth is None else bool(truth)


def _prefixed_trace(operator: str, operand: Expression, trace: Sequence[Valuation], position: int) -> bool | None:
    rest = range(position, len(trace))
    has_next = position + 1 < len(trace)
    match operator:
        case "X":
            return satisfies(operand, trace, position + 1) if has_next else False
        case "N":
            return satisfies(operand, trace, position + 1) if has_next else True
        case "F":
            return greatest(satisfies(operand, trace, place) for place in rest)
        case _:
            return least(satisfies(operand, trace, place) for place in rest)


def _until(left: Expression, right: Expression, trace: Sequence[Valuation], position: int) -> bool | None:
    """At some place, now or later, `right` is satisfied, and `left` at each one before."""
    return greatest(
        least((satisfies(right, trace, end), *(satisfies(left, trace, place) for place in range(position, end))))
        for end in range(position, len(trace))
    )


def _negated(truth: bool | None) -> bool | None:
    return None if truth is None else not truth
