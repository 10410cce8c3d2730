"""Canonical text of an expression: fewest brackets, one space, and parsing it gives the same tree again."""

from __future__ import annotations

from collections.abc import Callable

from sequence_planner.language.lexer import PREFIX_LETTERS
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    Assignment,
    BinaryTemporal,
    Binder,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Name,
    NamedMembership,
    Not,
    Or,
    Quantified,
    RecordConstant,
    Selection,
    UnaryTemporal,
    Variable,
)
from sequence_planner.language.types import Value

# Strength of binding; an operand weaker than its place needs brackets.
_IMPLIES, _OR, _AND, _UNTIL, _NOT, _RELATION, _SUM, _PRODUCT, _ATOM = range(9)


def print_value(value: Value) -> str:
    """A value as it is written in the language."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def print_expression(expression: Expression) -> str:
    """The canonical text of `expression`."""
    return _print(expression, _IMPLIES)


def print_assignment(action: Assignment, said: Callable[[Expression], str] | None = None) -> str:
    """The canonical text of an action; its condition as it is `said`."""
    condition = f" if {(said or print_expression)(action.condition)}" if action.condition is not None else ""
    bound = f"all {_bound(action.binders)}: " if action.binders else ""
    return f"{bound}{print_expression(action.target)} := {print_expression(action.value)}{condition}"


def _bound(binders: tuple[Binder, ...]) -> str:
    domains = (
        each.domain if isinstance(each.domain, Name) else f"{{{', '.join(map(str, each.domain))}}}" for each in binders
    )
    return ", ".join(f"{each.word} in {domain}" for each, domain in zip(binders, domains, strict=True))


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
            return " and ".join(_print(part, _UNTIL) for part in operands), _AND
        case Or(operands):
            return " or ".join(_print(part, _AND) for part in operands), _OR
        case Implies(left, right):
            return f"{_print(left, _OR)} implies {_print(right, _IMPLIES)}", _IMPLIES
        case Comparison(operator, left, right):
            return f"{_print(left, _SUM)} {operator} {_print(right, _SUM)}", _RELATION
        case Membership(left, options):
            return f"{_print(left, _SUM)} in {{{', '.join(_print(o, _SUM) for o in options)}}}", _RELATION
        case NamedMembership(left, domain):
            return f"{_print(left, _SUM)} in {domain}", _RELATION
        case Quantified(quantifier, number, binders, where, body):
            counted = "" if number is None else f" {number}"
            chosen = "" if where is None else f" where {print_expression(where)}"
            return f"{quantifier}{counted} {_bound(binders)}{chosen}: {print_expression(body)}", _IMPLIES
        case Arithmetic(operator, left, right):
            strength = _SUM if operator in ("+", "-") else _PRODUCT
            return f"{_print(left, strength)} {operator} {_print(right, strength + 1)}", strength
        case RecordConstant(value):
            return repr(value) if isinstance(value, float) else "'" + value.replace("'", "''") + "'", _ATOM
        case Selection(whole, at, _, called):
            opening, closing = "()" if called else "[]"
            listed = "" if isinstance(at, str) else ", ".join(_print(each, _SUM) for each in at)
            inside = f".{at}" if isinstance(at, str) else f"{opening}{listed}{closing}"
            return f"{_print(whole, _ATOM)}{inside}", _ATOM
        case UnaryTemporal(operator, operand):
            return f"{operator} {_under_letter(operand)}", _NOT
        case BinaryTemporal(operator, left, right):
            first = f"({_print(left, _IMPLIES)})" if _ends_in_letter(left) else _print(left, _NOT)
            return f"{first} {operator} {_print(right, _UNTIL)}", _UNTIL


def _under_letter(operand: Expression) -> str:
    """The operand of a prefix letter: brackets around relations, and around `-1`, which would make it a sum."""
    text, strength = _text(operand)
    return text if strength == _NOT or (strength == _ATOM and text[0] != "-") else f"({text})"


def _ends_in_letter(expression: Expression) -> bool:
    """Return whether an infix letter behind `expression` would be read as the operand of a letter that is a name."""
    match expression:
        case Not(operand) | UnaryTemporal(_, operand):
            return _ends_in_letter(operand)
        case Name() | Variable():
            return _text(expression)[0] in PREFIX_LETTERS
        case _:
            return False
