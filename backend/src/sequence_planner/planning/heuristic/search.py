"""Heuristic plan search: greedy best-first, YAHSP lookahead, and exhaustive search of small spaces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from heapq import heappop, heappush
from itertools import count

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import Writes
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.heuristic.relaxed_task import (
    Estimate,
    Estimator,
    Operator,
    RelaxedStep,
    RelaxedTask,
    RuleKind,
)
from sequence_planner.planning.heuristic.shorten import Elimination, Trimmer
from sequence_planner.planning.heuristic.space import Interference, Move, RunPosition, Space, ticks_of
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Plan, PlanTick
from sequence_planner.process.budget import Budget, SpentError

# Shortest plans where few states can be reached: tick by tick, every set of effects and every order of starts.

_MOST_LAYER_VALUES = 1_000_000  # of all positions of two layers together: beyond, the search gives up
_MOST_REACTIONS = 1024  # sets of effects that can happen in one tick


class TooManyError(Exception):
    """There are too many positions for this engine."""


class _LayerNode(Immutable):
    """The end of a tick; `starts` are all so far, `tick` is the last one."""

    position: RunPosition
    starts: int
    parent: _LayerNode | None
    tick: PlanTick

    @property
    def ticks(self) -> tuple[PlanTick, ...]:
        """All ticks so far."""
        return (*(self.parent.ticks if self.parent is not None and self.parent.position.begun else ()), *self._last)

    @property
    def _last(self) -> tuple[PlanTick, ...]:
        return (self.tick,) if self.position.begun else ()


class ShortestSearch:
    """An engine for tiny tasks: the fewest ticks, then the fewest starts, proven, unless there is too much."""

    name = "breadth-first"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._compiled: CompiledTick | None = None

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """The shortest plan; or that none has up to `longest` ticks, which all that can be reached may have told."""
        if not task.goals:
            return Finding(Plan((), minimal_ticks=True, minimal_starts=True))
        if self._compiled is None:
            self._compiled = CompiledTick(self._automaton, hot=False)
        space = Space(self._compiled, self._supervisor, task, at_once=False)
        first = space.begin()
        layer = [_LayerNode(first, 0, None, PlanTick((), ()))]
        seen: set[object] = set()
        most = _MOST_LAYER_VALUES // max(len(first.run.values), 1)
        for number in range(1, task.longest + 1):
            try:
                done, following = self._layer(space, layer, seen, most, budget)
            except (SpentError, TooManyError):
                return Finding(searched=number - 1)
            if done is not None:
                return Finding(Plan(done.ticks, minimal_ticks=True, minimal_starts=True), searched=number)
            if not following:
                break
            seen.update(following)
            layer = list(following.values())
        return Finding(searched=task.longest)

    def _layer(
        self, space: Space, layer: list[_LayerNode], seen: set[object], most: int, budget: Budget
    ) -> tuple[_LayerNode | None, dict[object, _LayerNode]]:
        """After one more tick: the node with the fewest starts that has reached the goals; all others that are new."""
        done: _LayerNode | None = None
        following: dict[object, _LayerNode] = {}
        for node in layer:
            for effects in _reactions(space, node.position):
                budget.require()
                after = space.wait(node.position, effects)
                if after is None:
                    continue
                if not after.goals:
                    if done is None or node.starts < done.starts:
                        done = _LayerNode(after, node.starts, node, PlanTick(effects, ()))
                    continue
                for position, starts in _ends(space, after, most):
                    key = position.settled_key
                    total = node.starts + len(starts)
                    if key not in seen and (key not in following or total < following[key].starts):
                        following[key] = _LayerNode(position, total, node, PlanTick(effects, starts))
            if len(following) + len(seen) > most:
                raise TooManyError
        return done, following


def _reactions(space: Space, position: RunPosition) -> Iterator[tuple[str, ...]]:
    """Sets of effects that can happen together; of those that do the same, one."""
    found: dict[frozenset[tuple[str, object]], tuple[Writes, tuple[str, ...]]] = {frozenset(): ({}, ())}
    for name, written in space.effects(position).items():
        for together, names in list(found.values()):
            if all(together.get(each, value) == value for each, value in written.items()):
                more = together | written
                found.setdefault(frozenset(more.items()), (more, (*names, name)))
        if len(found) > _MOST_REACTIONS:
            raise TooManyError
    return (names for _, names in found.values())


def _ends(space: Space, position: RunPosition, most: int) -> list[tuple[RunPosition, tuple[str, ...]]]:
    """Every position in which the tick can end, with the starts that lead there."""
    found: dict[object, tuple[RunPosition, tuple[str, ...]]] = {position.key: (position, ())}
    for current, starts in (pending := list(found.values())):  # which grows meanwhile
        for name in sorted(current.run.startable()):
            after = space.start(current, name)
            if after is not None and after.key not in found:
                found[after.key] = (after, (*starts, name))
                pending.append(found[after.key])
        if len(found) > most:
            raise TooManyError
    return list(found.values())


# Leaps: as much of a relaxed plan as can really be carried out, at once, as in YAHSP (Vidal 2004).

_MOST_WAITS = 40  # in one leap


def leap(space: Space, position: RunPosition, steps: Iterable[RelaxedStep]) -> tuple[RunPosition, tuple[Move, ...]]:
    """Return where `position` gets when the relaxed plan's starts are taken as they can be, and what happens
    meanwhile.
    """
    moves: list[Move] = []
    starts = {step.operator[1]: step for step in steps if step.operator[0] is RuleKind.START}
    effects = [step.operator[1] for step in steps if step.operator[0] is RuleKind.EFFECT]
    waits = 0
    while position.goals:
        started = _start(space, position, list(starts.values()))
        if started is not None:
            position, name = started
            moves.append(name)
            del starts[name]
            continue
        if waits == _MOST_WAITS:
            break
        happening = space.everything(position, effects)
        later = space.wait(position, happening)
        if later is None or later.key == position.key:
            break
        position = later
        moves.append(happening)
        waits += 1
    return position, tuple(moves)


def _start(space: Space, position: RunPosition, steps: Sequence[RelaxedStep]) -> tuple[RunPosition, str] | None:
    """The position after one of the starts, first those that keep the fewest of the others from starting now."""
    if not position.begun:
        return None
    ready = [step for step in steps if position.run.may_start(step.operator[1])]
    needed = Counter(need for step in ready for need in step.needs)
    variables = Counter(name for step in ready for name, _ in step.needs)

    def threats(step: RelaxedStep) -> int:
        """Return how many facts that others need it takes away."""
        own = dict(step.needs)
        return sum(
            variables[name] - needed[name, value] - (name in own and own[name] != value) for name, value in step.brings
        )

    for step in sorted(ready, key=threats):
        after = space.start(position, step.operator[1])
        if after is not None:
            return after, step.operator[1]
    return None


# Greedy best-first search along the estimates: some plan, soon.
#
# Moves wait in two queues, those of relaxed plans in one of their own, and positions are made only when it is their
# turn (lazy search with preferred operators: Richter and Helmert 2009).

_MOST_VALUES = 3_000_000  # kept in memory, over all positions: beyond, the search gives up
_SHARE = 0.2  # of the time that is left, to make a plan short once there is one
_BOOST = 1000  # turns that moves of relaxed plans get ahead of the others when there is progress


class _Node(Immutable):
    position: RunPosition
    parent: _Node | None
    moves: tuple[Move, ...]  # from the parent

    @property
    def way(self) -> tuple[Move, ...]:
        """All moves from the beginning."""
        parts: list[tuple[Move, ...]] = []
        node: _Node | None = self
        while node is not None:
            parts.append(node.moves)
            node = node.parent
        return tuple(move for moves in reversed(parts) for move in moves)


_Entry = tuple[int, int, int, _Node, Move]  # by estimate, then by likelihood of use, then by age


class HeuristicSearch:
    """An engine for fast plans: it proves nothing, and what it finds is short but seldom proven shortest."""

    name = "search"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._compiled: CompiledTick | None = None
        self._relaxed: RelaxedTask | None = None
        self._interference = Interference(automaton)
        # Where nothing happens by itself, ticks are only filled with starts once there is a plan.
        self._at_once = not any(not effect.fault for effect in automaton.effects) and all(
            ability.finish_guard is None for ability in automaton.abilities.values()
        )

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan without needless starts, unless the budget is spent or the positions are too many."""
        if not task.goals:
            return Finding(Plan((), minimal_ticks=True, minimal_starts=True))
        try:
            ticks = self.ticks(task, budget)
        except SpentError:
            return Finding()
        if ticks is None or len(ticks) > task.longest:
            return Finding()
        few = len(ticks) == 1  # no start, and none of fewer ticks, as some goal is still missing
        return Finding(Plan(ticks, minimal_ticks=few, minimal_starts=few))

    def ticks(self, task: PlanningTask, budget: Budget, most: int | None = None) -> tuple[PlanTick, ...] | None:
        """Ticks of a plan, however many, if it is found from at most so many positions. Raises `SpentError`."""
        if self._compiled is None:
            self._compiled = CompiledTick(self._automaton, hot=False)
        if self._relaxed is None:
            self._relaxed = RelaxedTask(self._automaton, self._supervisor, budget.require)
        space = Space(self._compiled, self._supervisor, task, self._at_once)
        way = _Search(space, self._relaxed, task, budget).way(most)
        if way is None:
            return None
        steady = Space(self._compiled, self._supervisor, task, at_once=False)
        elimination = Elimination(self._automaton, self._supervisor, task) if self._at_once else None
        return Trimmer(steady, self._interference, elimination, budget.part(_SHARE)).trimmed(
            ticks_of(_with_waits(way) if self._at_once else way)
        )


