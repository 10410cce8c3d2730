"""The engine that plans for several goals one after the other, and then lets the plans run beside each other.

Each plan begins where the last one has ended, so that together they are one, however much they share. What need not
wait comes as soon as it can: every event waits only for what it relies on, and for what relied on what it overwrites.
Goals that have little in common are reached as soon so as if they were planned together, which would take far longer to
do; others are left to engines that do that.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import cached_property

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.collection import collection_put_off
from sequence_planner.immutable import replace
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.plan import Contract, Plan, PlanTick
from sequence_planner.planning.relaxed.causal_order import CausalOrder
from sequence_planner.planning.relaxed.projection import Outline, Projection
from sequence_planner.planning.replaying.acceptance import Acceptance
from sequence_planner.planning.replaying.reference_run import ReferenceRun

_MOST_SHARED = 0.25  # of the variables that a goal's relaxed plan writes, those that another's writes too
_LONGER = 1.5  # than the longest of its parts a plan may be


class _Work:
    """What has been done of a task, from where its runs begin: the plans up to now for its goals, in their order."""

    def __init__(self, first: Outline, task: Task, goals: Goals, begun: ReferenceRun, order: CausalOrder) -> None:
        self.task = task
        self.goals = goals  # still missing
        self.begun = begun
        self.order = order
        self.longest = 0  # ticks of one of the plans
        self.next = first.task


class GoalByGoal:
    """Fast plans for one automaton under one supervisor; asked again, it goes on where the budget was spent."""

    name = "goal by goal"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._work: _Work | None = None

    @collection_put_off()
    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan for several goals that are nearly independent; nothing for others, or by another contract."""
        if task.contract is not Contract.FAST or len(task.goals) < 2:
            return Finding()
        if self._work is None or self._work.task is not task:
            self._work = self._begun(task)
        work = self._work
        while work is not None and work.goals:
            plan = self._projection.solve(work.next, budget).plan
            if plan is None and budget.spent:
                return Finding()
            if plan is None or not self._taken(work, plan):
                work = None
        self._work = None
        return Finding(None if work is None else self._together(work))

    @cached_property
    def _projection(self) -> Projection:
        return Projection(self._automaton, self._supervisor)

    @cached_property
    def _acceptance(self) -> Acceptance:
        return Acceptance.of(self._automaton, self._supervisor)

    def _begun(self, task: Task) -> _Work | None:
        """Nothing done yet, goals that seem to take longest first; None if they seem to have too much in common."""
        outlines: list[Outline] = []
        for goal in task.goals:
            outline = self._projection.outline(replace(task, goals=(goal,)))
            if outline is None:
                return None
            outlines.append(outline)
        times = Counter(name for outline in outlines for name in outline.written)
        if any(sum(times[name] > 1 for name in each.written) > _MOST_SHARED * len(each.written) for each in outlines):
            return None
        outlines.sort(key=lambda outline: -outline.layers)
        self._projection.take_up(outlines[0])
        goals = tuple(goal for outline in outlines for goal in outline.task.goals)
        run = self._acceptance.begin(task)
        self._acceptance.begin_at(outlines[0].task, run.fork(outlines[0].task.goals))
        return _Work(outlines[0], task, goals, run, CausalOrder(self._automaton))

    def _taken(self, work: _Work, plan: Plan) -> bool:
        """Go on with `plan`, noting what waits for what; whether that can be with all goals in mind."""
        course = self._acceptance.course(work.next, plan)
        if course is None:
            return False
        effects = {effect.name: effect for effect in self._automaton.effects}
        before, run = work.next.state, work.begun
        for point in course.way:
            tick, run = plan.ticks[point.tick], point.run
            if point.starts == 0:
                for name in tick.effects:
                    work.order.happens(effects[name], before)
                left = settled(work.goals, run.values)
            else:
                work.order.starts(self._automaton.abilities[tick.starts[point.starts - 1]], before)
                left = moved(work.goals, run.values)
            if left is None:
                return False
            before, work.goals = run.values, left
            if not left:
                break
        work.longest = max(work.longest, len(plan.ticks))
        work.next = replace(work.task, state=before, goals=work.goals[:1])
        self._acceptance.begin_at(work.next, run.fork(work.next.goals))
        return True

    def _together(self, work: _Work) -> Plan | None:
        """The plan in which every event comes as soon as it may; None if it is too long, or none."""
        events, task = work.order.events, work.task
        run, pending, done = work.begun.fork(), list(range(len(events))), set[int]()
        self._acceptance.begin_at(task, work.begun)
        ticks: list[PlanTick] = []
        while run.goals:
            if len(ticks) >= min(_LONGER * work.longest, task.longest):
                return None
            ready = {
                events[each].name: each for each in pending if not events[each].start and events[each].after <= done
            }
            effects = run.happening(ready)
            if not run.settle(effects):
                return None
            done.update(ready[name] for name in effects)
            starts: dict[str, None] = {}
            for number in pending if run.goals else ():
                event = events[number]
                if event.start and event.after <= done and event.name not in starts and run.may_start(event.name):
                    after = run.fork()
                    if after.start(event.name):
                        run = after
                        done.add(number)
                        starts[event.name] = None
            pending = _left(pending, done)
            ticks.append(PlanTick(effects, tuple(starts)))
        return Plan(tuple(ticks), minimal_ticks=False, minimal_starts=False)


def _left(pending: Iterable[int], done: set[int]) -> list[int]:
    return [number for number in pending if number not in done]
