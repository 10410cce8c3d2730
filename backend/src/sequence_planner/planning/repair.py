"""Plans repaired: where a run has left the way of a plan, one tick that leads back to it.

Starts have been held back, or a device has been slow or fast. Mostly what was missed still fits into the next tick, or
into one tick more; from there the rest of the plan is known, as it was replayed. A state that the way itself leads
through before all starts of a tick is one tick from a state whose fewest ticks and starts are known, and so are its own
if it needs one tick less and only the starts that were left (Bellman 1957).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from functools import cached_property
from heapq import nsmallest
from operator import ne

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.types import Value
from sequence_planner.planning.plan_cache import PlanCache
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Contract, Plan, PlanTick
from sequence_planner.planning.validation.acceptance import Acceptance, AcceptedRun, ReferenceRun, Waypoint

NAME = "repair"  # as an engine

_MOST_PLANS = 4
_NEAREST = 3  # waypoints that are tried
_MOST_LATE = 2  # ticks that a repaired plan may have more than what was left of the plan

_Values = tuple[Value | None, ...]


class _Way(Immutable):
    """An accepted plan and all that it leads through; what is looked for in it is put in order when it is needed."""

    task: PlanningTask
    course: AcceptedRun
    names: tuple[str, ...]  # of all variables and flags

    @cached_property
    def by_values(self) -> dict[_Values, Waypoint]:
        """The waypoints by all values there, of equal ones that with the most starts to come."""
        return {_values(point.run.values, self.names): point for point in reversed(self.course.way)}


class Repair:
    """Repairs the plans that `recollection` has the rests of, for one automaton under one supervisor."""

    def __init__(self, automaton: Automaton, acceptance: Acceptance, recollection: PlanCache) -> None:
        self._variables = tuple(automaton.variables)
        self._names = tuple(automaton.types)
        self._acceptance = acceptance
        self._recollection = recollection
        self._ways: deque[_Way] = deque(maxlen=_MOST_PLANS)  # the last one first

    def keep(self, task: PlanningTask, course: AcceptedRun) -> None:
        """Note an accepted plan."""
        for way in tuple(self._ways):
            if way.task is task:
                self._ways.remove(way)
        self._ways.appendleft(_Way(task, course, self._names))

    def finding(self, task: PlanningTask) -> Finding | None:
        """A repaired plan, taken step by step on the reference tick up to a state from which the rest is known.

        By the minimal contract only if it is proven minimal. None if there is none.
        """
        ways = [way for way in self._ways if way.task.circumstances == task.circumstances]
        values = _values(task.state, self._names)
        for way in ways:
            point = way.by_values.get(values)
            if point is not None and point.run.goals == task.goals:
                left = way.course.plan.ticks[point.tick].starts[point.starts :]
                place = _Place(way.course.plan, point.tick, left)
                found = self._led(task, place, point.run)
                return None if found is None else _judged(task, place, found)
        ways = [way for way in ways if _asked(way.task) >= _asked(task)]
        if ways and task.contract is Contract.FAST:
            begin = self._acceptance.begin(task)
            for place in self._nearest(ways, begin):
                found = self._led_slowly(task, place, begin)
                if found is not None and not any(_needless(found, begin, tick) for tick in (0, 1)):
                    return Finding(found)
        return None

    def _nearest(self, ways: Iterable[_Way], begin: ReferenceRun) -> Iterator[_Place]:
        """Yield where the fewest variables differ in value from where a run begins, with what it has not started
        there.
        """
        values = _values(begin.values, self._variables)

        def different(point: tuple[Plan, Waypoint]) -> int:
            return sum(map(ne, values, _values(point[1].run.values, self._variables)))

        points = ((way.course.plan, point) for way in ways for point in way.course.way)
        seen: list[tuple[Plan, int]] = []
        for plan, point in nsmallest(_NEAREST, points, key=different):
            if (plan, point.tick) not in seen:
                seen.append((plan, point.tick))
                starts = plan.ticks[point.tick].starts
                yield _Place(plan, point.tick, tuple(name for name in starts if not begin.has_started(name)))

    def _led(self, task: PlanningTask, place: _Place, begin: ReferenceRun, taken: int = 0) -> Plan | None:
        """A plan whose first tick leads from `begin`, which is at or near `place`, to where its rest is known.

        So many ticks have been `taken` before.
        """
        most = min(place.rest + _MOST_LATE, task.longest) - taken
        for tick in place.leading(begin) if most > 0 else ():
            run = begin.fork()
            if not run.settle(tick.effects):
                continue
            if not run.goals:
                return Plan((PlanTick(tick.effects, ()),), minimal_ticks=not taken, minimal_starts=not taken)
            if all(map(run.start, tick.starts)):
                rest = self._recollection.plan(replace(task, state=run.values, goals=run.goals, longest=most - 1))
                if rest is not None:
                    return Plan((tick, *rest.ticks), minimal_ticks=False, minimal_starts=False)
        return None

    def _led_slowly(self, task: PlanningTask, place: _Place, begin: ReferenceRun) -> Plan | None:
        """The same, or, if one tick does not do, with one before it for what can be of what was missed."""
        plan = self._led(task, place, begin)
        if plan is not None:
            return plan
        run, effects = begin.fork(), begin.happening(place.late.effects)
        if not run.settle(effects) or not run.goals:
            return None
        started: list[str] = []
        for name in place.left:
            after = run.fork()
            if after.start(name):
                run = after
                started.append(name)
        left = tuple(name for name in place.left if name not in started)
        plan = self._led(task, replace(place, left=left), run, taken=1)
        return None if plan is None else replace(plan, ticks=(PlanTick(effects, tuple(started)), *plan.ticks))


class _Place(Immutable):
    """Within a tick of a plan, by its number: some of its starts, and perhaps effects, are left to come."""

    plan: Plan
    tick: int
    left: tuple[str, ...]

    @property
    def late(self) -> PlanTick:
        """The tick."""
        return self.plan.ticks[self.tick]

    @property
    def rest(self) -> int:
        """The number of ticks that come after it."""
        return len(self.plan.ticks) - 1 - self.tick

    def leading(self, begin: ReferenceRun) -> Iterator[PlanTick]:
        """Yield what could lead from `begin` to the way: what is left together with the next tick, or before it."""
        for tick in self.plan.ticks[self.tick + 1 : self.tick + 2]:
            if not set(self.left).intersection(tick.starts):  # an ability starts once in a tick
                yield PlanTick(begin.happening((*self.late.effects, *tick.effects)), self.left + tick.starts)
        yield PlanTick(begin.happening(self.late.effects), self.left)


def _judged(task: PlanningTask, place: _Place, plan: Plan) -> Finding | None:
    """Return what is proven of a plan from a place on the way itself; None if that is not enough."""
    if plan.minimal_starts:
        return Finding(plan, searched=len(plan.ticks))
    starts = len(place.left) + sum(len(tick.starts) for tick in place.plan.ticks[place.tick + 1 :])
    ticks_proven = place.plan.minimal_ticks and len(plan.ticks) == place.rest
    starts_proven = ticks_proven and place.plan.minimal_starts and len(plan.starts) == starts
    if task.contract is Contract.MINIMAL and not starts_proven:
        return None
    judged = replace(plan, minimal_ticks=ticks_proven, minimal_starts=starts_proven)
    return Finding(judged, searched=place.rest if ticks_proven else 0)


def _needless(plan: Plan, begin: ReferenceRun, number: int) -> bool:
    """Return whether a start of a tick, by its number, can be left out of `plan`, with all that cannot happen without
    it.

    Of the rest of a plan, as it is remembered, all starts are needed. Those that lead to it need not be: what they
    bring about may have happened already, or be no longer asked for by a formula that has come further.
    """
    ticks = plan.ticks[number : number + 1]
    return any(_reaches(plan, begin, number, index) for tick in ticks for index in range(len(tick.starts)))


def _reaches(plan: Plan, begin: ReferenceRun, number: int, left_out: int) -> bool:
    """Return whether `plan` reaches its goals without a start, by its tick and place there, less what then cannot
    happen.
    """
    run = begin.fork()
    for tick_number, tick in enumerate(plan.ticks):
        if not run.settle(run.happening(tick.effects)):
            return False
        for index, name in enumerate(tick.starts if run.goals else ()):
            if (tick_number, index) != (number, left_out) and run.may_start(name):
                after = run.fork()
                run = after if after.start(name) else run
        if not run.goals:
            return True
    return False


def _asked(task: PlanningTask) -> frozenset[object]:
    return frozenset((goal.name, goal.predicate, goal.local) for goal in task.goals)


def _values(state: State, names: Iterable[str]) -> _Values:
    return tuple(map(state.__getitem__, names))
