"""What is soon known of a question: that there is a plan, or that there is none. Nobody need look for a proof then."""

from __future__ import annotations

from functools import cached_property

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.decomposed.operation_by_operation import OperationByOperation
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.heuristic.best_first import HeuristicSearch
from sequence_planner.planning.plan import Plan
from sequence_planner.planning.relaxed.relaxing import Relaxing
from sequence_planner.planning.replaying.acceptance import Acceptance

_MOST_POSITIONS = 100  # of a search: most plans that are there are found from fewer


class ReadyAnswers:
    """Answers about one automaton under one supervisor, as far as that takes little time."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._acceptance = Acceptance(automaton, supervisor)
        self._relaxing = Relaxing(automaton, supervisor)

    def answer(self, task: Task, budget: Budget) -> Finding:
        """A plan, which has been replayed, or a proof that there is none, or neither. Raises `SpentError`."""
        excluded = self._relaxing.solve(task, budget)
        if excluded.proof is not None:
            return excluded
        plan = self._by_operations.solve(task, budget).plan
        budget.require()
        if plan is None:
            ticks = self._search.ticks(task, budget, _MOST_POSITIONS)
            plan = None if ticks is None else Plan(ticks, minimal_ticks=False, minimal_starts=False)
        return Finding(plan if plan is not None and self._acceptance.accepts(task, plan) else None)

    @cached_property
    def _by_operations(self) -> OperationByOperation:
        return OperationByOperation(self._automaton, self._supervisor)

    @cached_property
    def _search(self) -> HeuristicSearch:
        return HeuristicSearch(self._automaton, self._supervisor)
