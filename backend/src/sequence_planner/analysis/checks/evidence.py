"""Evidence from an earlier model check: known runs and state sets, re-proven after an edit."""

from __future__ import annotations

from bisect import insort
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial

from sequence_planner.analysis.layered_ways import MOST_AGAIN, LayeredWay, Removal
from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import apply_effects, initial_state, synchronise
from sequence_planner.planning.problem import PlanTick
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.inclusion import included, lost
from sequence_planner.synthesis.traces import StepKind, Steps, Trace, TraceStep, Valuation, forbidding
from sequence_planner.synthesis.transition_relation import (
    NodeLimit,
    Plant,
    TooMuchError,
    TransitionStep,
    written_afterwards,
)

# Runs of a station that are known, so that what can be reached need not be looked for from its beginning.


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
    """The states known to be reached in `plant`; `safe` are its safe states, the initial ones among them."""

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
        self._points: dict[tuple[bool, bool], list[tuple[Point, Function]]] = defaultdict(list)  # the shortest first
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
        return next(point for point, here in self._points[supervised, faults] if (here & states).satisfiable())

    @property
    def furthest(self) -> Point:
        """The end of the longest run without faults in safe states, or else the initial state."""
        points = self._points[True, False]
        return points[-1][0] if points else Point(initial_state(self._plant.automaton))

    def follow(self, point: Point, ticks: Iterable[PlanTick]) -> None:
        """Take in what a plan from `point` leads through, each step of it on the reference."""
        effects = {effect.name: effect for effect in self._plant.automaton.effects}
        reference = self._steps[False]
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

    def lead(self, point: Point, layers: Iterable[Function], steps: Sequence[TransitionStep], *, faults: bool) -> None:
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
                insort(self._points[supervised, faults], (after, here), key=lambda each: each[0].length)
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
    """Return what is known of a state."""
    return {name: value for name, value in state.items() if value is not None}


# What answers about a model rest on, kept so that after an edit they need not be found again, but only proven again.
#
# It is plain data, and a proposal: of an edited model nothing of it is believed. A run is taken again, step by step, on
# the reference. A set that is said to have all that is reached is tested for having the initial states and for no step
# leading out, and what leads out of it is added. That from some states others can be reached holds where the edited
# model can do in them whatever the former could, which is found out by comparing the steps of the two, as sets; around
# those where it cannot, other steps are looked for (`analysis.layered_ways`).

MOST_ADDED = 6_000_000  # nodes, see `synthesis.transition_relation`, for what an edit adds to what is reached
_MOST_OF_TRAP = 1_000_000  # the same for what it adds to a trap


@dataclass(frozen=True)
class Evidence:
    """The evidence found of `automaton` under its `supervisor`, over the variables of `order`.

    `reached` has at least what is reached with the supervisor (True) and without, as found with parts of so large a
    `level`. `ways` are states, and more from which some of these can be reached within the former set without faults,
    in the layers of a `LayeredWay`. Nothing leads out of a trap without faults: of `traps` with the supervisor, of
    `bounds` without. With `guards_of_safe` too much is reached to look for guards there only.
    """

    automaton: Automaton
    supervisor: Supervisor
    order: tuple[str, ...]
    reached: Mapping[bool, StateSet]
    level: Mapping[bool, int]
    runs: tuple[KeptStep, ...]
    ways: tuple[tuple[StateSet, tuple[StateSet, ...]], ...]
    traps: tuple[StateSet, ...]
    bounds: tuple[StateSet, ...]
    guards_of_safe: bool = False

    def ordered(self, names: Iterable[str]) -> tuple[str, ...]:
        """`names` in its order, those that it does not have at last."""
        place = {name: position for position, name in enumerate(self.order)}
        return tuple(sorted(names, key=lambda name: place.get(name, len(place))))


def closed(states: Function, new: Function, steps: Sequence[TransitionStep], within: Function) -> Function:
    """`states`, and all that `steps` lead to within a set; out of them they lead from those that are `new` only.

    It is quick where these are few. Raises what the steps raise when that is too much.
    """
    while new.satisfiable():
        after = new
        for step in steps:
            after |= step.after(after) & within
        new = after & ~states
        states |= after
    return states


