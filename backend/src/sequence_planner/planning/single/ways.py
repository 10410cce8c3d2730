"""Plans given before, and what they ask of a state: the rest of one leads to the goals from more states than its own.

What the rest of a plan reads before it writes it decides all that it does. From every state that has the same values
there it leads to the goals as well (regression, as in Fritz and McIlraith 2007).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from functools import cached_property
from heapq import nsmallest
from operator import itemgetter
from typing import NamedTuple

from sequence_planner.automaton.structure import State
from sequence_planner.expressions.syntax import variables
from sequence_planner.expressions.types import Value
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.goals.pursuit import Goals

_MOST = 8  # plans that are kept

Values = tuple[Value | None, ...]


class Rest(NamedTuple):
    """What is left of a plan; `minimal` if no plan from there has fewer starts."""

    order: tuple[str, ...]
    minimal: bool


class Way:
    """A plan, the states that it leads through, and the goals missing in each; `minimal` if none has fewer starts."""

    def __init__(
        self,
        order: Sequence[str],
        states: Sequence[State],
        missing: Sequence[Goals],
        minimal: bool,
        starts: Starts,
    ) -> None:
        self.order = tuple(order)
        self.states = states
        self.missing = missing
        self.minimal = minimal
        self._starts = starts

    def far(self, number: int, state: State) -> int:
        """How many other values the rest of the plan, from so many starts on, asks for.

        With none it leads from `state` to the goals that are missing there on the way.
        """
        return sum(state[name] != value for name, value in self._asked[number])

    @cached_property
    def _asked(self) -> list[list[tuple[str, Value | None]]]:
        """For each state on the way, the values there on which depends what comes then."""
        goals = self.missing[0]
        seen = frozenset[str]().union(*(variables(goal.predicate) for goal in goals))
        names: frozenset[str] = seen
        found: list[frozenset[str]] = []
        for name in reversed(self.order):
            start = self._starts[name]
            names = (names - start.surely_written) | start.reads | self._starts.guarded(name)
            if len(goals) > 1:  # each can hold at a moment of its own
                names |= seen
            found.append(names)
        return [
            [(name, state[name]) for name in each]
            for state, each in zip(self.states[:-1], reversed(found), strict=True)
        ]


class Ways:
    """The last plans of one automaton under one supervisor, with these `starts`."""

    def __init__(self, starts: Starts) -> None:
        self._starts = starts
        self._ways: deque[Way] = deque(maxlen=_MOST)  # the last one first

    def __iter__(self) -> Iterator[Way]:
        return iter(self._ways)

    def keep(self, order: Sequence[str], states: Sequence[State], missing: Sequence[Goals], minimal: bool) -> None:
        """Note a plan that has been taken step by step; the shorter of two from one state replaces the other."""
        way = Way(order, states, missing, minimal, self._starts)
        for known in tuple(self._ways):
            if known.missing[0] == way.missing[0] and known.states[0] == way.states[0]:
                self._ways.remove(known)
        self._ways.appendleft(way)

    def known(self, state: State, goals: Goals) -> Rest | None:
        """The rest of a plan from a state on its way, proven to be minimal if possible."""
        best: Rest | None = None
        for way in self._ways:
            for number, (there, missing) in enumerate(zip(way.states, way.missing, strict=True)):
                if missing == goals and there == state:
                    rest = Rest(way.order[number:], way.minimal)
                    if best is None or (rest.minimal, -len(rest.order)) > (best.minimal, -len(best.order)):
                        best = rest
        return best

    def nearest(self, state: State, goals: Goals, most: int) -> list[tuple[int, Way, int]]:
        """Plans that reach `goals`, each from so many starts on, whose rests ask the fewest values to be others."""
        wanted = set(goals)
        found = [
            (way.far(number, state), number - len(way.order), age, way, number)
            for age, way in enumerate(self._ways)
            for number in range(len(way.order))
            if wanted.issubset(way.missing[number])
        ]
        return [(far, way, number) for far, _, _, way, number in nsmallest(most, found, key=itemgetter(0, 1, 2))]
