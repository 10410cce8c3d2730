"""Whether two automata are the same, however their conditions are written: exactly, also where values are unknown."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import reduce
from itertools import product
from math import prod

from sequence_planner.automaton.automaton import Automaton, target
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import RELATIONS, evaluate
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Assignment,
    BinaryTemporal,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    UnaryTemporal,
    Variable,
    children,
    occurrences,
)
from sequence_planner.language.types import BooleanType, Place, Type, Value

MOST_STATES = 30_000  # that are gone through where two conditions are not written alike
_TABLES = ("resources", "variables", "abilities", "operations", "specifications", "work_masters", "alarms")


def difference(one: Automaton, other: Automaton) -> str | None:
    """Where two automata differ, or may do; None where they are the same but for how conditions are written."""
    for table in _TABLES:
        if (found := _differing(getattr(one, table), getattr(other, table), table)) is not None:
            return found
    parts = (
        ("name", one.name, other.name),
        ("title", one.title, other.title),
        ("description", one.description, other.description),
        ("effects", one.effects, other.effects),
        ("flags", _flags(one), _flags(other)),
        ("rest", one.rest or TRUE, other.rest or TRUE),
        ("reactions", one.reactions, other.reactions),
    )
    return next((found for name, a, b in parts if (found := _differing(a, b, name)) is not None), None)


def _flags(automaton: Automaton) -> dict[str, Expression]:
    return dict(sorted(automaton.flag_predicates.items()))


def _differing(one: object, other: object, where: str) -> str | None:
    """Where two parts differ."""
    if isinstance(one, Place):  # lines move
        return None
    if isinstance(one, Expression) and isinstance(other, Expression):
        return None if are_equivalent(one, other) else where
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        if list(one) != list(other):
            return where
        pairs = ((f"{where} {key}", each, other[key]) for key, each in one.items())
    elif isinstance(one, tuple) and isinstance(other, tuple):
        if len(one) != len(other):
            return where
        if one and isinstance(one[0], Assignment):
            return _differing(_by_target(one), _by_target(other), where)
        pairs = ((f"{where} {n}", a, b) for n, (a, b) in enumerate(zip(one, other, strict=True)))
    elif isinstance(one, Immutable) and type(one) is type(other):
        pairs = ((f"{where}.{name}", getattr(one, name), getattr(other, name)) for name in one.__match_args__)
    else:
        return None if one == other else where
    return next((found for inner, a, b in pairs if (found := _differing(a, b, inner)) is not None), None)


def _by_target(actions: tuple[Assignment, ...]) -> dict[str, tuple[Expression, Expression]]:
    """Actions are taken all at once: their order does not matter."""
    return {target(each): (each.value, each.condition or TRUE) for each in sorted(actions, key=target)}


# Conditions


class _Literal(Immutable):
    """A variable has one of some values; unknown as long as the variable is."""

    name: str
    values: frozenset[Value]


class _Junction(Immutable):
    """All of some parts, or any of them."""

    is_all: bool
    parts: frozenset[object]


class _Formula(Immutable):
    """A temporal operator with its operands."""

    operator: str
    parts: tuple[object, ...]


def are_equivalent(one: Expression, other: Expression) -> bool:
    """Return whether two conditions have the same value in each state, also where variables are unknown.

    False as well where that is not found out.
    """
    return one == other or _same(_normal(one, False), _normal(other, False), _domains(one) | _domains(other))


def _domains(expression: Expression) -> dict[str, Type]:
    return {each.name: each.type for each in occurrences(expression)}


def _same(one: object, other: object, types: Mapping[str, Type]) -> bool:
    if one == other:
        return True
    if isinstance(one, _Formula) and isinstance(other, _Formula):
        alike = one.operator == other.operator
        return alike and all(_same(a, b, types) for a, b in zip(one.parts, other.parts, strict=True))
    if isinstance(one, _Junction) and isinstance(other, _Junction) and one.is_all is other.is_all:
        common = one.parts & other.parts  # what is said in both can only make them more alike
        if common and one.parts - common and other.parts - common:
            rest = (_joined(one.is_all, one.parts - common), _joined(other.is_all, other.parts - common))
            if _same(*rest, types):
                return True
    names = sorted({*_read(one), *_read(other)})
    if _has_formula(one) or _has_formula(other):
        return False
    if prod(len(types[name].domain) + 1 for name in names) > MOST_STATES:
        return False
    states = product(*((None, *types[name].domain) for name in names))
    valuations = (dict(zip(names, values, strict=True)) for values in states)
    return all(_value(one, each) == _value(other, each) for each in valuations)


def _normal(expression: Expression, negated: bool) -> object:
    """The condition, or what it denies, in a form in which neither order nor brackets count.

    Each step keeps its value over three truth values (Kleene).
    """
    match expression:
        case Constant(bool(value)):
            return value is not negated
        case Not(operand):
            return _normal(operand, not negated)
        case And(operands) | Or(operands):
            is_all = isinstance(expression, And) is not negated
            return _joined(is_all, frozenset(_normal(each, negated) for each in operands))
        case Implies(left, right):
            return _joined(negated, frozenset({_normal(left, not negated), _normal(right, negated)}))
        case Variable(name, type_) if isinstance(type_, BooleanType):
            return _Literal(name, frozenset({not negated}))
        case Comparison(operator, Variable(name, type_), Constant(value)):
            return _chosen(name, type_, negated, lambda each: RELATIONS[operator](each, value))
        case Comparison(operator, Constant(value), Variable(name, type_)):
            return _chosen(name, type_, negated, lambda each: RELATIONS[operator](value, each))
        case Membership(Variable(name, type_), options) if all(isinstance(each, Constant) for each in options):
            values = {each.value for each in options if isinstance(each, Constant)}
            return _chosen(name, type_, negated, values.__contains__)
        case UnaryTemporal(operator) | BinaryTemporal(operator):
            found = _Formula(operator, tuple(_normal(each, False) for each in children(expression)))
            return _Formula("not", (found,)) if negated else found
    return Not(expression) if negated else expression


def _chosen(name: str, type_: Type, negated: bool, holds: Callable[[Value], bool]) -> _Literal:
    return _Literal(name, frozenset(value for value in type_.domain if bool(holds(value)) is not negated))


def _joined(is_all: bool, parts: frozenset[object]) -> object:
    """Parts put together; those within parts of the same kind count as its own, and each variable is there once."""
    flat = {
        inner
        for each in parts
        for inner in (each.parts if isinstance(each, _Junction) and each.is_all is is_all else (each,))
    }
    if (not is_all) in flat:
        return not is_all
    literals: dict[str, list[frozenset[Value]]] = {}
    others: set[object] = set()
    for each in flat - {is_all}:
        if isinstance(each, _Literal):
            literals.setdefault(each.name, []).append(each.values)
        else:
            others.add(each)
    merge = frozenset[Value].intersection if is_all else frozenset[Value].union
    found = others | {_Literal(name, reduce(merge, values)) for name, values in literals.items()}
    if not found:
        return is_all
    return next(iter(found)) if len(found) == 1 else _Junction(is_all, frozenset(found))


def _read(part: object) -> Iterator[str]:
    if isinstance(part, _Literal):
        yield part.name
    elif isinstance(part, _Junction | _Formula):
        for each in part.parts:
            yield from _read(each)
    elif isinstance(part, Expression):
        yield from (each.name for each in occurrences(part))


def _has_formula(part: object) -> bool:
    return isinstance(part, _Formula) or (isinstance(part, _Junction) and any(map(_has_formula, part.parts)))


def _value(part: object, state: Mapping[str, Value | None]) -> Value | None:
    if isinstance(part, _Literal):
        value = state[part.name]
        return None if value is None else value in part.values
    if isinstance(part, _Junction):
        truths = {_value(each, state) for each in part.parts}
        if (not part.is_all) in truths:
            return not part.is_all
        return None if None in truths else part.is_all
    return evaluate(part, state) if isinstance(part, Expression) else bool(part)
