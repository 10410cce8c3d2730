"""Questions to an engine, and what it finds: several of them stand behind one interface."""

from __future__ import annotations

from typing import Protocol

from sequence_planner.automaton.automaton import State
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import DEPTH, LONGEST, ORDINARY, Circumstances, Contract, Plan, Proof
from sequence_planner.process.budget import Budget


class PlanningTask(Immutable):
    """Reach all of `goals`, none of which holds in `state`, in at most `longest` ticks.

    Engines that prove that no shorter plan exists look for plans of up to `depth` ticks.
    """

    state: State
    goals: Goals
    circumstances: Circumstances = ORDINARY
    contract: Contract = Contract.MINIMAL
    longest: int = LONGEST
    depth: int = DEPTH

    @property
    def bound(self) -> int:
        """The number of ticks up to which it is worth while to prove that there is no plan."""
        return min(self.depth, self.longest)


class Finding(Immutable):
    """A plan, or a proof that there is none, or neither.

    No plan has at most `searched` ticks, or, when there is a plan, none has fewer than `searched`. When it is
    `exhausted`, there is none in all that can be reached, which has been looked at.
    """

    plan: Plan | None = None
    proof: Proof | None = None
    searched: int = 0
    exhausted: bool = False

    @property
    def decided(self) -> bool:
        """True if there is nothing more to find for a fast plan."""
        return self.plan is not None or self.proof is not None or self.exhausted


class Engine(Protocol):
    """Works on one task at a time, in one thread, and may keep what it learns for the next."""

    @property
    def name(self) -> str:
        """The name by which answers say that it was this one."""

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """Return what is found before the budget is spent; nothing, when the engine is none for such a task."""
