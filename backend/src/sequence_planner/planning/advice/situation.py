"""Where the station is while advice is worked out: as it is, or as it would be."""

from __future__ import annotations

from sequence_planner.automaton.structure import State
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan import LONGEST, Circumstances, Contract, Goal
from sequence_planner.planning.replaying.replay import missing


class Situation(Immutable):
    """A `state`, the `goals` that are missing there, and the `circumstances` of production, without restart."""

    state: State
    goals: Goals
    circumstances: Circumstances
    longest: int = LONGEST

    def production(self) -> Task:
        """To reach all goals in an ordinary mode."""
        goals = missing(self.goals, self.state)
        return Task(self.state, goals, self.circumstances, Contract.FAST, self.longest)

    def restart(self, goals: Goals | None = None) -> Task:
        """To reach `goals`, or those of the situation, in restart mode."""
        wanted = missing(self.goals if goals is None else goals, self.state)
        return Task(self.state, wanted, replace(self.circumstances, restart=True), Contract.FAST, self.longest)

    def reset(self, operation: str) -> Situation:
        """The formula of the operation, if it has one, begins anew."""
        goals = tuple(replace(goal, at=0) if goal.name == operation else goal for goal in self.goals)
        return replace(self, goals=goals)

    def without(self, names: frozenset[str]) -> Situation:
        """With fewer goals."""
        return replace(self, goals=tuple(goal for goal in self.goals if goal.name not in names))

    def least(self) -> Goal | None:
        """The goal that is given up first."""
        return min(self.goals, key=lambda goal: (goal.priority, goal.name), default=None)
