"""The engine that plans for one operation after the other, as those who modelled the station have sliced the work.

A goal that is a hundred ticks away is out of reach of engines that search or unroll. The operations on the way to it
are not: each is planned for from where the last one has ended, and after each of them it is looked anew which lead on.
What is found is a plan like any other, made short, and says nothing about others.
"""

from __future__ import annotations

import time
from functools import cached_property

from sequence_planner.automaton.compiled import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.collection import collection_put_off
from sequence_planner.expressions.evaluation import holds
from sequence_planner.immutable import replace
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.decomposed.operation_task import OperationTask
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.heuristic.best_first import HeuristicSearch
from sequence_planner.planning.heuristic.interference import Interference
from sequence_planner.planning.heuristic.space import Move, Position, Space
from sequence_planner.planning.heuristic.trimming import Trimmer
from sequence_planner.planning.plan import Goal, Plan, PlanTick
from sequence_planner.planning.relaxed.relaxation import Possible, reachable

_MOST_POSITIONS = 400  # that the search for one operation's goal may come to
_LEAST_TRIMMING = 0.2  # seconds, or as long as finding the plan took


class _Work:
    """What has been done of a task: the ticks so far, where they lead, and what was tried in vain from there."""

    def __init__(self, task: Task, space: Space, possible: Possible) -> None:
        self.task = task
        self.space = space
        self.possible = possible
        self.ticks: tuple[PlanTick, ...] = ()
        self.position = space.begin()
        self.in_vain: set[Goals] = set()
        self.seconds = 0.0


class OperationByOperation:
    """Plans for one automaton under one supervisor; asked again, it goes on where the budget was spent."""

    name = "operation by operation"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._work: _Work | None = None

    @collection_put_off()
    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan by way of operations; nothing for goals that are near, or where no operation leads on."""
        began = time.monotonic()
        if self._work is None or self._work.task is not task:
            self._work = self._begun(task)
        work = self._work
        try:
            while work is not None and work.position.goals:
                if not self._advanced(work, budget):
                    work = None
        except SpentError:
            return Finding()
        finally:
            if work is not None:
                work.seconds += time.monotonic() - began
        self._work = None
        if work is None:
            return Finding()
        share = max(work.seconds, _LEAST_TRIMMING) / max(budget.remaining, _LEAST_TRIMMING)
        trimmer = Trimmer(work.space, self._interference, None, budget.part(min(share, 0.5)))
        ticks = trimmer.trimmed(work.ticks)
        if len(ticks) > task.longest:
            return Finding()
        return Finding(Plan(ticks, minimal_ticks=False, minimal_starts=False))

    @cached_property
    def _operations(self) -> OperationTask:
        return OperationTask(self._automaton)

    @cached_property
    def _search(self) -> HeuristicSearch:
        return HeuristicSearch(self._automaton, self._supervisor)

    @cached_property
    def _compiled(self) -> CompiledTick:
        return CompiledTick(self._automaton, hot=False)

    @cached_property
    def _interference(self) -> Interference:
        return Interference(self._automaton)

    def _begun(self, task: Task) -> _Work | None:
        """Nothing done yet; None where all operations on the way can be pursued already: those are not far."""
        operations = self._automaton.operations
        goals = [goal.predicate for goal in task.goals]
        on_the_way = self._operations.towards(task.state, goals) if operations else None
        if not on_the_way or all(holds(operations[name].precondition, task.state) for name in on_the_way):
            return None
        possible = reachable(self._automaton, task.state, task.circumstances).possible
        return _Work(task, Space(self._compiled, self._supervisor, task, at_once=False), possible)

    def _advanced(self, work: _Work, budget: Budget) -> bool:
        """Go on to the next milestone that can be reached, or to the goals; False when there is no way on."""
        for goals in (*self._milestones(work), work.position.goals):
            if goals in work.in_vain:
                continue
            part = replace(work.task, state=dict(work.position.run.values), goals=goals)
            ticks = self._search.ticks(part, budget, _MOST_POSITIONS)
            if ticks and len(work.ticks) + len(ticks) <= work.task.longest:
                after = _walked(work.space, work.position, ticks)
                if after is not None:
                    work.position, work.ticks, work.in_vain = after, (*work.ticks, *ticks), set()
                    return True
            work.in_vain.add(goals)
        return False

    def _milestones(self, work: _Work) -> list[Goals]:
        """Of the operations that seem to lead to what is missing: goals that can be pursued, then preconditions."""
        values, goals = work.position.run.values, [goal.predicate for goal in work.position.goals]
        now: list[Goals] = []
        later: list[Goals] = []
        for name in self._operations.towards(values, goals, work.possible) or ():
            operation = self._automaton.operations[name]
            if holds(operation.precondition, values):
                now.append((Goal(name, operation.goal),))
            else:
                later.append((Goal(name, operation.precondition),))
        return now + later


def _walked(space: Space, position: Position, ticks: tuple[PlanTick, ...]) -> Position | None:
    """Where `ticks` lead, at most as far as the goals; None if that must not be."""
    here: Position | None = position
    for tick in ticks:
        moves: tuple[Move, ...] = (tick.effects, *tick.starts)
        for move in moves:
            if here is not None and here.goals:
                here = space.moved(here, move)
    return here
