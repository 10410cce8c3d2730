"""Plan validation on the reference tick, earliest start times, and activity periods of abilities."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from functools import cached_property, lru_cache
from typing import ClassVar

from sequence_planner.automaton.automaton import Automaton, Flag, State, reads, target
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    Writes,
    apply_effects,
    conflicts_of,
    effect_writes,
    finish,
    start,
    start_guard_holds,
    synchronise,
    writes,
)
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Plan, PlanTick
from sequence_planner.planning.sat.flag_dependencies import FollowingFlags
from sequence_planner.process.budget import Budget

# A run of the reference tick, taken on from step to step in place.
#
# Predicates and actions are evaluated as in `automaton.tick`, but no more of them than a step can affect: flags and
# finishes whose variables have not changed stay what they are.

_KEPT = 1000  # sets of variables that have changed


class ReferenceTick:
    """The things that all runs of one automaton under one supervisor have in common."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._flags = FollowingFlags(automaton)
        self.automaton = automaton
        self.safe = None if supervisor.safe.everything else supervisor.safe
        self.following = lru_cache(_KEPT)(self._following)  # the flags that can change when the variables have
        self.effects = {effect.name: effect for effect in automaton.effects}

    def _following(self, changed: frozenset[str]) -> tuple[Flag, ...]:
        return tuple(self._flags.flags(changed))

    @cached_property
    def effect_readers(self) -> Mapping[str, tuple[str, ...]]:
        """By variable or flag, the effects, faults apart, whose guard or actions read it or whose actions write it."""
        readers: dict[str, dict[str, None]] = defaultdict(dict)
        for effect in self.automaton.effects:
            acted = (name for action in effect.actions for name in (target(action), *reads(action)))
            for name in () if effect.fault else (*variables(effect.guard), *acted):
                readers[name][effect.name] = None
        return {name: tuple(names) for name, names in readers.items()}


