"""Request types of the restart advisor, and the station's recovery situation, real or hypothetical."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from sequence_planner.automaton.automaton import State
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import LONGEST, ORDINARY, Circumstances, Contract, Goal
from sequence_planner.planning.validation.replay import missing

# What an advisor is asked.

Pairing = tuple[str, Value, str, Value]  # a variable and a value, and another with the value it never has together


class AdviceRequest(Immutable):
    """A request for a way back to work on `goals`, those of the active operations, until `deadline` seconds have
    passed.

    The advisor decides itself where restart abilities may start. Effects that are `stalled` should have happened by
    now, and are not counted on as long as nothing changes for them; those that are `explained` would not have to, had
    the others. `last` has what unknown measured variables were
    when they were known last. The formulas of `violated` goals were, and their operations must be reset first. No
    correction or physical change makes an `impossible` pair of values, and none is one of a `fixed` variable. People
    may yet do tasks that change what is `answered`, of which somebody has said how it is. `waiting` are the goals of
    operations that become active as soon as their preconditions hold. Whoever asks hears `until` that
    moment on the clock of `time.monotonic`, also where work on it begins late. One who is `patient` knows ways already:
    all the time is for what else there is.
    """

    state: State
    goals: Goals
    circumstances: Circumstances = ORDINARY
    stalled: frozenset[str] = frozenset()
    explained: frozenset[str] = frozenset()
    last: Mapping[str, Value] = {}
    impossible: frozenset[Pairing] = frozenset()
    fixed: frozenset[str] = frozenset()
    violated: Goals = ()
    waiting: Goals = ()
    deadline: float = 1.8
    until: float = inf
    longest: int = LONGEST
    patient: bool = False
    answered: frozenset[str] = frozenset()


class GoalPlanRequest(Immutable):
    """A manual plan to `target`, which is the precondition of `operation` where that is to be reset.

    `circumstances` say whether restart abilities may start; the rest is as in `AdviceRequest`.
    """

    state: State
    goals: Goals
    target: Expression
    operation: str | None = None
    circumstances: Circumstances = ORDINARY
    stalled: frozenset[str] = frozenset()
    violated: Goals = ()
    deadline: float = 1.8
    longest: int = LONGEST


# Where the station is while advice is worked out: as it is, or as it would be.


class RecoverySituation(Immutable):
    """A `state`, the `goals` that are missing there, and the `circumstances` of production, without restart."""

    state: State
    goals: Goals
    circumstances: Circumstances
    longest: int = LONGEST

    def production(self) -> PlanningTask:
        """To reach all goals in an ordinary mode."""
        goals = missing(self.goals, self.state)
        return PlanningTask(self.state, goals, self.circumstances, Contract.FAST, self.longest)

    def restart(self, goals: Goals | None = None) -> PlanningTask:
        """To reach `goals`, or those of the situation, in restart mode."""
        wanted = missing(self.goals if goals is None else goals, self.state)
        return PlanningTask(self.state, wanted, replace(self.circumstances, restart=True), Contract.FAST, self.longest)

    def reset(self, operation: str) -> RecoverySituation:
        """The formula of the operation, if it has one, begins anew."""
        goals = tuple(replace(goal, at=0) if goal.name == operation else goal for goal in self.goals)
        return replace(self, goals=goals)

    def without(self, names: frozenset[str]) -> RecoverySituation:
        """With fewer goals."""
        return replace(self, goals=tuple(goal for goal in self.goals if goal.name not in names))

    def least(self) -> Goal | None:
        """The goal that is given up first."""
        return min(self.goals, key=lambda goal: (goal.priority, goal.name), default=None)
