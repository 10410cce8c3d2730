"""Why there is no plan from any of several initial states: a reason for each, as few as are found to be enough."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from sequence_planner.automaton.structure import State
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.reasons.diagnosis import Diagnosis
from sequence_planner.planning.reasons.why import Part, Reason
from sequence_planner.planning.replaying.replay import missing

DiagnoseFrom = Callable[[State, Budget], Diagnosis]


class FromThese(Immutable):
    """Why there is no plan from any of `states`, of which the `diagnosis` is of the first."""

    states: tuple[State, ...]
    diagnosis: Diagnosis


def why_from_each(
    states: Sequence[State], goals: Goals, diagnose_from: DiagnoseFrom, budget: Budget
) -> Iterator[FromThese]:
    """Why none of `states` leads to `goals`; those that no reason is found for in time come last, together.

    A reason holds for every state that agrees with it, and so for those of the others that do.
    """
    left, unexplained = list(states), list[State]()
    while left:
        first = left[0]
        diagnosis = diagnose_from(first, budget.part(1 / len(left)))
        reason = diagnosis.reason
        if reason is None:
            unexplained.append(left.pop(0))
            continue
        same = [state for state in left if state is first or holds_for(reason, state, goals)]
        left = [state for state in left if all(state is not other for other in same)]
        yield FromThese(tuple(same), diagnosis)
    if unexplained:
        yield FromThese(tuple(unexplained), Diagnosis(None, ()))


def holds_for(reason: Reason, state: State, goals: Goals) -> bool:
    """Whether `reason`, found for another state, excludes every plan from `state` too."""
    wanted = {goal.name for goal in missing(goals, state)}
    return all(
        state[member.name] == member.value if member.part is Part.VALUE else member.name in wanted
        for member in reason.members
        if member.part in (Part.VALUE, Part.GOAL)
    )
