"""Goals followed along a run, position by position: the explicit counterpart of `tracking`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from sequence_planner.automaton.automaton import State
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import TRUE
from sequence_planner.planning.problem import Goal

if TYPE_CHECKING:
    from sequence_planner.planning.goals.monitor import Monitor

Goals = tuple[Goal, ...]


def settled(goals: Iterable[Goal], state: State) -> Goals | None:
    """The goals that are still missing after step 3 has led to `state`; None when one can never be reached any more."""
    missing: list[Goal] = []
    for goal in goals:
        if not holds(goal.predicate, state):
            missing.append(goal)
        elif goal.local != TRUE and not _monitor(goal).satisfied(goal.at, state):
            return None
    return moved(missing, state)


def moved(goals: Iterable[Goal], state: State) -> Goals | None:
    """The same goals after a start that has led to `state`; None when one can never be reached any more."""
    after: list[Goal] = []
    for goal in goals:
        if goal.local != TRUE:
            monitor = _monitor(goal)
            at = monitor.step(goal.at, state)
            if at in monitor.hopeless:
                return None
            goal = replace(goal, at=at)
        after.append(goal)
    return tuple(after)


def _monitor(goal: Goal) -> Monitor:
    # Not before there is a formula: importing it takes a tenth of the time that importing the planner takes.
    from sequence_planner.planning.goals.monitor import monitor_of  # noqa: PLC0415

    return monitor_of(goal.local)
