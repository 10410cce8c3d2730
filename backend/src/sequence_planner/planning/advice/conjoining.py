"""Values written down as a predicate."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.syntax import Comparison, Constant, Expression, Not, Variable, conjunction
from sequence_planner.expressions.types import Value


def all_equal(automaton: Automaton, values: Iterable[tuple[str, Value]]) -> Expression:
    """Whether all of these variables and flags have these values."""
    return conjunction(*(_equals(Variable(name, automaton.types[name]), value) for name, value in values))


def _equals(variable: Variable, value: Value) -> Expression:
    if isinstance(value, bool):
        return variable if value else Not(variable)
    return Comparison("==", variable, Constant(value))