class Again:
    """The evidence kept of another model, in the `plant` of this one."""

    def __init__(self, plant: Plant, kept: Evidence) -> None:
        self.kept = kept
        self.exported: dict[Function, StateSet] = {}  # what need not be made plain data once more
        self._plant = plant
        diagrams = plant.diagrams
        added = [name for name in diagrams.names if name not in kept.order]
        others = [name for name in diagrams.names if name in kept.order]
        self._initially = diagrams.exists(plant.initial, others) if added else diagrams.true

    def states(self, kept: StateSet) -> Function:
        """A set of the other model; what this one has beside that is as it is initially."""
        diagrams = self._plant.diagrams
        states = diagrams.imported(kept) & self._initially & diagrams.valid
        if diagrams.names == self.kept.order:
            self.exported[states] = kept
        return states

    def ways(self, within: Function) -> Iterator[LayeredWay]:
        """The ways of the other model, as far as they are soon seen to be ways of this one."""
        if self._before is None:
            return
        begun = lost(self._plant.diagrams, self._before, self._now, self._there)
        if begun is None:
            return
        removal = Removal(begun, self._there & ~within, self._before, self._now, within)
        effort = NodeLimit(MOST_AGAIN)
        for target, layers in self.kept.ways:
            states = self.states(layers[-1]) & self._there
            way = LayeredWay(self.states(target), states, partial(self._layers, layers), self._as_kept(layers))
            if (still := removal.still(way, effort)) is not None:
                yield still

    def _layers(self, kept: tuple[StateSet, ...]) -> tuple[Function, ...]:
        return tuple(self.states(layer) & self._there for layer in kept)

    def _as_kept(self, layers: tuple[StateSet, ...]) -> tuple[StateSet, ...] | None:
        """The same, if they mean the same in the diagrams of this model."""
        return layers if self._plant.diagrams.names == self.kept.order else None

    def added(self, within: Function) -> Function:
        """Return what this model may reach of `within` and the other did not; nothing where the two differ too much."""
        return self._plant.diagrams.false if self._before is None else within & ~self._there

    def traps(self, within: Function) -> Iterator[Function]:
        """The traps of the other model, with all that leads out of them in this one; only what has changed is tried."""
        diagrams, changed, leaving = self._plant.diagrams, self._now, self._plant.diagrams.false
        if self._before is not None:
            changed = [each for each in changed if not included(diagrams, [each], self._before, within)]
            if (added := self.added(within)).satisfiable():
                leaving = diagrams.disjunction(step.before(added) for step in self._now)
        for kept in self.kept.traps:
            states = self.states(kept) & within
            edge = states & leaving
            new = diagrams.disjunction([*(s.after(states) for s in changed), *(s.after(edge) for s in self._now)])
            new &= within & ~states
            with suppress(TooMuchError):
                yield closed(states | new, new, NodeLimit(_MOST_OF_TRAP).limited(self._now), within)

    def bounds(self) -> Iterator[Function]:
        """The same without the supervisor."""
        for kept in self.kept.bounds:
            states = self.states(kept)
            if _is_closed(states, self._now, self._plant.diagrams.valid):
                yield states

    @cached_property
    def _there(self) -> Function:
        return self.states(self.kept.reached[True])

    @cached_property
    def _now(self) -> Sequence[TransitionStep]:
        return [*self._plant.helpful, *self._plant.all_starts]

    @cached_property
    def _before(self) -> Sequence[TransitionStep] | None:
        """The steps of the other model without faults, in the diagrams of this one; None where they differ too much."""
        automaton, order, diagrams = self.kept.automaton, self.kept.order, self._plant.diagrams
        domains = {name: automaton.variables[name].type.domain for name in order}
        if {name for name in diagrams.names if name in automaton.variables} != domains.keys():
            return None  # others have come to matter, or no longer do
        if not all(set(domain) <= set(diagrams.domains[name]) for name, domain in domains.items()):
            return None
        if not domains.keys() & written_afterwards(automaton, order) <= diagrams.bits_after.keys():
            return None
        before = Plant(automaton, order, diagrams=diagrams)
        return [*before.helpful, *before.all_starts]


def _is_closed(states: Function, steps: Iterable[TransitionStep], within: Function) -> bool:
    """Return whether no step leads out of `states` within a set."""
    return not any((step.after(states) & within & ~states).satisfiable() for step in steps)


def grown(effort: NodeLimit, kept: Function, steps: Sequence[TransitionStep], within: Function) -> Function:
    """Return what is reached, and perhaps more, as far as `kept` has it, and all that steps add to it."""
    states = kept & within
    return closed(states, states, NodeLimit(MOST_ADDED, whole=effort).limited(steps), within)
