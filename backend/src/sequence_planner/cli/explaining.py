"""Why there is no plan at all, found out in a process of its own: what it computes with sets cannot be interrupted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.cli.analysing import Limits
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan import Circumstances
from sequence_planner.planning.reasons.diagnosis import Diagnosis, DiagnosisRequest, diagnose
from sequence_planner.planning.reasons.initially import FromThese, why_from_each
from sequence_planner.planning.single.derived import as_station
from sequence_planner.synthesis.fewer import FewerSpecifications

_SHARE = 0.9  # of the time, for the process: it says what it has found before nobody listens any more


def explained(
    automaton: Automaton,
    supervisor: Supervisor,
    states: Sequence[State],
    goals: Goals,
    circumstances: Circumstances,
    limits: Limits,
) -> tuple[FromThese, ...]:
    """Why none of `states` leads to `goals`, as far as it is found within `limits`."""
    from sequence_planner.analysis.process import SynthesisEndedError, told  # noqa: PLC0415

    found: list[FromThese] = []
    seconds = limits.left
    try:
        question = (automaton, supervisor, states, goals, circumstances, _SHARE * seconds)
        found.extend(told(limits.memory, seconds, _explaining, *question))
    except (TimeoutError, SynthesisEndedError):
        known = [state for each in found for state in each.states]
        if left := tuple(state for state in states if state not in known):
            found.append(FromThese(left, Diagnosis(None, ())))
    return tuple(found)


def _explaining(
    automaton: Automaton,
    supervisor: Supervisor,
    states: Sequence[State],
    goals: Goals,
    circumstances: Circumstances,
    seconds: float,
) -> Iterator[FromThese]:
    fewer = FewerSpecifications(automaton, supervisor)

    def asked(state: State) -> tuple[Automaton, Task]:
        if automaton.one_at_a_time:
            return as_station(automaton, state, goals)
        return automaton, DiagnosisRequest(state, goals, circumstances).task

    def diagnosed(state: State, budget: Budget) -> Diagnosis:
        model, task = asked(state)
        return diagnose(model, supervisor, fewer, task, budget)

    yield from why_from_each(states, goals, diagnosed, Budget.seconds(seconds))
