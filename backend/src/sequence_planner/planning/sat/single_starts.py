"""Bounded model checking of automata whose starts are taken one at a time: the fewest of them."""

from __future__ import annotations

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.collection import collection_put_off
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.plan import Plan, one_by_one, starts_of
from sequence_planner.planning.sat.search import Search, SearchTimeoutError
from sequence_planner.planning.sat.succession import Succession, succession


class SingleStarts:
    """Plans from safe states in which nothing is unknown, warm from question to question."""

    name = "bmc"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._searches: dict[bool, Search] = {}
        self._begun: tuple[Task, int] | None = None  # the last task, and how many ticks no plan of it has

    @collection_put_off()
    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan with the fewest starts, or up to how many ticks there is none. Asked again, it goes on."""
        searched = self._begun[1] if self._begun is not None and self._begun[0] is task else 0
        search = self._search(len(task.goals) == 1)
        try:
            if task.bound <= search.ticks:
                return self._downwards(search, task, budget)
            plan = search.plan(task.state, task.goals, task.circumstances, task.bound, budget, least=searched + 1)
        except SearchTimeoutError as late:
            self._begun = task, max(late.searched, searched)
            return Finding(searched=self._begun[1])
        return Finding(plan, searched=task.bound if plan is None else len(plan.ticks))

    def _downwards(self, search: Search, task: Task, budget: Budget) -> Finding:
        """The same where at most as many ticks are of use as there are in the solver: mostly one question will do."""
        best: Plan | None = None
        most = task.bound
        while most and (ticks := search.plan_within(task.state, task.goals, task.circumstances, most, budget)):
            best = one_by_one((name for _, name in starts_of(ticks)), minimal=True)
            most = len(best.ticks) - 1
        return Finding(best, searched=most if best is None else len(best.ticks))

    def _search(self, only_the_end_counts: bool) -> Search:
        """Of several goals each can hold at another moment, which another order of starts may do without."""
        if only_the_end_counts not in self._searches:
            order = tuple(self._automaton.abilities.values())
            follow: Succession = [None] * len(order)
            if only_the_end_counts:
                follow = succession(self._automaton, self._supervisor, order)
            self._searches[only_the_end_counts] = Search(
                self._automaton, self._supervisor, order, frozenset(), inside=True, succession=follow
            )
        return self._searches[only_the_end_counts]
