"""What the next start waits for, in the model's own words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sequence_planner.automaton.tick import effect_writes
from sequence_planner.control.errand import Errand
from sequence_planner.control.execution import Execution
from sequence_planner.control.hindrances import of_ability, of_station
from sequence_planner.control.value_text import value_text
from sequence_planner.synthesis.guards import Guard


def waits_for(execution: Execution, name: str, feeds: Mapping[str, str], guard: Guard | None = None) -> list[str]:
    """Everything that keeps the ability from starting now; empty when it starts in the next tick.

    `feeds` names the topic behind each measured variable, `guard` is what the supervisor adds to the written ones.
    """
    if everything := list(of_station(execution)):
        return [each.text for each in everything]
    own = list(of_ability(execution, execution.automaton.abilities[name], feeds, guard))
    if own:
        return list(dict.fromkeys(each.text for each in own))
    if not execution.may_go_on(name):
        return [right_moment(execution)]
    return []


def right_moment(execution: Execution) -> str:
    """What the next start waits for although it may start."""
    if execution.errand is None:
        return "the right moment: started now, the rest of the plan would not reach its goals"
    if before := list(dict.fromkeys(_before(execution))):
        return f"what comes before it in what was taken: {', '.join(before)}"
    return "the right moment: started now, what was taken would not come to its end"


def _before(execution: Execution) -> Iterator[str]:
    """What has still to happen, of what the plan has before its next start."""
    automaton, state, (_, ticks) = execution.automaton, execution.state, execution.plan.order.rest()
    effects = {effect.name: effect for effect in automaton.effects}
    for tick in ticks:
        for name in tick.effects:
            for variable, value in (effect_writes(effects[name], state) or {}).items():
                if state[variable] != value:
                    yield value_text(automaton, variable, value)
        if tick.starts:
            return


def idle_since(execution: Execution, errand: Errand) -> float | None:
    """Since when nothing of an errand is under way; None while something is."""
    taken = errand.taken.monotonic
    own = [step for step in execution.plan.order.past if step.started and step.started.monotonic >= taken]
    ended = [step.ended.monotonic for step in own if step.ended is not None]
    return None if len(ended) < len(own) else max((taken, *ended))
