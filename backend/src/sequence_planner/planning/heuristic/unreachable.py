"""The engine that proves what not even the delete relaxation reaches."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.planning.heuristic.relaxation import reachable, unreached
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.process.budget import Budget, SpentError


class Relaxing:
    """Proves that a goal cannot be reached where not even the delete relaxation reaches it under the supervisor."""

    name = "relaxation"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A proof, or nothing."""
        try:
            relaxed = reachable(self._automaton, task.state, task.circumstances, self._supervisor, budget.require)
        except SpentError:
            return Finding()
        reached = all(relaxed.may(goal.predicate) for goal in task.goals)
        return Finding() if reached else Finding(proof=unreached(self._automaton, relaxed))
