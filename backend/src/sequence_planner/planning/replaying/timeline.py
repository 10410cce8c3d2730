"""When the abilities of a plan run: from their starts to the ticks in which they finish."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import apply_effects, finish, start, synchronise
from sequence_planner.immutable import Immutable
from sequence_planner.planning.plan import PlanTick


class Activity(Immutable):
    """One run of an ability, in ticks counted from 1; `finished` is None when the plan ends before."""

    ability: str
    started: int
    finished: int | None


def timeline(automaton: Automaton, state: State, ticks: Sequence[PlanTick]) -> tuple[Activity, ...]:
    """The runs of abilities in a plan from `state`, in the order of their starts.

    One without a finish guard is done at its start. Raises ValueError when the plan cannot be taken as it is written.
    """
    effects = {effect.name: effect for effect in automaton.effects}
    activities: list[Activity] = []
    running: dict[str, int] = {}
    for number, tick in enumerate(ticks, start=1):
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        if sensed is None:
            raise ValueError(f"what is expected in tick {number} cannot happen")
        finishing = finish(automaton, sensed)
        for name in finishing.finished:
            if (index := running.pop(name, None)) is not None:
                activities[index] = Activity(name, activities[index].started, number)
        state = synchronise(automaton, finishing.state)
        for name in tick.starts:
            ability = automaton.abilities[name]
            after = start(automaton, state, ability)
            if after is None:
                raise ValueError(f"{name} cannot start in tick {number}")
            state = after
            at_once = ability.finish_guard is None
            if not at_once:
                running[name] = len(activities)
            activities.append(Activity(name, number, number if at_once else None))
    return tuple(activities)
