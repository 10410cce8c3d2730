"""Plan shortening: action elimination, A* for fewest starts (h_max), and fewest ticks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from heapq import heappop, heappush
from itertools import count

from sequence_planner.automaton.automaton import Automaton, State, reads
from sequence_planner.automaton.compiler import CompiledTick, Function, closure
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import writes
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import TRUE, Assignment, conjunction, variables
from sequence_planner.language.types import Value
from sequence_planner.planning.heuristic.relaxed_task import Estimator, RelaxedTask, RuleKind
from sequence_planner.planning.heuristic.space import Interference, RunPosition, Space
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import PlanTick, one_by_one, starts_of
from sequence_planner.process.budget import Budget

# Needless starts of long plans, where nothing happens by itself: action elimination (Nakhost and Müller 2010).
#
# A start is left out, and with it all that can then no longer start; if the goals hold in the end nevertheless, none of
# them was needed. Only what reads a variable that differs is looked at again, so a trial takes little time.

Values = dict[str, Value | None]


class _Start(Immutable):
    """The needs, reads and actions of a start of a plan; `written` is what it wrote in the plan."""

    name: str
    guard: Function
    actions: tuple[Assignment, ...]
    reads: frozenset[str]
    written: Mapping[str, Value]


class Elimination:
    """Leaves needless starts out of orders in which every start can follow at once, tick after tick."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, task: PlanningTask) -> None:
        self._automaton = automaton
        self._safe: StateSet | None = None if supervisor.safe.everything else supervisor.safe
        self._task = task
        self._goal_reads = frozenset(name for goal in task.goals for name in variables(goal.predicate))
        self._guards = {a.name: conjunction(a.enabled, a.start_guard) for a in automaton.abilities.values()}

    def suits(self, order: Sequence[str]) -> bool:
        """Return whether the trials mean what they say: nothing but the variables decides, and only the end counts."""
        names = set(self._goal_reads).union(() if self._safe is None else self._safe.names)
        for name in set(order):
            names.update(self._reads(name))
        plain = all(goal.local == TRUE for goal in self._task.goals) and not self._task.circumstances.avoid
        return plain and names <= self._automaton.variables.keys() and self._reached(self._after(order))

    def eliminated(self, order: Sequence[str], budget: Budget) -> tuple[str, ...]:
        """`order` without needless starts, or with some when the budget is spent."""
        base = self._variables()
        plan = self._starts(order)
        kept = 0
        while kept < len(plan) and not budget.spent:
            without = self._without(plan, kept, base)
            if without is None:
                base |= plan[kept].written
                kept += 1
            else:
                plan = [*plan[:kept], *without]
        return tuple(start.name for start in plan)

    def _without(self, plan: Sequence[_Start], left_out: int, base: Mapping[str, Value | None]) -> list[_Start] | None:
        """Return what follows the start that is left out from the state `base` before it, if the goals still are
        reached.
        """
        planned: Values = {**base, **plan[left_out].written}
        current: Values = dict(base)
        different = {name for name in plan[left_out].written if current[name] != planned[name]}
        following: list[_Start] = []
        for start in plan[left_out + 1 :]:
            written: Mapping[str, Value] | None = start.written
            if not different.isdisjoint(start.reads):
                written = self._written(start, current)
            planned |= start.written
            if written is not None:
                current |= written
                following.append(_Start(start.name, start.guard, start.actions, start.reads, written))
            for name in (*start.written, *(written or ())):
                if current[name] == planned[name]:
                    different.discard(name)
                else:
                    different.add(name)
        return following if different.isdisjoint(self._goal_reads) or self._reached(current) else None

    def _written(self, start: _Start, state: Values) -> Mapping[str, Value] | None:
        written = writes(start.actions, state) if start.guard(state) is True else None
        if written is None or (self._safe is not None and not self._safe.includes({**state, **written})):
            return None
        return written

    def _starts(self, order: Sequence[str]) -> list[_Start]:
        state = self._variables()
        starts: list[_Start] = []
        for name in order:
            actions = self._automaton.abilities[name].start_actions
            written = writes(actions, state) or {}
            starts.append(_Start(name, closure(self._guards[name]), actions, self._reads(name), written))
            state |= written
        return starts

    def _reads(self, name: str) -> frozenset[str]:
        actions = self._automaton.abilities[name].start_actions
        safe = () if self._safe is None else self._safe.names
        return frozenset(variables(self._guards[name])).union(safe, *map(reads, actions))

    def _variables(self) -> Values:
        return {name: self._task.state[name] for name in self._automaton.variables}

    def _after(self, order: Sequence[str]) -> State:
        state = self._variables()
        for start in self._starts(order):
            state |= start.written
        return state

    def _reached(self, state: State) -> bool:
        return all(holds(goal.predicate, state) for goal in self._task.goals)


# The fewest starts, where nothing happens by itself: A* with the most expensive fact as its estimate (h_max).

_MOST_VALUES = 2_000_000  # kept in memory, over all positions: beyond, the search gives up


