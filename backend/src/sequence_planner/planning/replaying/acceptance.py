"""Whether a plan is one: step by step on the reference tick, and by everything that a task demands.

Whoever made the plan, nothing of it is taken on trust.
"""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from typing import ClassVar

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.immutable import Immutable
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plan import Plan, PlanTick
from sequence_planner.planning.replaying.reference_run import ReferenceRun, ReferenceTick


class Waypoint(Immutable):
    """Where a plan leads through: after step 3 of a tick, by its number, and so many of its starts."""

    tick: int
    starts: int
    run: ReferenceRun  # as it is there; only forks of it go on


class Course(Immutable):
    """An accepted plan and all that it leads through, in order."""

    plan: Plan
    way: tuple[Waypoint, ...]

    @cached_property
    def ends(self) -> tuple[tuple[State, Goals], ...]:
        """The states at the ends of the plan's ticks, each with the goals missing there."""
        starts = [len(tick.starts) for tick in self.plan.ticks]
        return tuple((point.run.values, point.run.goals) for point in self.way if point.starts == starts[point.tick])


class Acceptance:
    """Accepts plans of one automaton under one supervisor."""

    _last: ClassVar[tuple[Automaton, Supervisor, Acceptance] | None] = None

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._tick = ReferenceTick(automaton, supervisor)
        self._begun: tuple[Task, ReferenceRun] | None = None  # the last one, which others may begin from too
        self._accepted: tuple[Task, Course] | None = None

    @classmethod
    def of(cls, automaton: Automaton, supervisor: Supervisor) -> Acceptance:
        """The one shared by all in this process who plan for these: an engine's plan need not be replayed twice."""
        last = cls._last
        if last is None or last[0] is not automaton or last[1] is not supervisor:
            last = cls._last = automaton, supervisor, cls(automaton, supervisor)
        return last[2]

    def accepts(self, task: Task, plan: Plan) -> bool:
        """Whether the ticks of `plan`, exactly as they are written, are a run that the task asks for."""
        return self.course(task, plan) is not None

    def course(self, task: Task, plan: Plan) -> Course | None:
        """All that `plan` leads through; None if it is not accepted."""
        accepted = self._accepted
        if accepted is not None and accepted[0] is task and accepted[1].plan is plan:
            return accepted[1]
        course = self._replayed(task, plan)
        if course is not None:
            self._accepted = task, course
        return course

    def _replayed(self, task: Task, plan: Plan) -> Course | None:
        if not self._may_be(task, plan):
            return None
        run = self.begin(task)
        way: list[Waypoint] = []
        for number, tick in enumerate(plan.ticks):
            if not run.settle(tick.effects):
                return None
            way.append(Waypoint(number, 0, run.fork()))
            for starts, name in enumerate(tick.starts, start=1):
                if not run.start(name):
                    return None
                way.append(Waypoint(number, starts, run.fork()))
        return None if run.goals else Course(plan, tuple(way))

    def begin(self, task: Task) -> ReferenceRun:
        """A run from the state of the task, before its first tick."""
        if self._begun is None or self._begun[0] is not task:
            run = ReferenceRun(self._tick, task)
            run.look_ahead()
            self._begun = task, run
        return self._begun[1].fork()

    def begin_at(self, task: Task, run: ReferenceRun) -> None:
        """From now on runs of `task` begin where `run` is, which has led to its state and misses its goals."""
        self._begun = task, run

    def _may_be(self, task: Task, plan: Plan) -> bool:
        return len(plan.ticks) <= task.longest and all(self._counted_on(task, tick) for tick in plan.ticks)

    def _counted_on(self, task: Task, tick: PlanTick) -> bool:
        """Whether the circumstances allow that this happens and that this starts, each of it once."""
        effects = [self._tick.effects.get(name) for name in tick.effects]
        abilities = [self._automaton.abilities.get(name) for name in tick.starts]
        offline, bars = task.circumstances.offline, task.circumstances.bars
        return (
            all(effect and not effect.fault and effect.resource not in offline for effect in effects)
            and all(ability and not bars(ability) for ability in abilities)
            and max(Counter((*tick.effects, *tick.starts)).values(), default=1) == 1
        )
