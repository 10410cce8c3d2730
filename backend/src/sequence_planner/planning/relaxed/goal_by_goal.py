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
from sequence_planner.immutable import replace
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan import Contract, Plan, PlanTick
from sequence_planner.planning.relaxed.causal_order import CausalOrder
from sequence_planner.planning.relaxed.projection import Projection
from sequence_planner.planning.replaying.acceptance import Acceptance

_MOST_SHARED = 0.25  # of the variables that a goal's relaxed plan writes, those that another's writes too
_LONGER = 1.5  # than the longest of its parts a plan may be


class _Work:
    """What has been done of a task, whose goals are planned for in their order: the plans up to now."""

    def __init__(self, task: Task, goals: Goals, acceptance: Acceptance, order: CausalOrder) -> None:
        self.task = task
        self.order = order
        self.run = acceptance.begin(replace(task, goals=goals))
        self.longest = 0  # ticks of one of the plans
        self.next = replace(task, goals=goals[:1])


class GoalByGoal:
    """Fast plans for one automaton under one supervisor; asked again, it goes on where the budget was spent."""

    name = "goal by goal"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._work: _Work | None = None

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan for several goals that are nearly independent; nothing for others, or by another contract."""
        if task.contract is not Contract.FAST or len(task.goals) < 2:
            return Finding()
        if self._work is None or self._work.task is not task:
            goals = self._ordered(task)
            if goals is None:
                return Finding()
            self._work = _Work(task, goals, self._acceptance, CausalOrder(self._automaton))
        work = self._work
        while work.run.goals:
            plan = self._projection.solve(work.next, budget).plan
            if plan is None and budget.spent:
                return Finding()
            if plan is None or not self._taken(work, plan):
                self._work = None
                return Finding()
        self._work = None
        return Finding(self._together(work))

    @cached_property
    def _projection(self) -> Projection:
        return Projection(self._automaton, self._supervisor)

    @cached_property
    def _acceptance(self) -> Acceptance:
        return Acceptance.of(self._automaton, self._supervisor)

    def _ordered(self, task: Task) -> Goals | None:
        """The goals, first those that seem to take longest; None if they have too much in common, as far as is seen."""
        written: list[frozenset[str]] = []
        layers: dict[str, int] = {}
        for goal in task.goals:
            outline = self._projection.outline(replace(task, goals=(goal,)))
            if outline is None:
                return None
            written.append(outline[0])
            layers[goal.name] = outline[1]
        times = Counter(name for each in written for name in each)
        if any(sum(times[name] > 1 for name in each) > _MOST_SHARED * len(each) for each in written):
            return None
        return tuple(sorted(task.goals, key=lambda goal: -layers[goal.name]))

    def _taken(self, work: _Work, plan: Plan) -> bool:
        """Go on with `plan`, noting what waits for what; whether that can be with all goals in mind."""
        run, effects = work.run, {effect.name: effect for effect in self._automaton.effects}
        for tick in plan.ticks:
            before = run.values.copy()
            if not run.settle(tick.effects):
                return False
            for name in tick.effects:
                work.order.happens(effects[name], before)
            for name in tick.starts if run.goals else ():
                before = run.values.copy()
                if not run.start(name):
                    return False
                work.order.starts(self._automaton.abilities[name], before)
        work.longest = max(work.longest, len(plan.ticks))
        work.next = replace(work.task, state=run.values.copy(), goals=run.goals[:1])
        return True

    def _together(self, work: _Work) -> Plan | None:
        """The plan in which every event comes as soon as it may; None if it is too long, or none."""
        events, task = work.order.events, work.task
        run, pending, done = self._acceptance.begin(task), list(range(len(events))), set[int]()
        run.look_ahead()
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
