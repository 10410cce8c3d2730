"""Plain automata as the planner sees them: every transition is a start."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.automaton.automaton import Ability, Automaton, Flag, State
from sequence_planner.automaton.plain.steps import plain_transitions
from sequence_planner.automaton.tick import synchronise
from sequence_planner.core.immutable import replace
from sequence_planner.language.syntax import FALSE, TRUE
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Goal
from sequence_planner.planning.validation.replay import missing


def for_planning(automaton: Automaton) -> Automaton:
    """The plain `automaton` with every transition, also the uncontrollable ones, as an ability done at its start.

    What a supervisor of `automaton` allows, it allows here: no uncontrollable transition leads out of its safe set.
    The transitions of one tick happen one after another, so that any sequence of transitions is a run of ticks, and
    the other way round.
    """
    return with_flags(without_flags(automaton))


def without_flags(automaton: Automaton) -> Automaton:
    """The same with one start in each tick: the flags of abilities that are done at their start say nothing."""
    abilities = {
        name: Ability(name, automaton.name, name, TRUE, t.guard, t.actions, FALSE, FALSE, None, ())
        for name, t in plain_transitions(automaton).items()
    }
    return replace(automaton, abilities=abilities, flags=(), effects=(), initial=None)


def with_flags(automaton: Automaton) -> Automaton:
    """The same with flags, and with as many starts in a tick as there can be."""
    flags = tuple(Flag(ability.flag("enabled"), ability.enabled) for ability in automaton.abilities.values())
    return replace(automaton, flags=flags, one_at_a_time=False)


def as_station(automaton: Automaton, start: State, goals: Sequence[Goal]) -> tuple[Automaton, PlanningTask]:
    """The plain `automaton` for planning, and the task to reach those of `goals` that do not hold in `start`."""
    derived = for_planning(automaton)
    begin = synchronise(derived, {**dict.fromkeys(derived.types), **start})
    return derived, PlanningTask(begin, missing(goals, start))
