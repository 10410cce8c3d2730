"""Random well-typed expressions and actions over given variables: every construct of the language occurs."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.language.syntax import (
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
    Variable,
)
from sequence_planner.language.types import BooleanType, EnumerationType, IntegerRange, Type

from .choices import Choices

Scope = Sequence[Variable]
_ORDER = ("==", "!=", "<", "<=", ">", ">=")


def predicate(choices: Choices, scope: Scope, depth: int = 2) -> Expression:
    """A truth value over the variables of `scope`."""
    if depth == 0 or choices.chance(3):
        return atom(choices, scope)
    shape = choices.number(0, 3)
    first = predicate(choices, scope, depth - 1)
    if shape == 3:
        return Not(first)
    second = predicate(choices, scope, depth - 1)
    if shape == 2:
        return Implies(first, second)
    parts = (first, second, atom(choices, scope)) if choices.chance(3) else (first, second)
    return Or(parts) if shape else And(parts)


def rare(choices: Choices, scope: Scope) -> Expression:
    """A conjunction, which holds in few states: something forbidden, or a goal that takes some way to reach."""
    return And(tuple(atom(choices, scope) for _ in range(choices.number(2, 3))))


def atom(choices: Choices, scope: Scope) -> Expression:
    """A predicate on one variable, or a comparison of two."""
    subject = choices.pick(scope)
    if isinstance(subject.type, BooleanType) and not choices.chance(4):
        return Not(subject) if choices.chance(2) else subject
    if choices.chance(4):
        return Membership(subject, tuple(_beside(choices, subject, scope) for _ in range(choices.number(1, 2))))
    if not isinstance(subject.type, IntegerRange):
        return Comparison(choices.pick(("==", "!=")), subject, _beside(choices, subject, scope))
    other = _beside(choices, subject, scope)
    if choices.chance(3):
        return Comparison(choices.pick(_ORDER), subject, _shifted(choices, subject.type, other))
    return Comparison(choices.pick(_ORDER), subject, other)


def guard(choices: Choices, scope: Scope) -> Expression:
    """What abilities and effects typically ask for: nothing, a value or two, and now and then anything."""
    shape = choices.number(0, 4)
    if shape == 0:
        return TRUE
    if shape == 4:
        return predicate(choices, scope)
    return equality(choices, scope) if shape == 1 else And((equality(choices, scope), atom(choices, scope)))


def equality(choices: Choices, scope: Scope) -> Expression:
    """A variable has one of its values."""
    subject = choices.pick(scope)
    return Comparison("==", subject, Constant(choices.pick(subject.type.domain)))


def actions(choices: Choices, targets: Scope, scope: Scope, least: int) -> tuple[Assignment, ...]:
    """Actions on up to two variables of `targets`; some are conditional, some copy a variable, some count."""
    return tuple(_action(choices, target, scope) for target in choices.different(targets, least, 2))


def _action(choices: Choices, target: Variable, scope: Scope) -> Assignment:
    if isinstance(target.type, IntegerRange) and choices.chance(3):
        return _counting(choices, target, target.type)
    condition = predicate(choices, scope, 1) if choices.chance(4) else None
    return Assignment(target, _value_for(choices, target, scope), condition)


def _counting(choices: Choices, target: Variable, type_: IntegerRange) -> Assignment:
    """One more or one less, up to the end of the range."""
    if choices.chance(2):
        return Assignment(
            target, Arithmetic("+", target, Constant(1)), Comparison("<", target, Constant(type_.maximum))
        )
    return Assignment(target, Arithmetic("-", target, Constant(1)), Comparison(">", target, Constant(type_.minimum)))


def _beside(choices: Choices, subject: Variable, scope: Scope) -> Constant | Variable:
    """A value, or a variable, that `subject` can be compared with."""
    if not choices.chance(3):
        return Constant(choices.pick(subject.type.domain))
    return choices.pick([other for other in scope if _comparable(subject.type, other.type)])


def _shifted(choices: Choices, type_: IntegerRange, other: Constant | Variable) -> Expression:
    """`other` and something more or less, as long as it can be compared with `type_` at all."""
    values = [int(value) for value in ((other.value,) if isinstance(other, Constant) else other.type.domain)]
    sign, shift = choices.pick(("+", "-")), choices.number(1, 2)
    signed = shift if sign == "+" else -shift
    apart = min(values) + signed > type_.maximum or max(values) + signed < type_.minimum
    return other if apart else Arithmetic(sign, other, Constant(shift))


def _comparable(one: Type, other: Type) -> bool:
    if isinstance(one, EnumerationType) and isinstance(other, EnumerationType):
        return bool(set(one.values) & set(other.values))
    return type(one) is type(other)


def _value_for(choices: Choices, target: Variable, scope: Scope) -> Expression:
    """A value that is in the domain of `target` for certain."""
    domain = set(target.type.domain)
    fitting = [read for read in scope if _comparable(read.type, target.type) and set(read.type.domain) <= domain]
    if not fitting or not choices.chance(3):
        return Constant(choices.pick(target.type.domain))
    if isinstance(target.type, BooleanType) and choices.chance(2):
        return predicate(choices, scope, 1)
    bits = [read for read in fitting if read.type == IntegerRange(0, 1)]
    if bits and target.type == IntegerRange(-1, 1) and choices.chance(2):
        return Arithmetic("-", choices.pick(bits), choices.pick(bits))
    return choices.pick(fitting)
