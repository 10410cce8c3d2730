"""Greedy best-first search along the estimates: some plan, soon.

Moves wait in two queues, those of relaxed plans in one of their own, and positions are made only when it is their turn
(lazy search with preferred operators: Richter and Helmert 2009).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from heapq import heappop, heappush
from itertools import count

from sequence_planner.automaton.compiled import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.heuristic.elimination import Elimination
from sequence_planner.planning.heuristic.estimate import Estimate, Estimator
from sequence_planner.planning.heuristic.graph import Kind, Operator
from sequence_planner.planning.heuristic.interference import Interference
from sequence_planner.planning.heuristic.leaping import leap
from sequence_planner.planning.heuristic.relaxed_task import RelaxedTask
from sequence_planner.planning.heuristic.space import Move, Position, Space, ticks_of
from sequence_planner.planning.heuristic.trimming import Trimmer
from sequence_planner.planning.plan import Plan, PlanTick

_MOST_VALUES = 3_000_000  # kept in memory, over all positions: beyond, the search gives up
_SHARE = 0.2  # of the time that is left, to make a plan short once there is one
_BOOST = 1000  # turns that moves of relaxed plans get ahead of the others when there is progress


class _Node(Immutable):
    position: Position
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

    def solve(self, task: Task, budget: Budget) -> Finding:
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

    def ticks(self, task: Task, budget: Budget, most: int | None = None) -> tuple[PlanTick, ...] | None:
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

    def __init__(self, space: Space, relaxed: RelaxedTask, task: Task, budget: Budget) -> None:
        self._space = space
        self._budget = budget
        self._goal_nodes = {goal.name: relaxed.reaching(goal.predicate) for goal in task.goals}
        idle: list[Operator] = [(Kind.START, name) for name in space.idle_abilities]
        idle += [(Kind.EFFECT, name) for name in space.idle_effects]
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

    def _estimate(self, position: Position) -> Estimate | None:
        self._budget.require()
        goals = [self._goal_nodes[goal.name] for goal in position.goals]
        return self._estimator.estimate(position.run.values, goals)

    def _moves(self, position: Position, estimate: Estimate) -> Iterator[tuple[Move, int, bool]]:
        """What can be done, how unlikely it is to be needed, and whether the relaxed plan has it."""
        helpful = {step.operator for step in estimate.steps}
        effects = tuple(name for kind, name in helpful if kind is Kind.EFFECT)
        if position.begun:
            for operator in sorted(estimate.possible, key=lambda operator: operator[1]):
                if operator[0] is Kind.START:
                    yield operator[1], 0, operator in helpful
            if self._space.at_once:
                return
        everything = self._space.everything(position, effects)
        due = any(operator[0] is not Kind.START and operator in estimate.possible for operator in helpful)
        yield everything, 0, due or not position.begun
        if len(everything) > 1 or set(everything) != set(self._space.effects(position)):
            yield from (((name,), 1, False) for name in self._space.effects(position))
        if everything:
            yield (), 2, False
