"""Closing a set of states under steps in the two ways that come to mind first, in place of saturation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.transition_relation import TransitionStep

Fire = Callable[[Function], Function]
Close = Callable[[Diagrams, Function, Iterable[TransitionStep], Function | None], Function]


def breadth_first(diagrams: Diagrams, states: Function, fires: Iterable[Fire], within: Function) -> Function:
    """All steps from what the last ones have added."""
    fires = tuple(fires)
    frontier = states
    while frontier.satisfiable():
        frontier = diagrams.disjunction(fire(frontier) for fire in fires) & within & ~states
        states |= frontier
    return states


def chaining(_diagrams: Diagrams, states: Function, fires: Iterable[Fire], within: Function) -> Function:
    """One step after the other, each from all that there is, until none adds anything."""
    fires, before = tuple(fires), None
    while states != before:
        before = states
        for fire in fires:
            states |= fire(states) & within
    return states


ALGORITHMS: Mapping[str, Callable[[Diagrams, Function, Iterable[Fire], Function], Function]] = {
    "breadth-first": breadth_first,
    "chaining": chaining,
}


def closures(algorithm: str) -> tuple[Close, Close]:
    """What to use for `reachable` and for `reaching`."""
    close = ALGORITHMS[algorithm]

    def reachable(
        diagrams: Diagrams, states: Function, steps: Iterable[TransitionStep], within: Function | None = None
    ) -> Function:
        return close(diagrams, states, (step.after for step in steps), diagrams.true if within is None else within)

    def reaching(
        diagrams: Diagrams, states: Function, steps: Iterable[TransitionStep], within: Function | None = None
    ) -> Function:
        return close(diagrams, states, (step.before for step in steps), diagrams.true if within is None else within)

    return reachable, reaching