class ReferenceRun:
    """The state after step 3 or a start, and the goals of a task that are missing there.

    Once a step has failed, the run is of no use any more.
    """

    def __init__(self, tick: ReferenceTick, task: PlanningTask) -> None:
        self.values = dict(task.state)
        self.goals = task.goals
        self._tick = tick
        self._circumstances = task.circumstances
        self._published: State = task.state
        self._due: dict[str, Writes] = {}  # what each ability whose finish guard holds writes
        # To be looked at in the next step 2. The flags of the state to begin with may still be those of an earlier
        # tick, so at first that is everything.
        self._finishers = set(tick.automaton.abilities)
        self._synchronised = False
        self._possible: dict[str, Writes] = {}  # what each effect that would change something writes
        self._effects: set[str] | None = None  # to be looked at; None before somebody has asked

    def look_ahead(self) -> None:
        """Evaluate everything once, so that forks that begin here need not, each for itself."""
        before = self.values
        self.values = before.copy()
        self._synchronise(set())
        self._synchronised = self.values == before
        self.values = before
        self._finished()

    def fork(self, goals: Goals | None = None) -> ReferenceRun:
        """A run of its own that goes on from here, towards other `goals` if there are any."""
        fork = copy(self)
        if goals is not None:
            fork.goals = goals
        fork.values, fork._due, fork._finishers = self.values.copy(), self._due.copy(), self._finishers.copy()
        fork._possible = self._possible.copy()
        fork._effects = None if self._effects is None else self._effects.copy()
        return fork

    @property
    def key(self) -> object:
        """Equal where the same can follow."""
        values, published = self.values, self._published
        unseen = tuple(name for name in self._tick.automaton.outputs if values[name] != published[name])
        seen = tuple(published[name] for name in unseen)
        return tuple(values.values()), tuple((goal.name, goal.at) for goal in self.goals), unseen, seen

    def everything(self, first: Iterable[str]) -> tuple[str, ...]:
        """A largest set of effects that can happen together and change something, those of `first` before others."""
        possible = self._changing()
        chosen: list[str] = []
        together: Writes = {}
        for name in dict.fromkeys((*(name for name in first if name in possible), *sorted(possible))):
            written = possible[name]
            if all(together.get(each, value) == value for each, value in written.items()):
                chosen.append(name)
                together |= written
        return tuple(chosen)

    def happening(self, effects: Iterable[str]) -> tuple[str, ...]:
        """Those of `effects` that can happen and would change something, each once."""
        return tuple(name for name in dict.fromkeys(effects) if self._changes(name) is not None)

    def may_start(self, name: str) -> bool:
        """Return whether its guards hold; the supervisor and what it would revert may still keep it."""
        return start_guard_holds(self._tick.automaton.abilities[name], self.values)

    def has_started(self, name: str) -> bool:
        """Return whether what its start writes is so already."""
        written = writes(self._tick.automaton.abilities[name].start_actions, self.values)
        return written is not None and all(self.values[each] == value for each, value in written.items())

    def take(self, effects: Iterable[str], starts: Iterable[str]) -> bool:
        """One tick: whether all of it can be, and may be."""
        return self.settle(effects) and all(map(self.start, starts))

    def settle(self, effects: Iterable[str]) -> bool:
        """The next tick up to step 3, `effects` happening in its sense; whether that can be, and may be."""
        self._published = self.values.copy()
        together: Writes = {}
        for name in effects:
            written = effect_writes(self._tick.effects[name], self.values)
            if written is None or any(together.get(each, value) != value for each, value in written.items()):
                return False
            together |= written
        changed = self._write(together)
        changed |= self._write(self._finished())
        self._synchronise(changed)
        goals = settled(self.goals, self.values)
        if goals is None or not self._allowed():
            return False
        self.goals = goals
        return True

    def start(self, name: str) -> bool:
        """Step 5, one start, which must not set back an output that nobody has seen yet; whether it may be taken."""
        values, automaton = self.values, self._tick.automaton
        written = writes(automaton.abilities[name].start_actions, values) if self.may_start(name) else None
        if written is None or not self._is_safe():
            return False
        published = self._published
        outputs = automaton.outputs.intersection(written)
        if any(values[output] != published[output] and written[output] == published[output] for output in outputs):
            return False
        self._synchronise(self._write(written))
        goals = moved(self.goals, values)
        if goals is None or not self._is_safe() or not self._allowed():
            return False
        self.goals = goals
        return True

    def _changing(self) -> Mapping[str, Writes]:
        """The effects that are counted on and would change something, with all that each writes."""
        for name in self._tick.effects if self._effects is None else self._effects:
            written = self._changes(name)
            if written is None:
                self._possible.pop(name, None)
            else:
                self._possible[name] = written
        self._effects = set()
        return self._possible

    def _changes(self, name: str) -> Writes | None:
        """All that an effect writes; None if it is not counted on, cannot happen, or changes nothing."""
        effect = self._tick.effects[name]
        if effect.fault or effect.resource in self._circumstances.offline:
            return None
        written = effect_writes(effect, self.values)
        changes = written is not None and any(self.values[each] != value for each, value in written.items())
        return written if changes else None

    def _finished(self) -> Writes:
        """Return what step 2 writes: of two abilities that would write different values neither does."""
        for name in self._finishers:
            ability = self._tick.automaton.abilities[name]
            self._due.pop(name, None)
            if ability.finish_guard is not None and holds(ability.finish_guard, self.values):
                written = writes(ability.finish_actions, self.values)
                if written is not None:
                    self._due[name] = written
        self._finishers.clear()
        together: Writes = {}
        due = self._due.values()
        if all(together.setdefault(name, value) == value for written in due for name, value in written.items()):
            return together
        refused = {name for one, other, _ in conflicts_of(self._due) for name in (one, other)}
        applied = (written for name, written in self._due.items() if name not in refused)
        return {name: value for written in applied for name, value in written.items()}

    def _write(self, written: Writes) -> set[str]:
        """The variables that have changed."""
        changed = {name for name, value in written.items() if self.values[name] != value}
        for name in changed:
            self._set(name, written[name])
        return changed

    def _synchronise(self, changed: set[str]) -> None:
        for flag in self._tick.following(frozenset(changed)) if self._synchronised else self._tick.automaton.flags:
            truth = evaluate(flag.predicate, self.values)
            if truth is not None and truth is not self.values[flag.name]:
                self._set(flag.name, truth)
        self._synchronised = True

    def _set(self, name: str, value: Value) -> None:
        self.values[name] = value
        self._finishers.update(self._tick.automaton.finish_readers.get(name, ()))
        if self._effects is not None:
            self._effects.update(self._tick.effect_readers.get(name, ()))

    def _allowed(self) -> bool:
        return all(evaluate(condition, self.values) is False for condition in self._circumstances.avoid)

    def _is_safe(self) -> bool:
        return self._tick.safe is None or self._tick.safe.includes(self.values)


