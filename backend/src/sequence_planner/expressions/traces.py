"""The meaning of formulas: linear temporal logic over finite traces (LTLf).

A trace is a non-empty finite sequence of valuations, and a formula is satisfied at a position of it or not. The
definition is that of De Giacomo and Vardi, *Linear Temporal Logic and Linear Dynamic Logic on Finite Traces*, IJCAI
2013, over the three truth values of `evaluation`: what an unknown value leaves open is None. This is the reference,
written to be compared with the definition; it takes its time.
"""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.expressions.evaluation import Valuation, evaluate, greatest, least
from sequence_planner.expressions.syntax import (
    And,
    BinaryTemporal,
    Expression,
    Implies,
    Not,
    Or,
    UnaryTemporal,
)


def satisfies(formula: Expression, trace: Sequence[Valuation], position: int = 0) -> bool | None:
    """Whether a resolved `formula` is satisfied at `position` of `trace`, or None where unknown values leave it open.

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
            return _prefixed(operator, operand, trace, position)
        case BinaryTemporal("U", left, right):
            return _until(left, right, trace, position)
        case BinaryTemporal("R", left, right):
            return _negated(_until(Not(left), Not(right), trace, position))
        case BinaryTemporal(_, left, right):
            for_ever = _prefixed("G", left, trace, position)
            return greatest((_until(left, right, trace, position), for_ever))
        case _:
            truth = evaluate(formula, trace[position])
            return None if truth is None else bool(truth)


def _prefixed(operator: str, operand: Expression, trace: Sequence[Valuation], position: int) -> bool | None:
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
