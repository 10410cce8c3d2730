"""Runs of a station that are known, so that what can be reached need not be looked for from its beginning."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from sequence_planner.automaton.structure import State
from sequence_planner.automaton.tick import apply_effects, initial_state, synchronise
from sequence_planner.planning.plan import PlanTick
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.steps import Step
from sequence_planner.synthesis.traces import StepKind, Steps, Trace, TraceStep, Valuation, forbidding


@dataclass(frozen=True)
class KeptStep:
    """A step of a run for another model to take: after that of number `before`, or from the initial state `begin`."""

    before: int
    begin: State | None
    kind: StepKind
    names: tuple[str, ...]


@dataclass(frozen=True)
class Point:
    """A state that a run leads to: the step there from the point before, None at the beginning.

    `safely` if all states on the way are safe, `faultless` if no fault happens on it.
    """

    state: State
    before: Point | None = None
    step: TraceStep | None = None
    length: int = 0
    safely: bool = True
    faultless: bool = True


class Runs:
    """What is known to be reached in `plant`; `safe` are its safe states, the initial ones among them."""

    def __init__(self, plant: Plant, safe: Function) -> None:
        automaton = plant.automaton
        self._plant = plant
        self._safe = safe
        self._faults = frozenset(effect.name for effect in automaton.effects if effect.fault)
        abilities = tuple(each for each in automaton.abilities.values() if not each.restart)
        reliable = tuple(effect for effect in automaton.effects if not effect.fault)
        self._steps = {
            True: Steps(automaton, automaton.effects, abilities),
            False: Steps(automaton, reliable, abilities),
        }
        self._points: dict[tuple[bool, bool], list[Point]] = defaultdict(list)
        self._known: dict[tuple[bool, bool], Function] = defaultdict(lambda: plant.initial)
        self._taken: list[Point] = []

    def known(self, *, supervised: bool, faults: bool) -> Function:
        """The states that are known to be reached, as with `Inquiry.reached`."""
        return self._known[supervised, faults]

    def nearest(self, states: Function, *, supervised: bool, faults: bool) -> Point | None:
        """The point of the shortest known run to one of `states`; None if there is none."""
        if not (states & self._known[supervised, faults]).satisfiable():
            return None
        diagrams = self._plant.diagrams
        if (values := diagrams.pick(states & self._plant.initial)) is not None:
            return self._begun(values)
        points = sorted(self._points[supervised, faults], key=lambda point: point.length)
        return next(point for point in points if (diagrams.states(point.state) & states).satisfiable())

    def follow(self, ticks: Iterable[PlanTick]) -> None:
        """Take in what a plan from the initial state leads through, each step of it on the reference."""
        effects = {effect.name: effect for effect in self._plant.automaton.effects}
        reference = self._steps[False]
        point = Point(initial_state(self._plant.automaton))
        for tick in ticks:
            sensed = apply_effects(point.state, [effects[name] for name in tick.effects])
            assert sensed is not None
            point = self._extended(point, reference.tick(point.state, known_values(sensed)))
            for name in tick.starts:
                point = self._extended(point, reference.start(point.state, name))

    def kept(self) -> tuple[KeptStep, ...]:
        """All steps that are known, each after the one before it."""
        number: dict[int, int] = {}
        kept: list[KeptStep] = []
        for point in self._taken:
            before, step = point.before, point.step
            assert before is not None and step is not None
            begin = (
                None if before.step is not None else {name: before.state[name] for name in self._plant.diagrams.names}
            )
            kept.append(KeptStep(number.get(id(before), -1), begin, step.kind, step.names))
            number[id(point)] = len(kept) - 1
        return tuple(kept)

    def recall(self, kept: Iterable[KeptStep]) -> bool:
        """Take the steps of runs that were kept as far as they can be taken; returns whether all of them could."""
        points: list[Point | None] = []
        for each in kept:
            before = points[each.before] if each.begin is None else self._begun_like(each.begin)
            step = None if before is None else self._taken_again(before, each)
            points.append(None if before is None or step is None else self._extended(before, step))
        return None not in points

    def _begun_like(self, values: State) -> Point | None:
        """The beginning at these values, or at others where that is no initial state."""
        diagrams, initial = self._plant.diagrams, self._plant.initial
        known = ((diagrams.values(name), value) for name, value in values.items() if name in diagrams.bits)
        like = diagrams.conjunction(where[value] for where, value in known if value is not None and value in where)
        found = diagrams.pick(initial & like) or diagrams.pick(initial)
        return None if found is None else self._begun(found)

    def _taken_again(self, point: Point, kept: KeptStep) -> TraceStep | None:
        automaton, steps, (name, *_) = self._plant.automaton, self._steps[True], (*kept.names, "")
        match kept.kind:
            case StepKind.TICK:
                effects = [effect for effect in automaton.effects if effect.name in kept.names]
                sensed = apply_effects(point.state, effects)
                return None if sensed is None else steps.tick(point.state, known_values(sensed))
            case StepKind.ACTIVITY:
                return steps.turned(point.state, name)
            case _:
                return steps.start(point.state, name)

    def lead(self, point: Point, layers: Iterable[Function], steps: Sequence[Step], *, faults: bool) -> None:
        """Go on from `point` through one state of each of `layers`, by `steps`, which are faults only with `faults`."""
        diagrams = self._plant.diagrams
        for layer in layers:
            here = diagrams.states(point.state)
            after = diagrams.disjunction(step.after(here) for step in steps) & layer
            changes = diagrams.exported(after).nearest(point.state)
            assert changes is not None
            known = {name: changes.get(name, point.state[name]) for name in diagrams.names}
            point = self._extended(point, self._steps[faults].leading(point.state, known_values(known)))

    def _extended(self, point: Point, step: TraceStep | None) -> Point:
        """The point one step on, which is known from now on."""
        assert step is not None
        here = self._plant.diagrams.states(step.state)
        safely = point.safely and (here & self._safe).satisfiable()
        faultless = point.faultless and self._faults.isdisjoint(step.names)
        after = Point(step.state, point, step, point.length + 1, safely, faultless)
        self._taken.append(after)
        for supervised in (False, True) if safely else (False,):
            for faults in (False, True) if faultless else (True,):
                self._points[supervised, faults].append(after)
                self._known[supervised, faults] |= here
        return after

    def trace(self, point: Point) -> Trace:
        """The run to `point`."""
        steps: list[TraceStep] = []
        while point.before is not None and point.step is not None:
            steps.append(point.step)
            point = point.before
        return Trace(point.state, forbidding(self._plant.automaton, point.state), tuple(reversed(steps)))

    def _begun(self, values: State) -> Point:
        automaton = self._plant.automaton
        return Point(synchronise(automaton, {**automaton.initial_valuation, **values}))


def known_values(state: State) -> Valuation:
    """What is known of a state."""
    return {name: value for name, value in state.items() if value is not None}