# Whether a plan is one: step by step on the reference tick, and by everything that a task demands.
#
# Whoever made the plan, nothing of it is taken on trust.


class Waypoint(Immutable):
    """A place that a plan leads through: after step 3 of a tick, by its number, and so many of its starts."""

    tick: int
    starts: int
    run: ReferenceRun  # as it is there; only forks of it go on


class AcceptedRun(Immutable):
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
        self._begun: tuple[PlanningTask, ReferenceRun] | None = None  # the last one, which others may begin from too
        self._accepted: tuple[PlanningTask, AcceptedRun] | None = None

    @classmethod
    def of(cls, automaton: Automaton, supervisor: Supervisor) -> Acceptance:
        """The one shared by all in this process who plan for these: an engine's plan need not be replayed twice."""
        last = cls._last
        if last is None or last[0] is not automaton or last[1] is not supervisor:
            last = cls._last = automaton, supervisor, cls(automaton, supervisor)
        return last[2]

    def accepts(self, task: PlanningTask, plan: Plan) -> bool:
        """Return whether the ticks of `plan`, exactly as they are written, are a run that the task asks for."""
        return self.course(task, plan) is not None

    def course(self, task: PlanningTask, plan: Plan) -> AcceptedRun | None:
        """All that `plan` leads through; None if it is not accepted."""
        accepted = self._accepted
        if accepted is not None and accepted[0] is task and accepted[1].plan is plan:
            return accepted[1]
        course = self._replayed(task, plan)
        if course is not None:
            self._accepted = task, course
        return course

    def _replayed(self, task: PlanningTask, plan: Plan) -> AcceptedRun | None:
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
        return None if run.goals else AcceptedRun(plan, tuple(way))

    def begin(self, task: PlanningTask) -> ReferenceRun:
        """A run from the state of the task, before its first tick."""
        if self._begun is None or self._begun[0] is not task:
            run = ReferenceRun(self._tick, task)
            run.look_ahead()
            self._begun = task, run
        return self._begun[1].fork()

    def begin_at(self, task: PlanningTask, run: ReferenceRun) -> None:
        """From now on runs of `task` begin where `run` is, which has led to its state and misses its goals."""
        self._begun = task, run

    def _may_be(self, task: PlanningTask, plan: Plan) -> bool:
        return len(plan.ticks) <= task.longest and all(self._counted_on(task, tick) for tick in plan.ticks)

    def _counted_on(self, task: PlanningTask, tick: PlanTick) -> bool:
        """Return whether the circumstances allow that this happens and that this starts, each of it once."""
        effects = [self._tick.effects.get(name) for name in tick.effects]
        abilities = [self._automaton.abilities.get(name) for name in tick.starts]
        offline, bars = task.circumstances.offline, task.circumstances.bars
        return (
            all(effect and not effect.fault and effect.resource not in offline for effect in effects)
            and all(ability and not bars(ability) for ability in abilities)
            and max(Counter((*tick.effects, *tick.starts)).values(), default=1) == 1
        )


# Plans with every start as early as it can be, where all that can happen happens at once.
#
# A solver has no reason to prefer one of two plans that are as short as each other, and often lets devices tarry. What
# is carried out is closer to the plan, and seldom breaks it, if nothing in it waits without need.

_MOST_NODES = 400  # then the plan stays as it is


class _TighteningNode(Immutable):
    """A run, the starts that are still to come, and the ticks so far."""

    run: ReferenceRun
    order: tuple[str, ...]
    ticks: tuple[PlanTick, ...]
    before: _TighteningNode | None = None


