"""Ways back: a few starts after which the rest of a plan given before leads to the goals."""

from __future__ import annotations

from heapq import heappop, heappush
from itertools import count

from sequence_planner.automaton.compiled import CompiledRun
from sequence_planner.automaton.structure import State
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.single.stepping import Stepping
from sequence_planner.planning.single.ways import Way, Ways

_MOST = 120  # states that are looked at
_NEAREST = 4  # rests of plans that a way is looked for to


class Detours:
    """Looks for ways back to `ways`: greedily, where the fewest values differ that the rest of a plan asks for."""

    def __init__(self, stepping: Stepping, ways: Ways) -> None:
        self._stepping = stepping
        self._ways = ways

    def found(self, state: State, goals: Goals, budget: Budget) -> tuple[str, ...] | None:
        """The starts of a plan that soon comes to the rest of another; the rest itself if it leads from `state`."""
        nearest = self._ways.nearest(state, goals, _NEAREST)
        if not nearest:
            return None
        if nearest[0][0] == 0:
            return min((way.order[number:] for far, way, number in nearest if far == 0), key=len)
        targets = [(way, number) for _, way, number in nearest]
        begin = self._stepping.begin(state)
        seen = {tuple(begin.values.values())}
        ages = count()
        queue: list[tuple[int, int, CompiledRun, tuple[str, ...]]] = [(0, next(ages), begin, ())]
        while queue and len(seen) < _MOST and not budget.spent:
            _, _, run, order = heappop(queue)
            for name, after in self._stepping.following(run):
                key = tuple(after.values.values())
                if key in seen:
                    continue
                seen.add(key)
                further = (*order, name)
                far, way, number = min(
                    ((way.far(number, after.values), way, number) for way, number in targets), key=_distance
                )
                if far == 0:
                    return (*further, *way.order[number:])
                heappush(queue, (2 * far + len(further), next(ages), after, further))
        return None


def _distance(target: tuple[int, Way, int]) -> tuple[int, int]:
    far, _, number = target
    return far, -number
