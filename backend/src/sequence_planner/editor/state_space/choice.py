"""A first choice of variables for a state space: few nodes that show what is forbidden, and what is to be done."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Final

from sequence_planner.automaton.automaton import Automaton, Kind, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.editor.state_space.quotient import Quotient

MOST_SUGGESTED: Final = 40  # nodes
_MOST_TOGETHER: Final = 4  # variables
_FORBIDDEN, _GOAL, _START = 3, 2, 1  # how much a variable is asked about there


def ranked(automaton: Automaton) -> list[str]:
    """The variables but what operations are doing, those first about which most is said."""
    weights: Counter[str] = Counter()
    for specification in automaton.specifications.values():
        weights.update(dict.fromkeys(read_variables(automaton, (specification.forbidden,)), _FORBIDDEN))
    for operation in automaton.operations.values():
        weights.update(dict.fromkeys(read_variables(automaton, (operation.goal,)), _GOAL))
    for ability in automaton.abilities.values():
        weights.update(dict.fromkeys(read_variables(automaton, (ability.start_guard,)), _START))
    kept = [name for name, variable in automaton.variables.items() if variable.kind is not Kind.ACTIVITY]
    return sorted(kept, key=lambda name: -weights[name])


def about_guards(automaton: Automaton, supervisor: Supervisor, abilities: Iterable[str]) -> list[str]:
    """The variables that some abilities write at their start, and that tell where the supervisor keeps them back."""
    names = list(abilities)
    found = dict.fromkeys(target(action) for name in names for action in automaton.abilities[name].start_actions)
    for name in names:
        if name in supervisor.guards:
            found |= dict.fromkeys(supervisor.guards[name].names)
    return [name for name in found if name in automaton.variables]


def suggested(quotient: Quotient, wanted: Sequence[str], most: int = MOST_SUGGESTED) -> tuple[str, ...]:
    """The first of the variables that are `wanted` that tell states apart and, together, make so many nodes at most."""
    chosen: tuple[str, ...] = ()
    nodes = 1
    for name in wanted:
        if len(chosen) == _MOST_TOGETHER:
            break
        count = quotient.number_of_nodes((*chosen, name))
        if nodes < count <= most:
            chosen, nodes = (*chosen, name), count
    return chosen or tuple(wanted[:1])
