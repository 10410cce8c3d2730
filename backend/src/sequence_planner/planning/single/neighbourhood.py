"""Plan shortening by plan neighbourhood graph search (Nakhost and Müller 2010), for single starts."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget

# What can follow a state, start by start.


class Stepping:
    """Runs of one automaton under one supervisor, whose starts are taken one at a time."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._safe = None if supervisor.safe.everything else supervisor.safe

    def begin(self, state: State) -> CompiledRun:
        """A run that is in `state`."""
        return CompiledRun(self._compiled, state)

    def following(self, run: CompiledRun) -> Iterator[tuple[str, CompiledRun]]:
        """The starts that can be taken, each with the run after it; the same ones in the same order each time."""
        for name in sorted(run.startable()):
            after = run.fork()
            if after.start(name) and (self._safe is None or self._safe.includes(after.values)):
                yield name, after

    @cached_property
    def _compiled(self) -> CompiledTick:
        return CompiledTick(self._automaton, hot=False)


# Shorter plans near one that was found fast (plan neighbourhood graph search, Nakhost and Müller 2010).
#
# Around the states that a plan leads through others are looked at, nearer ones first, with all that leads from one to
# another. The shortest way through all of them is never longer than the plan, and often much shorter.

_MOST = 20_000  # states: where there is time for more, there may be no memory for them

_Key = tuple[tuple[Value | None, ...], Goals]


def shortened(
    order: Sequence[str], state: State, goals: Goals, stepping: Stepping, budget: Budget
) -> tuple[str, ...] | None:
    """The starts of a shorter plan from `state` than `order`, as short as is found in time; None if none is."""
    best: tuple[str, ...] | None = None
    while not budget.spent:
        around = _Neighbourhood(tuple(order) if best is None else best, state, goals, stepping)
        around.widen(budget)
        found = around.shortest()
        if len(found) >= len(order if best is None else best):
            break
        best = found
    return best


class _Place(NamedTuple):
    """A state, the goals that are missing in it, and those of the states after it that have been looked at."""

    run: CompiledRun
    missing: Goals
    after: dict[_Key, str]


class _Neighbourhood:
    def __init__(self, order: Sequence[str], state: State, goals: Goals, stepping: Stepping) -> None:
        self._stepping = stepping
        self._places: dict[_Key, _Place] = {}
        self._ring: deque[_Key] = deque()  # of which is not known what follows
        run = stepping.begin(state)
        key = self._begin = self._placed(run, goals)
        for name in order:
            run = run.fork()
            run.start(name)
            before = self._places[key]
            key = self._placed(run, before.missing)
            before.after.setdefault(key, name)

    def _placed(self, run: CompiledRun, before: Goals) -> _Key:
        left = missing(before, run.values)
        key = tuple(run.values.values()), left
        if key not in self._places:
            self._places[key] = _Place(run, left, {})
            self._ring.append(key)
        return key

    def widen(self, budget: Budget) -> None:
        """Look at what follows the states there are, and then at what follows those, until the budget is spent."""
        while self._ring and len(self._places) < _MOST and not budget.spent:
            place = self._places[self._ring.popleft()]
            if place.missing:
                for name, run in self._stepping.following(place.run):
                    place.after.setdefault(self._placed(run, place.missing), name)

    def shortest(self) -> tuple[str, ...]:
        """The shortest way through all of it, breadth first."""
        came: dict[_Key, tuple[_Key, str] | None] = {self._begin: None}
        queue = deque([self._begin])
        while queue:
            key = queue.popleft()
            if not self._places[key].missing:
                return _way(came, key)
            for after, name in self._places[key].after.items():
                if after not in came:
                    came[after] = key, name
                    queue.append(after)
        raise AssertionError("the plan itself is a way")


def _way(came: dict[_Key, tuple[_Key, str] | None], key: _Key) -> tuple[str, ...]:
    names: list[str] = []
    while (step := came[key]) is not None:
        key, name = step
        names.append(name)
    return tuple(reversed(names))
