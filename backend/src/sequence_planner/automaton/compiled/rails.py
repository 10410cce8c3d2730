"""Expressions as Python source over a dictionary `s`, in dual-rail form.

Three truth values take two Python expressions, each plainly true or false: one for *certainly true*, the other for
*certainly false*. Unknown is neither. So the connectives of Kleene become those of Python, `and` on one rail and `or`
on the other, negation swaps the rails, and only the leaves ever look for None.
"""

from __future__ import annotations

from typing import NamedTuple

from sequence_planner.expressions.syntax import (
    And,
    Arithmetic,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    occurrences,
)
from sequence_planner.expressions.types import Value

DEEPEST = 40  # of nested operators: Python nests at most 200 brackets, and an operator opens up to two
LONGEST = 20_000  # characters: an equality of two predicates repeats both of them


class TooComplex(Exception):
    """Python would not compile this, or only after very long."""


class Rails(NamedTuple):
    """Sources that are true when a predicate is certainly true, and when it is certainly false."""

    true: str
    false: str


def predicate_rails(expression: Expression, depth: int = 0) -> Rails:
    """The rails of a resolved predicate. Raises `TooComplex`; TypeError for what is no predicate over one state."""
    match expression:
        case Constant(value):
            return Rails(str(value is True), str(value is False))
        case Variable():
            name = _read(expression)
            return Rails(name, f"{name} is False")
        case Not(operand):
            true, false = _operand(operand, depth)
            return Rails(false, true)
        case And(operands):
            parts = [_operand(operand, depth) for operand in operands]
            return Rails(_joined("and", *(part.true for part in parts)), _joined("or", *(part.false for part in parts)))
        case Or(operands):
            parts = [_operand(operand, depth) for operand in operands]
            return Rails(_joined("or", *(part.true for part in parts)), _joined("and", *(part.false for part in parts)))
        case Implies(left, right):
            premise, conclusion = _operand(left, depth), _operand(right, depth)
            return Rails(_joined("or", premise.false, conclusion.true), _joined("and", premise.true, conclusion.false))
        case Comparison(relation, left, right):
            return _comparison(relation, left, right, depth)
        case Membership(left, options):
            return _membership(left, options, depth)
        case _:
            raise TypeError(f"no predicate over one state: {expression}")


def truth(expression: Expression) -> str:
    """The source of a predicate's truth value: True, False or None. Raises `TooComplex`."""
    true, false = predicate_rails(expression)
    return f"True if {true} else False if {false} else None"


def value(expression: Expression) -> str:
    """The source of an expression's value, None where it is unknown. Raises `TooComplex`."""
    if isinstance(expression, Constant | Variable):
        return _number(expression, 0)
    if isinstance(expression, Arithmetic):
        return f"{_number(expression, 0)} if {_known(expression)} else None"
    return truth(expression)


def _operand(expression: Expression, depth: int) -> Rails:
    if depth >= DEEPEST:
        raise TooComplex
    return predicate_rails(expression, depth + 1)


def _comparison(relation: str, left: Expression, right: Expression, depth: int) -> Rails:
    if _is_compound(left) or _is_compound(right):
        one, other = _operand(left, depth), _operand(right, depth)
        same = _joined("or", _joined("and", one.true, other.true), _joined("and", one.false, other.false))
        differ = _joined("or", _joined("and", one.true, other.false), _joined("and", one.false, other.true))
        return Rails(same, differ) if relation == "==" else Rails(differ, same)
    if isinstance(left, Constant):
        left, right, relation = right, left, _MIRRORED[relation]
    if relation in ("==", "!=") and isinstance(left, Variable) and isinstance(right, Constant):
        return _equality(left, right.value, relation)
    known, a, b = _known(left, right), _number(left, depth), _number(right, depth)
    return Rails(_joined("and", known, f"{a} {relation} {b}"), _joined("and", known, f"{a} {_OPPOSITE[relation]} {b}"))


_MIRRORED = {"==": "==", "!=": "!=", "<": ">", "<=": ">=", ">": "<", ">=": "<="}
_OPPOSITE = {"==": "!=", "!=": "==", "<": ">=", "<=": ">", ">": "<=", ">=": "<"}


def _equality(variable: Variable, constant: Value, relation: str) -> Rails:
    """The most frequent of all predicates, by one look at the variable on either rail."""
    name, literal = _read(variable), _literal(constant)
    same, differ = f"{name} == {literal}", f"{name} not in (None, {literal})"
    return Rails(same, differ) if relation == "==" else Rails(differ, same)


def _membership(left: Expression, options: tuple[Expression, ...], depth: int) -> Rails:
    constants = [_literal(option.value) for option in options if isinstance(option, Constant)]
    if isinstance(left, Variable) and constants and len(constants) == len(options):
        listed = ", ".join(constants)
        return Rails(f"{_read(left)} in ({listed},)", f"{_read(left)} not in (None, {listed})")
    if not options:
        return Rails("False", f"({value(left)}) is not None")
    parts = [_comparison("==", left, option, depth) for option in options]
    return Rails(_joined("or", *(part.true for part in parts)), _joined("and", *(part.false for part in parts)))


def _number(expression: Expression, depth: int) -> str:
    """The value of what is no compound predicate, given that its variables are known."""
    match expression:
        case Constant(constant):
            return _literal(constant)
        case Variable():
            return _read(expression)
        case Arithmetic(sign, left, right):
            if depth >= DEEPEST:
                raise TooComplex
            return f"({_number(left, depth + 1)} {sign} {_number(right, depth + 1)})"
        case _:
            raise TypeError(f"no value over one state: {expression}")


def _known(*expressions: Expression) -> str:
    names = dict.fromkeys(_read(variable) for expression in expressions for variable in occurrences(expression))
    return _joined("and", *(f"{name} is not None" for name in names))


def _is_compound(expression: Expression) -> bool:
    return not isinstance(expression, Constant | Variable | Arithmetic)


def _joined(connective: str, *parts: str) -> str:
    """`parts` as one operand; without any, they all hold."""
    if sum(map(len, parts)) > LONGEST:
        raise TooComplex
    if len(parts) < 2:
        return parts[0] if parts else "True"
    return f"({f' {connective} '.join(parts)})"


def _read(variable: Variable) -> str:
    return f"s[{_literal(variable.name)}]"


def _literal(constant: Value) -> str:
    return repr(str(constant)) if isinstance(constant, str) else repr(constant)
