"""What a plan leads to, looked through once for each plan: in which tick each step ends, which step makes another
possible, and which steps serve which operation.

A step waits for the one by which the last that its guards still miss comes about: by its start, its end, or what the
devices do while it runs. What supervisors and people keep back is not looked at: it is known as it happens.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence, Set

from sequence_planner.automaton.automaton import Automaton, target
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.core.immutable import Immutable
from sequence_planner.execution.plan_tracker import PlanCursor
from sequence_planner.language.syntax import Assignment, Expression
from sequence_planner.planning.problem import Plan, PlanTick
from sequence_planner.planning.recovery.timing import expected_seconds

# What a step, by its number, has changed.
Change = tuple[int, Collection[str]]


class Outlook(Immutable):
    """The things a plan says of time, counted in its ticks after `tick`, the one under way when it was looked through.

    `first` is the number of its first step; `waits` is how long each tick is waited for, in seconds, and `ends` the
    tick in which each step, by its number, is over. `after` is the step that makes another possible; `serves` are the
    first and the last step of what is done for each operation.
    """

    plan: Plan | None = None
    first: int = 0
    tick: int = 0
    waits: Mapping[int, float] = {}
    ends: Mapping[int, int] = {}
    after: Mapping[int, int] = {}
    serves: Mapping[str, tuple[int, int]] = {}

    def between(self, tick: int, later: int) -> float:
        """The seconds from one tick to a later one."""
        return sum(self.waits.get(each, 0.0) for each in range(tick + 1, later + 1))

    def steps_for(self, operation: str) -> frozenset[int]:
        """The steps that serve an operation: all from its first to its last but those that others wait for alone."""
        if operation not in self.serves:
            return frozenset()
        first, last = self.serves[operation]
        others = {step for other in self.serves if other != operation for step in self._waited_for(other)}
        return frozenset(range(first, last + 1)) - others | self._waited_for(operation)

    def _waited_for(self, operation: str) -> frozenset[int]:
        """The last step for an operation, and those by which it became possible, one by another."""
        first, last = self.serves[operation]
        found: list[int] = []
        step: int | None = last
        while step is not None and step >= first:
            found.append(step)
            step = self.after.get(step)
        return frozenset(found)


def simulate_plan(order: PlanCursor, run: CompiledRun, automaton: Automaton) -> Outlook:
    """Simulate what is left of the plan from where `run` stands; the run is changed by it."""
    plan = order.plan
    if plan is None:
        return Outlook()
    first = max((step.number for step in (*order.past, *order.ahead)), default=0) - len(plan.starts) + 1
    _, ticks = order.rest()
    taken = max((step.tick for step in order.past if step.number >= first), default=0)
    begin = len(plan.ticks) - len(ticks) if ticks else taken
    waits = {number: expected_seconds(automaton, [tick]) for number, tick in enumerate(plan.ticks, 1)}
    course = _Course(order, run, automaton)
    course.go(ticks, begin)
    return Outlook(plan, first, begin, waits, course.ends, course.after, course.serves())


class _Course:
    """The steps of `order` as they come about in `run`."""

    def __init__(self, order: PlanCursor, run: CompiledRun, automaton: Automaton) -> None:
        self.ends: dict[int, int] = {}
        self.after: dict[int, int] = {}
        self._run = run
        self._automaton = automaton
        self._effects = {effect.name: effect for effect in automaton.effects}
        self._ahead = list(order.ahead)
        self._under_way: dict[str, list[int]] = defaultdict(list)
        self._writer: dict[str, int] = {}  # of each variable that a step has written, the last
        self._ready: dict[str, int | None] = {}  # what may start, and the step that made it so
        self._reads: dict[str, frozenset[str]] = {}
        self._missing = frozenset(order.goals)
        self._reached: dict[str, int] = {}  # by operation, the last step until its goal
        self._last: int | None = None
        for step in order.running:
            self._under_way[step.ability].append(step.number)
            self._last = step.number
            self._wrote(step.number, automaton.abilities[step.ability].start_actions)

    def go(self, ticks: Sequence[PlanTick], begin: int) -> None:
        """Go through `ticks`, of which the first comes after tick `begin`."""
        self._settle(())
        self._start(len(self._ahead) - sum(len(tick.starts) for tick in ticks))
        for number, tick in enumerate(ticks, begin + 1):
            self._pass(tick, number)
            self._start(len(tick.starts))

    def serves(self) -> dict[str, tuple[int, int]]:
        """The first and the last step for each operation: what the last waits for, as far as no other is served by
        it.
        """
        taken: set[int] = set()
        found: dict[str, tuple[int, int]] = {}
        for name, last in self._reached.items():
            step, first = self.after.get(last), last
            while step is not None and step not in taken:
                taken.add(step)
                first, step = min(first, step), self.after.get(step)
            taken.add(last)
            found[name] = first, last
        return found

    def _start(self, count: int) -> None:
        for step in self._ahead[: max(count, 0)]:
            cause = self._ready.get(step.ability)
            if cause is not None:
                self.after[step.number] = cause
            self._run.start(step.ability)
            self._under_way[step.ability].append(step.number)
            self._last = step.number
            self._settle([self._wrote(step.number, self._automaton.abilities[step.ability].start_actions)])
        del self._ahead[: max(count, 0)]

    def _pass(self, tick: PlanTick, number: int) -> None:
        run, abilities = self._run, self._automaton.abilities
        sensed = {name: run.effect(name) or {} for name in tick.effects}
        run.sense({name: value for writes in sensed.values() for name, value in writes.items()})
        changes: list[Change] = []
        finished = run.finish().finished
        for ability in finished:
            over = self._under_way.get(ability, [])
            self.ends |= dict.fromkeys(over, number)
            changes += [self._wrote(step, abilities[ability].finish_actions) for step in over]
            self._last = max(over, default=self._last)
        for name, writes in sensed.items():
            if writes and (cause := self._cause(name)) is not None:
                changes.append((cause, writes))
        for ability in finished:
            self._under_way.pop(ability, None)
        run.synchronise()
        self._settle(sorted(changes, key=lambda change: change[0], reverse=True))

    def _wrote(self, step: int, actions: Iterable[Assignment]) -> Change:
        """Take note of what a step has written."""
        written = [target(action) for action in actions]
        self._writer |= dict.fromkeys(written, step)
        return step, written

    def _cause(self, name: str) -> int | None:
        """The step by which an effect comes about: of those that run at its device, the last to write what it reads."""
        effect = self._effects[name]
        abilities = self._automaton.abilities
        read = self._read(f"effect {name}", lambda: read_variables(self._automaton, (effect.guard,)))
        wrote = {self._writer[each] for each in read if each in self._writer}
        running = {
            step
            for ability, steps in self._under_way.items()
            if abilities[ability].resource == effect.resource
            for step in steps
        }
        return max(wrote & running or running or wrote, default=None)

    def _settle(self, changes: Sequence[Change]) -> None:
        """Take note of what has become possible, and of what is reached, by `changes`."""
        startable = self._run.startable()
        for ability in dict.fromkeys(step.ability for step in self._ahead):
            if ability not in startable:
                self._ready.pop(ability, None)
            elif ability not in self._ready:
                self._ready[ability] = self._made_possible(ability, changes)
        reached = self._missing - self._run.update_operations(self._missing)
        for name in sorted(reached):
            operation = self._automaton.operations.get(name)
            goal = (operation.goal,) if operation else ()
            by = self._by(f"goal of {name}", goal, changes)
            if (step := self._last if by is None else by) is not None:
                self._reached[name] = step
        self._missing -= reached

    def _made_possible(self, ability: str, changes: Sequence[Change]) -> int | None:
        declared = self._automaton.abilities[ability]
        return self._by(ability, (declared.enabled, declared.start_guard), changes)

    def _by(self, name: str, conditions: tuple[Expression, ...], changes: Sequence[Change]) -> int | None:
        """The step that has changed last what `conditions` read."""
        read = self._read(name, lambda: read_variables(self._automaton, conditions))
        return next((step for step, written in changes if not read.isdisjoint(written)), None)

    def _read(self, name: str, find: Callable[[], frozenset[str]]) -> Set[str]:
        if name not in self._reads:
            self._reads[name] = find()
        return self._reads[name]