class ShortestOrder(Immutable):
    """A shortest order of starts, if one was found; no plan has fewer than `least`. With `exhausted` there is none."""

    order: tuple[str, ...] | None
    least: int
    exhausted: bool = False


class _Node(Immutable):
    position: RunPosition
    parent: _Node | None
    start: str
    length: int

    @property
    def order(self) -> tuple[str, ...]:
        """The starts that lead here."""
        starts: list[str] = []
        node: _Node | None = self
        while node is not None and node.parent is not None:
            starts.append(node.start)
            node = node.parent
        return tuple(reversed(starts))


class FewestStarts:
    """Finds the fewest starts of automata without effects and finishes, one start after the other."""

    name = "a-star"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._compiled = CompiledTick(automaton, hot=False)
        self._supervisor = supervisor
        self._relaxed = RelaxedTask(automaton, supervisor)

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan with the fewest starts, or up to how many there is none; or that there is none at all."""
        found = self.find(task, task.longest - 1, budget)
        if found.order is None:
            return Finding(searched=min(found.least, task.longest), exhausted=found.exhausted)
        return Finding(one_by_one(found.order, minimal=True), searched=len(found.order) + 1)

    def find(self, task: PlanningTask, most: int, budget: Budget) -> ShortestOrder:
        """Up to orders of `most` starts. When the budget is spent or there is too much, what is known by then."""
        space = Space(self._compiled, self._supervisor, task, at_once=True)
        goals = {goal.name: self._relaxed.reaching(goal.predicate) for goal in task.goals}
        idle = frozenset((RuleKind.START, name) for name in space.idle_abilities)
        estimator = Estimator(self._relaxed.graph, idle)
        begin = space.wait(space.begin(), ())
        if begin is None:
            return ShortestOrder(None, 0, exhausted=True)
        ages = count()
        queue: list[tuple[int, int, int, _Node]] = []
        reached: dict[object, int] = {}
        least = 0

        def note(node: _Node) -> None:
            wanted = [goals[goal.name] for goal in node.position.goals]
            estimate = estimator.least(node.position.run.values, wanted)
            if estimate is not None:
                # Of those with equal sums the longest first: they are nearest to the goals.
                heappush(queue, (max(node.length + estimate, least), -node.length, next(ages), node))

        reached[begin.key] = 0
        note(_Node(begin, None, "", 0))
        most_positions = _MOST_VALUES // max(len(begin.run.values), 1)
        while queue:
            least, _, _, node = heappop(queue)
            if not node.position.goals:
                return ShortestOrder(node.order, least)
            if least > most or len(reached) > most_positions:
                return ShortestOrder(None, least)
            for name in sorted(node.position.run.startable()):
                if budget.spent:
                    return ShortestOrder(None, least)
                after = space.start(node.position, name)
                if after is not None and reached.get(after.key, node.length + 2) > node.length + 1:
                    reached[after.key] = node.length + 1
                    note(_Node(after, node, name, node.length + 1))
        return ShortestOrder(None, least, exhausted=True)


# Plans made short: no needless starts, and as few ticks as an eager environment lets them have.

Ticks = tuple[PlanTick, ...]

_MOST_LOST = 12  # starts that become impossible in a trial: with more it is likely to fail, late


class _Moment(Immutable):
    """The position before a tick, and what happened in it."""

    before: RunPosition
    tick: PlanTick


class Trimmer:
    """Trims plans of one task; `elimination` takes those where nothing happens by itself, however long they are."""

    def __init__(
        self, space: Space, interference: Interference, elimination: Elimination | None, budget: Budget
    ) -> None:
        self._space = space
        self._interference = interference
        self._elimination = elimination
        self._budget = budget

    def trimmed(self, ticks: Ticks) -> Ticks:
        """`ticks` with fewer starts and ticks if possible; as they are when the budget is spent."""
        order = _order(ticks)
        if self._elimination is not None and self._elimination.suits(order):
            order = self._elimination.eliminated(order, self._budget)
            return self._followed(order, (), free=False, most=len(order) + 1) or ticks
        best, found = self._shortened(self._quicker(ticks) or ticks), True
        while found and not self._budget.spent:
            quicker = self._quicker(best)
            found = quicker is not None
            if quicker is not None:
                best = self._shortened(quicker)
        return best

    def _quicker(self, ticks: Ticks) -> Ticks | None:
        """A smaller run with the starts of `ticks`, each as soon as it can be; None if neither way leads to one."""
        helpful = tuple(dict.fromkeys(effect for tick in ticks for effect in tick.effects))
        for free in (True, False):
            quicker = self._followed(_order(ticks), helpful, free, len(ticks))
            if quicker is not None and _size(quicker) < _size(ticks):
                return quicker
        return None

    def _shortened(self, ticks: Ticks) -> Ticks:
        return self._lighter(self._denser(self._lighter(ticks)))

    def _lighter(self, ticks: Ticks) -> Ticks:
        """Without starts that can be left out, one by one with all that cannot happen without them.

        Whatever else there is stays in its tick. What reaches the goals although all happens that can still does: a
        start that is needless only if some device tarries stays.
        """
        best = self._as_written((), self._space.begin(), ticks, eager=True)
        eager = best is not None
        best = best or self._as_written((), self._space.begin(), ticks)
        found = best is not None
        while best is not None and found:  # what was tried may have become needless
            found = False
            number = len(best) - 1
            while number >= 0 and not self._budget.spent:
                lighter = self._lighter_tick(best, number, eager)
                if lighter is None:
                    number -= 1
                else:
                    best, found = lighter, True
                    number = min(number, len(best) - 1)
        return ticks if best is None else tuple(moment.tick for moment in best)

    def _lighter_tick(self, run: tuple[_Moment, ...], number: int, eager: bool) -> tuple[_Moment, ...] | None:
        """The run without one of the starts of a tick, a late one if possible; None if each is needed."""
        tick = run[number].tick
        rest = tuple(moment.tick for moment in run[number + 1 :])
        for index in reversed(range(len(tick.starts))):
            without = PlanTick(tick.effects, tick.starts[:index] + tick.starts[index + 1 :])
            trial = self._as_written(run[:number], run[number].before, (without, *rest), eager)
            if trial is not None:
                return trial
        return None

    def _denser(self, ticks: Ticks) -> Ticks:
        """With fewer ticks: what starts in one is put off to the next, and all that follows comes a tick earlier."""
        best = self._as_written((), self._space.begin(), ticks)
        number = 0
        while best is not None and number < len(best) - 1 and not self._budget.spent:
            late, next_, *rest = (moment.tick for moment in best[number:])
            starts = late.starts + next_.starts
            effects = tuple(dict.fromkeys(late.effects + next_.effects))
            before = best[number].before
            trial = self._as_written(best[:number], before, (PlanTick(effects, starts), *rest), eager=True)
            if trial is None:
                number += 1
            else:
                best = trial
        return ticks if best is None else tuple(moment.tick for moment in best)

    def _as_written(
        self, begun: tuple[_Moment, ...], position: RunPosition, ticks: Iterable[PlanTick], eager: bool = False
    ) -> tuple[_Moment, ...] | None:
        """The run that goes on from `position` with `ticks`, less what cannot happen in its tick, up to the goals.

        Ticks in which nothing happens are left out. When it is `eager`, all else that can happen in a tick happens too.
        None if the goals are not reached, or if too much gets lost.
        """
        moments = list(begun)
        lost = 0
        for tick in ticks:
            if eager:
                effects = self._space.everything(position, tick.effects)
            else:
                possible = self._space.effects(position)
                effects = tuple(name for name in tick.effects if name in possible)
            after = self._space.wait(position, effects)
            if after is None:
                return None
            if not tick.starts and position.begun and after.key == position.key:
                continue  # nothing waits for such a tick
            before, position = position, after
            taken: list[str] = []
            for name in tick.starts if position.goals else ():
                started = self._space.start(position, name)
                if started is None:
                    lost += 1
                else:
                    position = started
                    taken.append(name)
            if lost > _MOST_LOST:
                return None
            moments.append(_Moment(before, PlanTick(effects, tuple(taken))))
            if not position.goals:
                return tuple(moments)
        return None

    def _followed(self, order: Iterable[str], helpful: Iterable[str], free: bool, most: int) -> Ticks | None:
        """The run in which all that can happen does, and each start of `order` comes as soon as it can.

        With `free` a start may overtake others even if it can get in their way. What can never start any more is left
        out. None if goals are not reached in `most` ticks.
        """
        helpful = tuple(helpful)
        position, left = self._space.begin(), list(order)
        ticks: list[PlanTick] = []
        while position.goals:
            happening = self._space.everything(position, helpful)
            later = self._space.wait(position, happening)
            if later is None or len(ticks) >= most or self._budget.spent:
                return None
            if position.begun and later.key == position.key:
                if not left:
                    return None
                del left[0]  # nothing will ever let it start
                position, starts = self._started(position, left, free)
                ticks[-1] = PlanTick(ticks[-1].effects, (*ticks[-1].starts, *starts))
            else:
                position, starts = self._started(later, left, free)
                ticks.append(PlanTick(happening, starts))
        return tuple(ticks)

    def _started(self, position: RunPosition, left: list[str], free: bool) -> tuple[RunPosition, tuple[str, ...]]:
        """The position after all starts of `left` that can be taken in this tick, which are taken out of it."""
        starts: list[str] = []
        index = 0
        while index < len(left) and position.goals:
            name = left[index]
            waits = not free and any(self._interference.between(name, other) for other in left[:index])
            after = None if waits else self._space.start(position, name)
            if after is None:
                index += 1
            else:
                position = after
                starts.append(left.pop(index))
                index = 0
        return position, tuple(starts)


def _order(ticks: Iterable[PlanTick]) -> tuple[str, ...]:
    return tuple(name for _, name in starts_of(ticks))


def _size(ticks: Ticks) -> tuple[int, int]:
    return len(ticks), len(_order(ticks))
