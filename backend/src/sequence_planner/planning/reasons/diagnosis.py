"""What is said when there is no plan at all: why, and what would bring one back."""

from __future__ import annotations

from collections.abc import Collection

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.expressions.printing import print_value
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan import Circumstances
from sequence_planner.planning.reasons.corrections import Change, Correction, corrections
from sequence_planner.planning.reasons.why import Member, Part, Reason, SupervisorFor, explain
from sequence_planner.planning.replaying.replay import missing

_SHARE = 0.6  # of the time, for the reason; corrections have the rest


class DiagnosisRequest(Immutable):
    """A question why no run reaches all of `goals` from `state`, until `deadline` seconds have passed."""

    state: State
    goals: Goals
    circumstances: Circumstances
    deadline: float = 20.0

    @property
    def task(self) -> Task:
        """What cannot be done: goals that are met already take no part in it."""
        return Task(self.state, missing(self.goals, self.state), self.circumstances)


class Diagnosis(Immutable):
    """A `reason`, if one was found in time, and corrections of the fewest changes."""

    reason: Reason | None
    corrections: tuple[Correction, ...]


def diagnose(
    automaton: Automaton, supervisor: Supervisor, supervisor_for: SupervisorFor, task: Task, budget: Budget
) -> Diagnosis:
    """Why the goals of `task` cannot be reached, as far as the budget lets it be found."""
    reason = explain(automaton, supervisor_for, task, budget.part(_SHARE))
    return Diagnosis(reason, () if reason is None else corrections(automaton, supervisor, task, budget))


def member_text(member: Member, out_of_service: Collection[str] = ()) -> str:
    """A member of a reason, in the names of the model; resources can be offline because they are `out_of_service`."""
    match member.part:
        case Part.VALUE if member.value is None:
            return f"{member.name} is not known"
        case Part.VALUE:
            assert member.value is not None
            return f"{member.name} is {print_value(member.value)}"
        case Part.SPECIFICATION:
            return f"the specification {member.name}"
        case Part.AVOID:
            return f"{member.name} is to be avoided"
        case Part.OFFLINE:
            return f"{member.name} is {'out of service' if member.name in out_of_service else 'offline'}"
        case Part.BARRED:
            return f"{member.name} is out of service"
        case Part.LOCAL:
            return f"the local formula of {member.name}"
        case Part.GOAL:
            return f"the goal {member.name}"


def correction_text(correction: Correction, out_of_service: Collection[str] = ()) -> str:
    """Changes that would help, in the names of the model; resources can be `out_of_service`."""
    return " and ".join(_change_text(change, out_of_service) for change in correction.changes)


def _change_text(change: Change, out_of_service: Collection[str]) -> str:
    if change.value is not None:
        return f"{change.name} := {print_value(change.value)}"
    return f"{change.name} {'in service' if change.ability or change.name in out_of_service else 'online'}"
