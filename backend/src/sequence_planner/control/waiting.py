"""What the next start waits for, in the model's own words."""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.control.execution import Execution
from sequence_planner.control.hindrances import of_ability, of_station
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
        return ["the right moment: started now, the rest of the plan would not reach its goals"]
    return []