def _with_waits(way: Iterable[Move]) -> Iterator[Move]:
    """A tick of its own for each start."""
    for move in way:
        yield move
        if isinstance(move, str):
            yield ()


class _Search:
    """One search."""

    def __init__(self, space: Space, relaxed: RelaxedTask, task: PlanningTask, budget: Budget) -> None:
        self._space = space
        self._budget = budget
        self._goal_nodes = {goal.name: relaxed.reaching(goal.predicate) for goal in task.goals}
        idle: list[Operator] = [(RuleKind.START, name) for name in space.idle_abilities]
        idle += [(RuleKind.EFFECT, name) for name in space.idle_effects]
        self._estimator = Estimator(relaxed.graph, frozenset(idle))
        self._queues: tuple[list[_Entry], list[_Entry]] = ([], [])  # all moves, and those of relaxed plans
        self._turns = [0, 0]
        self._ages = count()
        self._reached: set[object] = set()
        self._best = 1 << 60

    def way(self, most: int | None = None) -> tuple[Move, ...] | None:
        """The moves of a run that reaches the goals; None if the search gives up, at `most` positions at the latest."""
        node: _Node | None = _Node(self._space.begin(), None, ())
        kept = _MOST_VALUES // max(len(node.position.run.values), 1) if node else 0
        most = kept if most is None else min(most, kept)
        while node is not None:
            nearest = 1 << 60  # of the positions that one leap after the other has led to
            while node is not None:
                if not node.position.goals:
                    return node.way
                node, nearest = self._expanded(node, nearest)
            if len(self._reached) > most:
                return None
            node = self._next()
        return None

    def _expanded(self, node: _Node, nearest: int) -> tuple[_Node | None, int]:
        """Note the moves from a new position. Where a leap leads if that is new, and how far it was from here.

        No leap follows one that has not led nearer.
        """
        position = node.position
        estimate = self._estimate(position)
        if estimate is None:
            return None, nearest
        if estimate.cost < self._best:
            self._best = estimate.cost
            self._turns[1] -= _BOOST
        for move, likely, helpful in self._moves(position, estimate):
            entry = (estimate.cost, likely, next(self._ages), node, move)
            heappush(self._queues[0], entry)
            if helpful:
                heappush(self._queues[1], entry)
        if estimate.cost >= nearest:
            return None, nearest
        end, moves = leap(self._space, position, estimate.steps)
        return (self._new(_Node(end, node, moves)) if moves else None), estimate.cost

    def _next(self) -> _Node | None:
        """The position after the next move that leads to a new one."""
        while any(self._queues):
            self._budget.require()
            which = min((turns, -number) for number, turns in enumerate(self._turns) if self._queues[number])[1]
            self._turns[-which] += 1
            *_, parent, move = heappop(self._queues[-which])
            after = self._space.moved(parent.position, move)
            if after is not None and (node := self._new(_Node(after, parent, (move,)))) is not None:
                return node
        return None

    def _new(self, node: _Node) -> _Node | None:
        key = node.position.key
        if key in self._reached:
            return None
        self._reached.add(key)
        return node

    def _estimate(self, position: RunPosition) -> Estimate | None:
        self._budget.require()
        goals = [self._goal_nodes[goal.name] for goal in position.goals]
        return self._estimator.estimate(position.run.values, goals)

    def _moves(self, position: RunPosition, estimate: Estimate) -> Iterator[tuple[Move, int, bool]]:
        """Yield what can be done, how unlikely it is to be needed, and whether the relaxed plan has it."""
        helpful = {step.operator for step in estimate.steps}
        effects = tuple(name for kind, name in helpful if kind is RuleKind.EFFECT)
        if position.begun:
            for operator in sorted(estimate.possible, key=lambda operator: operator[1]):
                if operator[0] is RuleKind.START:
                    yield operator[1], 0, operator in helpful
            if self._space.at_once:
                return
        everything = self._space.everything(position, effects)
        due = any(operator[0] is not RuleKind.START and operator in estimate.possible for operator in helpful)
        yield everything, 0, due or not position.begun
        if len(everything) > 1 or set(everything) != set(self._space.effects(position)):
            yield from (((name,), 1, False) for name in self._space.effects(position))
        if everything:
            yield (), 2, False
