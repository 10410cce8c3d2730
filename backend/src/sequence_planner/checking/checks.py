"""All checks of a model."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.structure import Automaton
from sequence_planner.checking.conflicts import check_conflicts
from sequence_planner.checking.connections import Connections, check_connections
from sequence_planner.checking.effects import check_effects
from sequence_planner.checking.executing import check_executing
from sequence_planner.checking.guards import check_guards
from sequence_planner.checking.operations import check_operations
from sequence_planner.checking.people import check_people
from sequence_planner.checking.specifications import check_specifications
from sequence_planner.checking.warning import ModelWarning

# What each looks for, for people; those first that take least time.
CHECKS: Mapping[str, Callable[[Automaton], Iterable[ModelWarning]]] = {
    "formulas that say nothing": check_operations,
    "specifications that forbid nothing": check_specifications,
    "effects that contradict each other": check_effects,
    "tasks of people": check_people,
    "finishes that rely on `executing`": check_executing,
    "conditions that never hold": check_guards,
}
CONFLICTS = "finishes that conflict"  # looked for last, as that can take long


@dataclass(frozen=True)
class Looked:
    """What is being looked for, None at the end, and what has been found since the `Looked` before."""

    pending: str | None
    warnings: tuple[ModelWarning, ...] = ()


def looked(automaton: Automaton, connections: Connections | None = None) -> Iterator[Looked]:
    """What is soon found to be suspicious in a station's automaton; `connections` are those to its topics.

    A plain automaton has neither ticks nor devices, and no conditions of which these checks know the use.
    """
    if not automaton.one_at_a_time:
        if connections is not None:
            yield Looked("variables without a use", tuple(check_connections(automaton, connections)))
        for what, check in CHECKS.items():
            yield Looked(what)
            yield Looked(what, tuple(check(automaton)))
    yield Looked(None)


def conflicting(automaton: Automaton) -> Iterator[Looked]:
    """The finishes that conflict, as they are found."""
    if not automaton.one_at_a_time:
        yield Looked(CONFLICTS)
        yield from (Looked(CONFLICTS, (warning,)) for warning in check_conflicts(automaton))
    yield Looked(None)


def check_automaton(automaton: Automaton, connections: Connections | None = None) -> list[ModelWarning]:
    """All that is suspicious, by place."""
    found = [*looked(automaton, connections), *conflicting(automaton)]
    return sorted({warning for each in found for warning in each.warnings})
