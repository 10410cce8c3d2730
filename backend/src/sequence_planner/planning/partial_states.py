"""States of which few values are known, and the values that are known wherever a predicate holds."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.language.syntax import Comparison, Constant, Expression, Not, Variable, conjuncts
from sequence_planner.language.types import Value


class PartialState(dict[str, Value | None]):
    """The values of some variables and flags; all others are unknown."""

    def __missing__(self, name: str) -> None:
        return None


def equalities(predicate: Expression) -> Iterator[tuple[str, Value]]:
    """Variables and flags, with the values that the parts of a conjunction ask for."""
    for part in conjuncts(predicate):
        match part:
            case Comparison("==", Variable(name), Constant(value)):
                yield name, value
            case Variable(name):
                yield name, True
            case Not(Variable(name)):
                yield name, False
