"""What the delete relaxation excludes whatever the values of most variables are: soon known, and often all it takes."""

from __future__ import annotations

from collections.abc import Collection

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.types import Value
from sequence_planner.planning.engine import Task
from sequence_planner.planning.plan import Proof
from sequence_planner.planning.relaxed.permission import Permission
from sequence_planner.planning.relaxed.relaxation import Relaxation, counted_on, unreached


def relaxed_proof(
    automaton: Automaton, task: Task, fixed: Collection[str], supervisor: Supervisor | None = None
) -> Proof | None:
    """That the goals cannot be reached together from any state that has the values of the variables `fixed`.

    None where the relaxation does not tell. A variable that is awaited is none of those that may have other values.
    """
    first: dict[str, set[Value | None]] = {name: {value} for name, value in task.state.items()}
    for name, variable in automaton.variables.items():
        if name not in fixed and task.state[name] is not None:
            first[name] = set(variable.type.domain)
    permission = None if supervisor is None else Permission(supervisor)
    relaxed = Relaxation(automaton, first, counted_on(automaton, task.circumstances), permission)
    if all(relaxed.may(goal.predicate) for goal in task.goals):
        return None
    return unreached(automaton, relaxed)
