"""Canonical text of an expression: fewest brackets, one space, and parsing it gives the same tree again."""

from __future__ import annotations

from sequence_planner.expressions.syntax import (
    And,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Name,
    Not,
    Or,
    Variable,
)
from sequence_planner.expressions.types import Value

# Strength of binding; an operand weaker than its place needs brackets.
_IMPLIES, _OR, _AND, _NOT, _RELATION, _SUM, _ATOM = range(7)


def print_value(value: Value) -> str:
    """A value as it is written in the language."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def print_expression(expression: Expression) -> str:
    """The canonical text of `expression`."""
    return _print(expression, _IMPLIES)


def print_assignment(action: Assignment) -> str:
    """The canonical text of an action."""
    condition = f" if {print_expression(action.condition)}" if action.condition is not None else ""
    return f"{print_expression(action.target)} := {print_expression(action.value)}{condition}"


def _print(expression: Expression, place: int) -> str:
    text, strength = _text(expression)
    return f"({text})" if strength < place else text


def _text(expression: Expression) -> tuple[str, int]:
    match expression:
        case Constant(value):
            return print_value(value), _ATOM
        case Name():
            return str(expression), _ATOM
        case Variable(name):
            return name, _ATOM
        case Not(operand):
            return f"not {_print(operand, _NOT)}", _NOT
        case And(operands):
            return " and ".join(_print(part, _NOT) for part in operands), _AND
        case Or(operands):
            return " or ".join(_print(part, _AND) for part in operands), _OR
        case Implies(left, right):
            return f"{_print(left, _OR)} implies {_print(right, _IMPLIES)}", _IMPLIES
        case Comparison(operator, left, right):
            return f"{_print(left, _SUM)} {operator} {_print(right, _SUM)}", _RELATION
        case Membership(left, options):
            return f"{_print(left, _SUM)} in {{{', '.join(_print(o, _SUM) for o in options)}}}", _RELATION
        case Arithmetic(operator, left, right):
            return f"{_print(left, _SUM)} {operator} {_print(right, _ATOM)}", _SUM
