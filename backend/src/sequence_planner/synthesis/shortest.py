"""Shortest traces into a set of states: breadth first over sets of states, and back from the end (`traces`)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sequence_planner.automaton.structure import State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.types import Value
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.steps import Step
from sequence_planner.synthesis.traces import Steps, Trace, TraceStep, Valuation, forbidding

MOST_NODES = 5_000_000  # of the layers, each for every step that is taken from it


class Tracer:
    """Finds traces of a plant. Without `starts` or `faults` such steps are not taken; nothing leaves `within`."""

    def __init__(
        self, plant: Plant, *, starts: bool = True, faults: bool = True, within: Function | None = None
    ) -> None:
        self._plant = plant
        self._within = plant.diagrams.valid if within is None else within
        uncontrollable = plant.uncontrollable if faults else plant.helpful
        begun = [step for steps in plant.starts.values() for step in steps] if starts else []
        self._steps: list[Step] = [*uncontrollable, *begun]
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
        """Whether some of `begin` leads into `goal`, and that is soon found."""
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
