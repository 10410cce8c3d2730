"""Tells what jobs of a station consist of."""

from __future__ import annotations

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.structure import Ability, Automaton, WorkMaster, target
from sequence_planner.control.trial_watch import reactions
from sequence_planner.control.work_master_view import (
    WorkAbilityView,
    WorkMastersView,
    WorkMasterView,
    WorkOperationView,
)
from sequence_planner.expressions.printing import print_assignment


def work_masters_view(automaton: Automaton) -> WorkMastersView:
    """All work masters of a station, and what its abilities write."""
    return WorkMastersView(
        work_masters={name: _master(automaton, master) for name, master in automaton.work_masters.items()},
        abilities={name: _ability(automaton, ability) for name, ability in automaton.abilities.items()},
    )


def _master(automaton: Automaton, master: WorkMaster) -> WorkMasterView:
    return WorkMasterView(
        title=master.title,
        brings=[print_assignment(action) for action in master.brings],
        brought=sorted({target(action) for action in master.brings}),
        operations={name: _operation(automaton, name, after) for name, after in master.operations.items()},
    )


def _operation(automaton: Automaton, name: str, after: frozenset[str]) -> WorkOperationView:
    operation = automaton.operations[name]
    read = read_variables(automaton, (operation.goal,))
    return WorkOperationView(title=operation.title, after=sorted(after), goal_reads=sorted(read))


def _ability(automaton: Automaton, ability: Ability) -> WorkAbilityView:
    actions = [*ability.start_actions, *ability.finish_actions, *ability.cancel_actions]
    for effect in reactions(automaton, ability.name):
        actions += effect.actions
    written = sorted({target(action) for action in actions})
    return WorkAbilityView(title=ability.title, writes=written, instant=ability.finish_guard is None)
