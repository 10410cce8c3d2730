"""Bounded model checking of automata whose starts are taken one at a time: the fewest of them."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import replace
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Plan, one_by_one, starts_of
from sequence_planner.planning.sat.partial_order import Singly, Succession, succession
from sequence_planner.planning.sat.search import Search, SearchTimeoutError, SoughtPlans
from sequence_planner.process.budget import Budget, SpentError
from sequence_planner.process.gc_tuning import collection_put_off


class _Progress:
    """The findings on a task so far: the `best` plan, and that none has up to `searched` ticks."""

    def __init__(self, task: PlanningTask) -> None:
        self.task = task
        self.best: Plan | None = None
        self.searched = 0

    @property
    def useful(self) -> int:
        """More ticks are of no use."""
        return self.task.bound if self.best is None else len(self.best.ticks) - 1

    @property
    def finding(self) -> Finding:
        """The part of it that is found; of a plan, none has fewer ticks than there are said to be searched."""
        if self.best is None:
            return Finding(searched=self.searched)
        proven = self.searched >= len(self.best.ticks) - 1
        return Finding(replace(self.best, minimal_ticks=proven, minimal_starts=proven), searched=self.searched + 1)


class SingleStarts:
    """Plans from safe states in which nothing is unknown, warm from question to question."""

    name = "bmc"

    def __init__(self, automaton: Automaton, supervisor: Supervisor, starts: Starts | None = None) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._starts = starts or Starts(automaton, supervisor)
        self._searches: dict[bool, Search] = {}
        self._last: _Progress | None = None

    @collection_put_off()
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan with the fewest starts, or up to how many ticks there is none. Asked again, it goes on.

        When the budget is spent, the best plan so far, with no more proven of it than is.
        """
        if self._last is None or self._last.task is not task:
            self._last = _Progress(task)
        done = self._last
        try:
            search = self._search(len(task.goals) == 1, budget)
            if task.bound <= search.ticks:
                self._downwards(search, done, budget)
            else:
                self._upwards(search, done, budget)
        except SearchTimeoutError as late:
            done.searched = max(done.searched, late.searched)
        except SpentError:  # before the first question
            pass
        return done.finding

    def _upwards(self, search: Search, done: _Progress, budget: Budget) -> None:
        """The shortest, length by length."""
        task = done.task
        plan = search.plan(replace(SoughtPlans.of(task), least=done.searched + 1), budget)
        done.best, done.searched = plan, task.bound if plan is None else len(plan.ticks) - 1

    def _downwards(self, search: Search, done: _Progress, budget: Budget) -> None:
        """The same where at most as many ticks are of use as there are in the solver: mostly one question will do."""
        while (most := done.useful) > done.searched:
            sought = replace(SoughtPlans.of(done.task), longest=most, least=done.searched + 1, at_once=True)
            plan = search.plan(sought, budget)
            if plan is None:
                done.searched = most
                return
            done.best = one_by_one(name for _, name in starts_of(plan.ticks))

    def _search(self, only_the_end_counts: bool, budget: Budget) -> Search:
        """Of several goals each can hold at another moment, which another order of starts may do without.

        Raises `SpentError`.
        """
        if only_the_end_counts not in self._searches:
            order = tuple(self._automaton.abilities.values())
            follow: Succession = [None] * len(order)
            if only_the_end_counts:
                follow = succession(self._starts, [ability.name for ability in order], budget.require)
            self._searches[only_the_end_counts] = Search(
                self._automaton, self._supervisor, order, frozenset(), inside=True, singly=Singly(follow, self._starts)
            )
        return self._searches[only_the_end_counts]
