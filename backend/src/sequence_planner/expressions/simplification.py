"""Smaller expressions of the same meaning: constants folded where parameters have made a predicate partly constant."""

from __future__ import annotations

from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import (
    FALSE,
    TRUE,
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
)


def simplify(expression: Expression) -> Expression:
    """An expression equal to the resolved `expression` in every state, also over unknown values."""
    match expression:
        case Not(operand, span=span):
            return _folded(Not(simplify(operand), span))
        case And(operands, span=span):
            parts = [part for part in map(simplify, operands) if part != TRUE]
            if FALSE in parts:
                return FALSE
            if len(parts) < 2:
                return parts[0] if parts else TRUE
            return And(tuple(parts), span)
        case Or(operands, span=span):
            parts = [part for part in map(simplify, operands) if part != FALSE]
            if TRUE in parts:
                return TRUE
            if len(parts) < 2:
                return parts[0] if parts else FALSE
            return Or(tuple(parts), span)
        case Implies(left, right, span=span):
            premise, conclusion = simplify(left), simplify(right)
            if premise == FALSE or conclusion == TRUE:
                return TRUE
            return conclusion if premise == TRUE else Implies(premise, conclusion, span)
        case Comparison(operator, left, right, span=span):
            return _folded(Comparison(operator, simplify(left), simplify(right), span))
        case Membership(left, options, span=span):
            return _folded(Membership(simplify(left), tuple(map(simplify, options)), span))
        case Arithmetic(operator, left, right, span=span):
            return _folded(Arithmetic(operator, simplify(left), simplify(right), span))
        case _:
            return expression


def simplify_assignment(action: Assignment) -> Assignment:
    """An action with its parts simplified; a condition that always holds is dropped."""
    condition = None if action.condition is None else simplify(action.condition)
    return Assignment(action.target, simplify(action.value), None if condition == TRUE else condition, action.span)


def _folded(expression: Expression) -> Expression:
    """The constant that `expression` is when all its parts are constants, else itself."""
    match expression:
        case Not(Constant()) | Comparison(_, Constant(), Constant()) | Arithmetic(_, Constant(), Constant()):
            constant = True
        case Membership(Constant(), options):
            constant = all(isinstance(option, Constant) for option in options)
        case _:
            constant = False
    value = evaluate(expression, {}) if constant else None
    return expression if value is None else Constant(value, expression.span)
