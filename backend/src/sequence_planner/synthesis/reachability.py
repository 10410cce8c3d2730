"""Symbolic reachability by saturation, and shortest traces into a set of states."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import groupby

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.language.types import Value
from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.traces import Steps, Trace, TraceStep, Valuation, forbidding
from sequence_planner.synthesis.transition_relation import Plant, TransitionStep

# All states that steps lead to or come from, by saturation (Ciardo et al. 2001; Meijer & van de Pol 2016).
#
# Steps are grouped by the first level that they touch. A set is closed under those further down first, branch by branch
# below the levels that these do not touch, so that most of the work is done on small diagrams and is shared.

Fire = Callable[[Function], Function]


def reachable(
    diagrams: Diagrams, states: Function, steps: Iterable[TransitionStep], within: Function | None = None
) -> Function:
    """`states`, all of them in `within`, and where `steps` lead from them without leaving it."""
    return _Closure(diagrams, [(step.top, step.after) for step in steps]).of(states, within)


def reaching(
    diagrams: Diagrams, states: Function, steps: Iterable[TransitionStep], within: Function | None = None
) -> Function:
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
    """Return what is left of it where the bit at `level`, none after its first one, is set, and where it is not."""
    cofactors = function.cofactors()
    return (function, function) if cofactors is None or function.node_level() != level else cofactors


# Shortest traces into a set of states: breadth first over sets of states, and back from the end (`traces`).

MOST_NODES = 5_000_000  # of the layers, each for every step that is taken from it


class Tracer:
    """Finds traces of a plant. Without `starts` or `faults` such steps are not taken; nothing leaves `within`."""

    def __init__(
        self, plant: Plant, *, starts: bool = True, faults: bool = True, within: Function | None = None
    ) -> None:
        self._plant = plant
        self._within = plant.diagrams.valid if within is None else within
        uncontrollable = plant.uncontrollable if faults else plant.helpful
        begun = plant.all_starts if starts else []
        self._steps: list[TransitionStep] = [*uncontrollable, *begun]
        automaton = plant.automaton
        self._reference = Steps(
            automaton,
            tuple(effect for effect in automaton.effects if faults or not effect.fault),
            tuple(automaton.abilities[name] for name in plant.starts) if starts else (),
        )

    def shortest(self, goal: Function, begin: Function | None = None) -> Trace | None:
        """A trace with the fewest steps into `goal` from an initial state, one of `begin`.

        It ends near where it began, and changes little on its way. None if there is none, or it takes too long to find.
        """
        initial = self._plant.initial if begin is None else self._plant.initial & begin
        way = self._way(goal, initial, self._plant.automaton.initial_valuation)
        if way is None:
            return None
        first = synchronise(self._plant.automaton, {**self._plant.automaton.initial_valuation, **way[0]})
        forbidden_by = forbidding(self._plant.automaton, first)
        return Trace(first, forbidden_by, tuple(self._replayed(first, way[1:])))

    def leads(self, goal: Function, begin: Function) -> bool:
        """Return whether some of `begin` leads into `goal`, and that is soon found."""
        return self._layers(goal, begin) is not None

    def onward(self, trace: Trace, goal: Function) -> Trace | None:
        """`trace`, and then the fewest steps that lead on into `goal`; None as above."""
        way = self._way(goal, self._plant.diagrams.states(trace.last), trace.last)
        if way is None:
            return None
        return trace.and_then(*self._replayed(trace.last, way[1:]))

    def started(self, trace: Trace, name: str) -> Trace:
        """`trace`, and then the start `name`, or that transition, whose guard must hold."""
        step = self._reference.start(trace.last, name)
        assert step is not None
        return trace.and_then(step)

    def ticked(self, trace: Trace, wanted: Valuation) -> Trace:
        """`trace`, and then a tick in which measured variables get the values `wanted`; such a one must be there."""
        step = self._reference.tick(trace.last, wanted)
        assert step is not None
        return trace.and_then(step)

    def _way(self, goal: Function, begin: Function, near: State) -> list[dict[str, Value]] | None:
        """The states of a shortest way; its ends near a state."""
        layers = self._layers(goal, begin)
        if layers is None:
            return None
        diagrams = self._plant.diagrams
        way = [self._nearest(layers.pop() & goal, near)]
        for layer in reversed(layers):
            target = diagrams.states(way[-1])
            before = diagrams.disjunction(step.before(target) for step in self._steps) & layer
            way.append(self._nearest(before, way[-1]))
        return way[::-1]

    def _layers(self, goal: Function, begin: Function) -> list[Function] | None:
        """The states first met after 0, 1, 2, ... steps, up to those of which some are in `goal`."""
        diagrams = self._plant.diagrams
        layers = [begin & self._within]
        seen = layers[0]
        effort = 0
        while not (layers[-1] & goal).satisfiable():
            effort += layers[-1].node_count() * len(self._steps)
            after = diagrams.disjunction(step.after(layers[-1]) for step in self._steps)
            layers.append(after & self._within & ~seen)
            if not layers[-1].satisfiable() or effort > MOST_NODES:
                return None
            seen |= layers[-1]
        return layers

    def _nearest(self, states: Function, to: State) -> dict[str, Value]:
        """The one of `states` that differs from `to` in as few variables as possible."""
        diagrams = self._plant.diagrams
        changes = diagrams.exported(states).nearest(to)
        assert changes is not None
        values = {name: changes.get(name, to[name]) for name in diagrams.names}
        return {name: value for name, value in values.items() if value is not None}

    def _replayed(self, state: State, way: Sequence[dict[str, Value]]) -> Iterator[TraceStep]:
        for wanted in way:
            step = self._reference.leading(state, wanted)
            state = step.state
            yield step
