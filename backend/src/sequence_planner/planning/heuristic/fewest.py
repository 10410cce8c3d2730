"""The fewest starts, where nothing happens by itself: A* with the most expensive fact as its estimate (h_max)."""

from __future__ import annotations

from heapq import heappop, heappush
from itertools import count

from sequence_planner.automaton.compiled import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.heuristic.estimate import Estimator
from sequence_planner.planning.heuristic.graph import Kind
from sequence_planner.planning.heuristic.relaxed_task import RelaxedTask
from sequence_planner.planning.heuristic.space import Position, Space
from sequence_planner.planning.plan import one_by_one

_MOST_VALUES = 2_000_000  # kept in memory, over all positions: beyond, the search gives up


class Fewest(Immutable):
    """A shortest order of starts, if one was found; no plan has fewer than `least`. With `exhausted` there is none."""

    order: tuple[str, ...] | None
    least: int
    exhausted: bool = False


class _Node(Immutable):
    position: Position
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

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan with the fewest starts, or up to how many there is none; or that there is none at all."""
        found = self.find(task, task.longest - 1, budget)
        if found.order is None:
            return Finding(searched=min(found.least, task.longest), exhausted=found.exhausted)
        return Finding(one_by_one(found.order, minimal=True), searched=len(found.order) + 1)

    def find(self, task: Task, most: int, budget: Budget) -> Fewest:
        """Up to orders of `most` starts. When the budget is spent or there is too much, what is known by then."""
        space = Space(self._compiled, self._supervisor, task, at_once=True)
        goals = {goal.name: self._relaxed.reaching(goal.predicate) for goal in task.goals}
        idle = frozenset((Kind.START, name) for name in space.idle_abilities)
        estimator = Estimator(self._relaxed.graph, idle)
        begin = space.wait(space.begin(), ())
        if begin is None:
            return Fewest(None, 0, exhausted=True)
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
                return Fewest(node.order, least)
            if least > most or len(reached) > most_positions:
                return Fewest(None, least)
            for name in sorted(node.position.run.startable()):
                if budget.spent:
                    return Fewest(None, least)
                after = space.start(node.position, name)
                if after is not None and reached.get(after.key, node.length + 2) > node.length + 1:
                    reached[after.key] = node.length + 1
                    note(_Node(after, node, name, node.length + 1))
        return Fewest(None, least, exhausted=True)
