"""Ways back: a few starts after which the rest of a plan given before leads to the goals."""

from __future__ import annotations

from collections import deque

from sequence_planner.automaton.compiled import CompiledRun, CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.single.ways import Ways

_MOST = 60  # states that are looked at


class Detours:
    """Looks for ways back to `ways`."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, ways: Ways) -> None:
        self._automaton = automaton
        self._safe = None if supervisor.safe.everything else supervisor.safe
        self._ways = ways
        self._compiled: CompiledTick | None = None

    def found(self, state: State, goals: Goals) -> tuple[str, ...] | None:
        """The starts of a plan that soon comes to the rest of another; those of the shortest rest of the nearest."""
        rest = self._ways.leading(state, goals)
        if rest is not None:
            return rest
        if not any(set(goals) <= set(way.missing[0]) for way in self._ways):
            return None
        if self._compiled is None:
            self._compiled = CompiledTick(self._automaton, hot=False)
        begin = CompiledRun(self._compiled, state)
        pending: deque[tuple[CompiledRun, tuple[str, ...]]] = deque([(begin, ())])
        seen = {tuple(begin.values.values())}
        best: tuple[str, ...] | None = None
        while pending and len(seen) < _MOST:
            run, order = pending.popleft()
            if best is not None and len(order) + 1 >= len(best):
                break
            for name in sorted(run.startable()):
                after = run.fork()
                if not after.start(name) or (self._safe is not None and not self._safe.includes(after.values)):
                    continue
                key = tuple(after.values.values())
                if key in seen:
                    continue
                seen.add(key)
                way = (*order, name)
                rest = self._ways.leading(after.values, goals)
                if rest is not None and (best is None or len(way) + len(rest) < len(best)):
                    best = (*way, *rest)
                pending.append((after, way))
            if best is not None:
                return best
        return best