_Move = tuple[_TighteningNode, str | None]  # one of the starts that are still to come, or a wait


def tightened(acceptance: Acceptance, task: PlanningTask, plan: Plan, budget: Budget) -> AcceptedRun | None:
    """`plan`, which is accepted, with its starts as early as can be, taken step by step on the reference tick.

    None if that takes more ticks, or longer than the budget.
    """
    helpful = tuple(dict.fromkeys(effect for tick in plan.ticks for effect in tick.effects))
    reached: dict[object, int] = {}
    pending: list[_Move] = [(_TighteningNode(acceptance.begin(task), tuple(name for _, name in plan.starts), ()), None)]
    for _ in range(_MOST_NODES):
        node = _next(pending, helpful)
        if node is None or budget.spent:
            return None
        if not node.run.goals and not node.order:
            return _course(replace(plan, ticks=node.ticks), node)
        key = (node.run.key, node.order, node.ticks[-1].starts)
        if reached.get(key, len(node.ticks) + 1) <= len(node.ticks):
            continue
        reached[key] = len(node.ticks)
        if len(node.ticks) < len(plan.ticks):
            pending.append((node, None))
        pending += ((node, name) for name in reversed(dict.fromkeys(node.order)))  # the earliest is tried first
    return None


def _next(pending: list[_Move], helpful: Iterable[str]) -> _TighteningNode | None:
    """Return where the next move leads that can be taken."""
    while pending:
        node, name = pending.pop()
        after = _waited(node, helpful) if name is None else _started(node, name)
        if after is not None:
            return after
    return None


def _waited(node: _TighteningNode, helpful: Iterable[str]) -> _TighteningNode | None:
    effects = node.run.everything(helpful)
    run = node.run.fork()
    return _TighteningNode(run, node.order, (*node.ticks, PlanTick(effects, ())), node) if run.settle(effects) else None


def _started(node: _TighteningNode, name: str) -> _TighteningNode | None:
    last = node.ticks[-1]
    if name in last.starts or not node.run.may_start(name):
        return None
    run = node.run.fork()
    if not run.start(name):
        return None
    place = node.order.index(name)
    order = node.order[:place] + node.order[place + 1 :]
    return _TighteningNode(run, order, (*node.ticks[:-1], PlanTick(last.effects, (*last.starts, name))), node)


def _course(plan: Plan, last: _TighteningNode) -> AcceptedRun:
    way: list[Waypoint] = []
    node: _TighteningNode | None = last
    while node is not None and node.ticks:
        way.append(Waypoint(len(node.ticks) - 1, len(node.ticks[-1].starts), node.run))
        node = node.before
    return AcceptedRun(plan, tuple(reversed(way)))


# When the abilities of a plan run: from their starts to the ticks in which they finish.


class Activity(Immutable):
    """One run of an ability, in ticks counted from 1; `finished` is None when the plan ends before."""

    ability: str
    started: int
    finished: int | None


def timeline(automaton: Automaton, state: State, ticks: Sequence[PlanTick]) -> tuple[Activity, ...]:
    """The runs of abilities in a plan from `state`, in the order of their starts.

    One without a finish guard is done at its start. Raises ValueError when the plan cannot be taken as it is written.
    """
    effects = {effect.name: effect for effect in automaton.effects}
    activities: list[Activity] = []
    running: dict[str, int] = {}
    for number, tick in enumerate(ticks, start=1):
        sensed = apply_effects(state, [effects[name] for name in tick.effects])
        if sensed is None:
            raise ValueError(f"what is expected in tick {number} cannot happen")
        finishing = finish(automaton, sensed)
        for name in finishing.finished:
            if (index := running.pop(name, None)) is not None:
                activities[index] = Activity(name, activities[index].started, number)
        state = synchronise(automaton, finishing.state)
        for name in tick.starts:
            ability = automaton.abilities[name]
            after = start(automaton, state, ability)
            if after is None:
                raise ValueError(f"{name} cannot start in tick {number}")
            state = after
            at_once = ability.finish_guard is None
            if not at_once:
                running[name] = len(activities)
            activities.append(Activity(name, number, number if at_once else None))
    return tuple(activities)
