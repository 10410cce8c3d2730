"""What answers about a model rest on, kept so that after an edit they need not be found again, but only proven again.

It is plain data, and a proposal: of an edited model nothing of it is believed. A run is taken again, step by step, on
the reference. A set that is said to have all that is reached is tested for having the initial states and for no step
leading out, and what leads out of it is added. That from some states others can be reached holds where the edited model
can do in them whatever the former could, which is found out by comparing the steps of the two, as sets.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, reduce
from operator import or_

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.checking.runs import KeptStep
from sequence_planner.synthesis.diagrams import Function
from sequence_planner.synthesis.effort import Effort, TooMuchError
from sequence_planner.synthesis.inclusion import included
from sequence_planner.synthesis.plant import Plant, written_afterwards
from sequence_planner.synthesis.steps import Step

MOST_ADDED = 6_000_000  # nodes, see `synthesis.effort`, for what an edit adds to what is reached
_MOST_OF_TRAP = 1_000_000  # the same for what it adds to a trap


@dataclass(frozen=True)
class Evidence:
    """What was found of `automaton` under its `supervisor`, over the variables of `order`.

    `reached` has at least what is reached with the supervisor (True) and without, as found with parts of so large a
    `level`. `ways` are states, and more from which some of these can be reached within the former set without faults.
    Nothing leads out of a trap without faults: of `traps` with the supervisor, of `bounds` without.
    """

    automaton: Automaton
    supervisor: Supervisor
    order: tuple[str, ...]
    reached: Mapping[bool, StateSet]
    level: Mapping[bool, int]
    runs: tuple[KeptStep, ...]
    ways: tuple[tuple[StateSet, StateSet], ...]
    traps: tuple[StateSet, ...]
    bounds: tuple[StateSet, ...]

    def ordered(self, names: Iterable[str]) -> tuple[str, ...]:
        """`names` in its order, those that it does not have at last."""
        place = {name: position for position, name in enumerate(self.order)}
        return tuple(sorted(names, key=lambda name: place.get(name, len(place))))


def closed(states: Function, new: Function, steps: Sequence[Step], within: Function) -> Function:
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


def joining(states: Function, target: Function, steps: Sequence[Step]) -> Function:
    """Those of `states` from which `steps` lead to `target` without leaving them; quick where they are few."""
    images = [step.after(states) for step in steps]
    left, new = states & ~target, target
    while new.satisfiable():
        reached = (
            step.before(there)
            for step, image in zip(steps, images, strict=True)
            if (there := image & new).satisfiable()
        )
        new = left & reduce(or_, reached, left & ~left)
        left &= ~new
    return states & ~left


class Again:
    """What was kept of another model, in the `plant` of this one."""

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
        states = diagrams.recalled(kept) & self._initially & diagrams.valid
        if diagrams.names == self.kept.order:
            self.exported[states] = kept
        return states

    def ways(self, within: Function) -> Iterator[tuple[Function, Function]]:
        """The ways of the other model, if that can do nothing in the states they are about that this one cannot."""
        if self._before is None or (self._there & ~within).satisfiable():
            return
        if included(self._plant.diagrams, self._before, self._now, self._there):
            for target, states in self.kept.ways:
                yield self.states(target), self.states(states) & self._there

    def added(self, within: Function) -> Function:
        """What this model may reach of `within` and the other did not; nothing where the two differ too much."""
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
                yield closed(states | new, new, Effort(_MOST_OF_TRAP).limited(self._now), within)

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
    def _now(self) -> Sequence[Step]:
        return [*self._plant.helpful, *(step for steps in self._plant.starts.values() for step in steps)]

    @cached_property
    def _before(self) -> Sequence[Step] | None:
        """What the other model can do without faults, in the diagrams of this one; None where they differ too much."""
        automaton, order, diagrams = self.kept.automaton, self.kept.order, self._plant.diagrams
        domains = {name: automaton.variables[name].type.domain for name in order}
        if {name for name in diagrams.names if name in automaton.variables} != domains.keys():
            return None  # others have come to matter, or no longer do
        if not all(set(domain) <= set(diagrams.domains[name]) for name, domain in domains.items()):
            return None
        if not domains.keys() & written_afterwards(automaton, order) <= diagrams.bits_after.keys():
            return None
        before = Plant(automaton, order, diagrams=diagrams)
        return [*before.helpful, *(step for steps in before.starts.values() for step in steps)]


def _is_closed(states: Function, steps: Iterable[Step], within: Function) -> bool:
    """Whether no step leads out of `states` within a set."""
    return not any((step.after(states) & within & ~states).satisfiable() for step in steps)


def grown(effort: Effort, kept: Function, steps: Sequence[Step], within: Function) -> Function:
    """What is reached, and perhaps more, as far as `kept` has it, and all that steps add to it."""
    states = kept & within
    return closed(states, states, Effort(MOST_ADDED, whole=effort).limited(steps), within)
