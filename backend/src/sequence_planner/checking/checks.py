"""All checks of a model."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sequence_planner.automaton.structure import Automaton
from sequence_planner.checking.conflicts import check_conflicts
from sequence_planner.checking.connections import Connections, check_connections
from sequence_planner.checking.executing import check_executing
from sequence_planner.checking.guards import check_guards
from sequence_planner.checking.operations import check_operations
from sequence_planner.checking.people import check_people
from sequence_planner.checking.specifications import check_specifications
from sequence_planner.checking.warning import ModelWarning

CHECKS: tuple[Callable[[Automaton], Iterable[ModelWarning]], ...] = (
    check_conflicts,
    check_executing,
    check_guards,
    check_operations,
    check_people,
    check_specifications,
)


def check_automaton(automaton: Automaton, connections: Connections | None = None) -> list[ModelWarning]:
    """All that is suspicious in a station's automaton, by place; `connections` are those to its topics.

    A plain automaton has neither ticks nor devices, and no conditions of which these checks know the use.
    """
    if automaton.one_at_a_time:
        return []
    found = {warning for check in CHECKS for warning in check(automaton)}
    if connections is not None:
        found |= set(check_connections(automaton, connections))
    return sorted(found)
