"""The values that a new product brings: estimated ones that are so from when it is there, and what has to be over
before.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from sequence_planner.automaton.automaton import Ability, Automaton, State, WorkMaster, target
from sequence_planner.execution.state import ExecutionState
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.language.syntax import Constant
from sequence_planner.language.types import Value
from sequence_planner.texts.message import message


def lacking(master: WorkMaster, state: State) -> dict[str, Value]:
    """The values that its product brings and that are not so in `state`."""
    brought: dict[str, Value] = {}
    for action in master.brings:
        assert isinstance(action.value, Constant)
        if state[target(action)] != action.value.value:
            brought[target(action)] = action.value.value
    return brought


def final_operations(automaton: Automaton) -> frozenset[str]:
    """The operations with which products are done: the final one of each work master, where it has one."""
    found = (final_operation(master.operations) for master in automaton.work_masters.values())
    return frozenset(name for name in found if name is not None)


def final_operation(before: Mapping[str, Collection[str]]) -> str | None:
    """The operation that comes after all others, each of which has those `before` it; None where there is none."""
    others = {each for names in before.values() for each in names}
    ends = [name for name in before if name not in others]
    return ends[0] if len(ends) == 1 else None


def kept_back(conduct: ExecutionState) -> Iterator[str]:
    """Yield what has to be otherwise before values may be brought that are not so yet, in words."""
    if conduct.production is not Production.STARTED:
        yield message("waits.production")
    if conduct.mode is not Mode.AUTOMATIC:
        yield message("waits.automatic")
    if conduct.operator_plan is not None:
        yield message("waits.end", title=conduct.operator_plan.title)


def still_written(automaton: Automaton, master: WorkMaster, running: Iterable[str]) -> Iterator[str]:
    """Yield what runs and decides on the values that its product brings, in words: that belongs to the product
    before.
    """
    brought = frozenset(map(target, master.brings))
    for name in sorted(running):
        ability = automaton.abilities[name]
        if _written(ability) & brought:
            yield message("waits.end-of", title=ability.title)


def _written(ability: Ability) -> frozenset[str]:
    """The variables that a run of the ability can write."""
    actions = (*ability.start_actions, *ability.finish_actions, *ability.cancel_actions)
    return frozenset(map(target, actions))
