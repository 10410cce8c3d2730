"""Expressions with parts of them replaced."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sequence_planner.core.immutable import replace
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    Assignment,
    BinaryTemporal,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Span,
    UnaryTemporal,
    Variable,
)

# What stands in place of each variable or flag.
Replacements = Mapping[str, Expression]


def rebuilt(expression: Expression, part: Callable[[Expression], Expression]) -> Expression:
    """The resolved `expression`, or formula, with each of its operands replaced by what `part` makes of it."""
    match expression:
        case Not(operand):
            return Not(part(operand))
        case And(operands):
            return And(tuple(map(part, operands)))
        case Or(operands):
            return Or(tuple(map(part, operands)))
        case Implies(left, right):
            return Implies(part(left), part(right))
        case Comparison(operator, left, right):
            return Comparison(operator, part(left), part(right))
        case Membership(left, options):
            return Membership(part(left), tuple(map(part, options)))
        case Arithmetic(operator, left, right):
            return Arithmetic(operator, part(left), part(right))
        case UnaryTemporal(operator, operand):
            return UnaryTemporal(operator, part(operand))
        case BinaryTemporal(operator, left, right):
            return BinaryTemporal(operator, part(left), part(right))
        case _:
            return expression


def placed_at(expression: Expression, span: Span) -> Expression:
    """The resolved `expression` as if it were written at `span`."""
    if isinstance(expression, Variable):
        return Variable(expression.name, expression.type, span)
    if isinstance(expression, Constant):
        return Constant(expression.value, span)
    return replace(rebuilt(expression, lambda part: placed_at(part, span)), span=span)


def replaced(expression: Expression, replacements: Replacements) -> Expression:
    """The resolved `expression`, or formula, with all variables and flags of `replacements` replaced at once."""

    def part(inner: Expression) -> Expression:
        return replaced(inner, replacements)

    return (
        replacements.get(expression.name, expression) if isinstance(expression, Variable) else rebuilt(expression, part)
    )


def replaced_in_action(action: Assignment, replacements: Replacements) -> Assignment:
    """The same of what a resolved action reads; what it writes stays."""
    condition = None if action.condition is None else replaced(action.condition, replacements)
    return Assignment(action.target, replaced(action.value, replacements), condition)
