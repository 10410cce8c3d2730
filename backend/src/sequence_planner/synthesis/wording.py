"""Covers in the words of the language: `not task and (bolts != placed or run_nut.executing)`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from sequence_planner.expressions.syntax import (
    And,
    Comparison,
    Constant,
    Expression,
    Membership,
    Not,
    Or,
    Variable,
    children,
    conjunction,
)
from sequence_planner.expressions.types import BooleanType, IntegerRange, Type, Value
from sequence_planner.synthesis.diagrams import Diagrams
from sequence_planner.synthesis.primes import Cube

_MOST_LISTED = 4  # values within a range; beyond them its bounds are said


def worded(types: Mapping[str, Type], diagrams: Diagrams, cubes: Sequence[Cube], allowed: bool) -> Expression:
    """Where one of `cubes` holds; or else, if they are not `allowed`, where none of them does."""
    parts = [tuple(_literals(types, diagrams, cube, allowed)) for cube in cubes]
    if allowed:
        return _either(*(conjunction(*part) for part in parts))
    return conjunction(*(_either(*part) for part in parts))


def count_literals(expression: Expression) -> int:
    """How many comparisons, memberships and truth values a person reads."""
    match expression:
        case Variable() | Comparison() | Membership():
            return 1
        case _:
            return sum(map(count_literals, children(expression)))


def _either(*parts: Expression) -> Expression:
    return parts[0] if len(parts) == 1 else Or(parts)


def _literals(types: Mapping[str, Type], diagrams: Diagrams, cube: Cube, allowed: bool) -> Iterator[Expression]:
    for (name, domain), mask in zip(diagrams.domains.items(), cube, strict=True):
        inside = tuple(value for position, value in enumerate(domain) if mask >> position & 1)
        outside = tuple(value for position, value in enumerate(domain) if not mask >> position & 1)
        if outside:
            variable = Variable(name, types[name])
            yield _literal(variable, inside, outside) if allowed else _literal(variable, outside, inside)


def _literal(variable: Variable, inside: tuple[Value, ...], outside: tuple[Value, ...]) -> Expression:
    """That the variable has one of the values `inside`."""
    if isinstance(variable.type, BooleanType):
        return variable if inside == (True,) else Not(variable)
    if len(inside) == 1:
        return Comparison("==", variable, Constant(inside[0]))
    if isinstance(variable.type, IntegerRange) and (ranged := _ranged(variable, variable.type, inside)) is not None:
        return ranged
    if len(outside) == 1:
        return Comparison("!=", variable, Constant(outside[0]))
    if len(inside) <= len(outside):
        return Membership(variable, tuple(map(Constant, inside)))
    return Not(Membership(variable, tuple(map(Constant, outside))))


def _ranged(variable: Variable, domain: IntegerRange, inside: tuple[Value, ...]) -> Expression | None:
    """The values by their bounds, if none between them is missing and they are not few."""
    least, most = int(inside[0]), int(inside[-1])
    if len(inside) != most - least + 1:
        return None
    at_least, at_most = Comparison(">=", variable, Constant(least)), Comparison("<=", variable, Constant(most))
    if most == domain.maximum:
        return at_least
    if least == domain.minimum:
        return at_most
    return And((at_least, at_most)) if len(inside) > _MOST_LISTED else None
