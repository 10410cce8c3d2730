"""All states that steps lead to or come from, by saturation (Ciardo et al. 2001; Meijer & van de Pol 2016).

Steps are grouped by the first level that they touch. A set is closed under those further down first, branch by branch
below the levels that these do not touch, so that most of the work is done on small diagrams and is shared.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import groupby

from sequence_planner.synthesis.diagrams import Diagrams, Function
from sequence_planner.synthesis.steps import Step

Fire = Callable[[Function], Function]


def reachable(diagrams: Diagrams, states: Function, steps: Iterable[Step], within: Function | None = None) -> Function:
    """`states`, all of them in `within`, and where `steps` lead from them without leaving it."""
    return _Closure(diagrams, [(step.top, step.after) for step in steps]).of(states, within)


def reaching(diagrams: Diagrams, states: Function, steps: Iterable[Step], within: Function | None = None) -> Function:
    """`states`, all of them in `within`, and from where `steps` lead to them without leaving it."""
    return _Closure(diagrams, [(step.top, step.before) for step in steps]).of(states, within)


class _Closure:
    def __init__(self, diagrams: Diagrams, steps: list[tuple[int, Fire]]) -> None:
        self._diagrams = diagrams
        steps = sorted(steps, key=lambda step: step[0])
        self._levels = [(top, [fire for _, fire in group]) for top, group in groupby(steps, key=lambda step: step[0])]
        self._memo: dict[tuple[int, Function, Function], Function] = {}

    def of(self, states: Function, within: Function | None) -> Function:
        self._memo.clear()
        return self._closed(0, states, self._diagrams.true if within is None else within)

    def _closed(self, index: int, states: Function, within: Function) -> Function:
        """`states` closed under all steps from the group `index` on."""
        if index == len(self._levels) or states == within or not states.satisfiable():
            return states
        key = (index, states, within)
        if key in self._memo:
            return self._memo[key]
        top, fires = self._levels[index]
        first = top
        for level in (states.node_level(), within.node_level()):
            if level is not None and level < first:
                first = level
        if first < top:
            high, low = _branches(states, first)
            high_within, low_within = _branches(within, first)
            closed = self._diagrams.bit(first).ite(
                self._closed(index, high, high_within), self._closed(index, low, low_within)
            )
        else:
            closed, before = states, None
            while closed != before:
                closed = self._closed(index + 1, closed, within)
                before = closed
                for fire in fires:
                    closed |= fire(closed) & within
        self._memo[key] = closed
        return closed


def _branches(function: Function, level: int) -> tuple[Function, Function]:
    """What is left of it where the bit at `level`, none after its first one, is set, and where it is not."""
    cofactors = function.cofactors()
    return (function, function) if cofactors is None or function.node_level() != level else cofactors
