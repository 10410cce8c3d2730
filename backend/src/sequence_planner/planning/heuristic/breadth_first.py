"""Shortest plans where few states can be reached: tick by tick, every set of effects and every order of starts."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.compiled import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.tick import Writes
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.heuristic.space import Position, Space
from sequence_planner.planning.plan import Plan, PlanTick

_MOST_VALUES = 1_000_000  # of all positions of two layers together: beyond, the search gives up
_MOST_REACTIONS = 1024  # sets of effects that can happen in one tick


class TooManyError(Exception):
    """There are too many positions for this engine."""


class _Node(Immutable):
    """The end of a tick; `starts` are all so far, `tick` is the last one."""

    position: Position
    starts: int
    parent: _Node | None
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

    def solve(self, task: Task, budget: Budget) -> Finding:
        """The shortest plan; or that none has up to `longest` ticks, which all that can be reached may have told."""
        if not task.goals:
            return Finding(Plan((), minimal_ticks=True, minimal_starts=True))
        if self._compiled is None:
            self._compiled = CompiledTick(self._automaton, hot=False)
        space = Space(self._compiled, self._supervisor, task, at_once=False)
        first = space.begin()
        layer = [_Node(first, 0, None, PlanTick((), ()))]
        seen: set[object] = set()
        most = _MOST_VALUES // max(len(first.run.values), 1)
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
        self, space: Space, layer: list[_Node], seen: set[object], most: int, budget: Budget
    ) -> tuple[_Node | None, dict[object, _Node]]:
        """After one more tick: the node with the fewest starts that has reached the goals; all others that are new."""
        done: _Node | None = None
        following: dict[object, _Node] = {}
        for node in layer:
            for effects in _reactions(space, node.position):
                budget.require()
                after = space.wait(node.position, effects)
                if after is None:
                    continue
                if not after.goals:
                    if done is None or node.starts < done.starts:
                        done = _Node(after, node.starts, node, PlanTick(effects, ()))
                    continue
                for position, starts in _ends(space, after, most):
                    key = position.settled_key
                    total = node.starts + len(starts)
                    if key not in seen and (key not in following or total < following[key].starts):
                        following[key] = _Node(position, total, node, PlanTick(effects, starts))
            if len(following) + len(seen) > most:
                raise TooManyError
        return done, following


def _reactions(space: Space, position: Position) -> Iterator[tuple[str, ...]]:
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


def _ends(space: Space, position: Position, most: int) -> list[tuple[Position, tuple[str, ...]]]:
    """Every position in which the tick can end, with the starts that lead there."""
    found: dict[object, tuple[Position, tuple[str, ...]]] = {position.key: (position, ())}
    for current, starts in (pending := list(found.values())):  # which grows meanwhile
        for name in sorted(current.run.startable()):
            after = space.start(current, name)
            if after is not None and after.key not in found:
                found[after.key] = (after, (*starts, name))
                pending.append(found[after.key])
        if len(found) > most:
            raise TooManyError
    return list(found.values())
