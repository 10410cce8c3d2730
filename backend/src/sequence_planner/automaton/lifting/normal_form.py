"""Normal forms of ground conditions: two conditions with one of them are equal in every state.

It is no proof that they differ if theirs do.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    And,
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
from sequence_planner.language.types import Type, Value


class ValueLiteral(NamedTuple):
    """That a variable has one of some values, but not any."""

    variable: str
    type: Type
    values: frozenset[Value]

    @property
    def others(self) -> frozenset[Value]:
        """The values it does not have then."""
        return frozenset(self.type.domain) - self.values


class Opaque(NamedTuple):
    """Something that is compared by its text, or that it does not hold."""

    text: str
    holds: bool


class Junction(NamedTuple):
    """That all of some parts hold, or that one does."""

    is_all: bool
    parts: frozenset[NormalForm]


NormalForm = ValueLiteral | Opaque | Junction

ALWAYS = Junction(True, frozenset())
NEVER = Junction(False, frozenset())


def normal_form(expression: Expression, positive: bool = True) -> NormalForm:
    """The normal form of a resolved condition, or of its negation."""
    match expression:
        case Constant(value):
            return ALWAYS if bool(value) is positive else NEVER
        case Variable(name, type_):
            return ValueLiteral(name, type_, frozenset((positive,)))
        case Not(operand):
            return normal_form(operand, not positive)
        case And(operands):
            return junction(positive, (normal_form(each, positive) for each in operands))
        case Or(operands):
            return junction(not positive, (normal_form(each, positive) for each in operands))
        case Implies(left, right):
            return junction(not positive, (normal_form(left, not positive), normal_form(right, positive)))
        case Comparison() | Membership():
            return _relation(expression, positive)
        case _:
            return Opaque(print_expression(expression), positive)


def negated(form: NormalForm) -> NormalForm:
    """The normal form of the negation."""
    if isinstance(form, Junction):
        return Junction(not form.is_all, frozenset(map(negated, form.parts)))
    if isinstance(form, ValueLiteral):
        return form._replace(values=form.others)
    return form._replace(holds=not form.holds)


def junction(is_all: bool, parts: Iterable[NormalForm]) -> NormalForm:
    """All of `parts`, or one of them; what is said of one variable is put together."""
    neutral, absorbing = (ALWAYS, NEVER) if is_all else (NEVER, ALWAYS)
    literals: dict[str, ValueLiteral] = {}
    found: dict[NormalForm, None] = {}
    pending = list(parts)
    while pending:
        part = pending.pop()
        if part == absorbing:
            return absorbing
        if isinstance(part, ValueLiteral):
            before = literals.get(part.variable)
            literals[part.variable] = part if before is None else _merged(is_all, before, part)
        elif isinstance(part, Junction) and part.is_all is is_all:
            pending += part.parts
        elif part != neutral:
            found[part] = None
    for literal in literals.values():
        if not (literal.values if is_all else literal.others):
            return absorbing
        if literal.others if is_all else literal.values:
            found[literal] = None
    return next(iter(found)) if len(found) == 1 else Junction(is_all, frozenset(found))


def _merged(is_all: bool, one: ValueLiteral, other: ValueLiteral) -> ValueLiteral:
    return one._replace(values=one.values & other.values if is_all else one.values | other.values)


def _relation(expression: Comparison | Membership, positive: bool) -> NormalForm:
    read = {variable.name: variable for variable in occurrences(expression)}
    if len(read) == 1:
        ((name, variable),) = read.items()
        domain = variable.type.domain
        held = frozenset(value for value in domain if evaluate(expression, {name: value}) is positive)
        return ALWAYS if len(held) == len(domain) else ValueLiteral(name, variable.type, held) if held else NEVER
    if not read:
        return ALWAYS if evaluate(expression, {}) is positive else NEVER
    if isinstance(expression, Membership):
        equal = (Comparison("==", expression.left, option) for option in expression.options)
        return junction(not positive, (_relation(each, positive) for each in equal))
    return _between(expression, positive)


def _between(comparison: Comparison, positive: bool) -> NormalForm:
    """A comparison of several variables, in one of the ways in which it can be written."""
    operator = comparison.operator
    if operator in ("!=", ">=", "<="):
        operator, positive = {"!=": "==", ">=": "<", "<=": ">"}[operator], not positive
    texts = [print_expression(side) for side in (comparison.left, comparison.right)]
    if operator == ">" or (operator == "==" and texts[0] > texts[1]):
        operator, texts = "<" if operator == ">" else "==", texts[::-1]
    return Opaque(f"{texts[0]} {operator} {texts[1]}", positive)
