"""Ways: states from which others can be reached, in layers, so that what an edit takes away is looked at alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import zip_longest
from operator import or_

from sequence_planner.automaton.state_set import StateSet
from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.transition_relation import NodeLimit, TooMuchError, TransitionStep

# The layers of a way are its proof. From each state some step leads to an earlier layer or on within its own, in the
# first one to the target, so there is an order in which each state has a step to a lesser one. Where an edit takes
# steps away, that order holds in all states in which none of these began. The others need another way to an earlier
# layer, of any kind; one that has none is left out, and so is asked for what a step led to it from. What is left out in
# the end may lead to the target all the same: a way says only what is known.

MOST_LAYERS = 4  # that are kept; of more, several are one
_MOST_AROUND = 6  # steps that are looked for, around what was taken away
MOST_AGAIN = 3_000_000  # nodes, see `synthesis.transition_relation`, for all ways that an edit concerns


def joining(states: Function, target: Function, steps: Sequence[TransitionStep]) -> Function:
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


class LayeredWay:
    """States from which some of `target` can be reached without faults, in layers, each of which has those before it.

    Where it is as it was `kept`, its layers are read when they are asked for: of most only `states`, the last, are.
    """

    def __init__(
        self,
        target: Function,
        states: Function,
        layers: Callable[[], tuple[Function, ...]],
        kept: tuple[StateSet, ...] | None = None,
    ) -> None:
        self.target = target
        self.states = states
        self.kept = kept
        self._layers = layers

    @classmethod
    def in_layers(cls, target: Function, layers: Sequence[Function]) -> LayeredWay:
        """The way of these, in no more layers than are kept."""
        count = len(layers)
        chosen = tuple(layers)
        if count > MOST_LAYERS:
            numbers = sorted({count - 1 - (count - 1) * n // (MOST_LAYERS - 1) for n in range(MOST_LAYERS)})
            chosen = tuple(layers[number] for number in numbers)
        return cls(target, chosen[-1], lambda: chosen)

    @cached_property
    def layers(self) -> tuple[Function, ...]:
        """All layers."""
        return self._layers()

    def says(self, other: LayeredWay) -> bool:
        """Return whether it has all states of another one, and leads to the same or less."""
        return not (self.target & ~other.target).satisfiable() and not (other.states & ~self.states).satisfiable()


def joined(diagrams: Diagrams, ways: Iterable[LayeredWay], within: Function) -> tuple[Function, ...]:
    """The layers of several ways as those of one, within a set; nothing without ways."""
    every = [way.layers for way in ways]
    last = [layers[-1] for layers in every]
    found = [
        diagrams.disjunction(end if layer is None else layer for layer, end in zip(at, last, strict=True)) & within
        for at in zip_longest(*every)
    ]
    return tuple(found) or (diagrams.false,)


@dataclass(frozen=True)
class Removal:
    """The steps taken away by an edit: they began in the states `lost`, or led to those that are `gone`.

    `before` are the steps that there were, `now` those that there are, `within` what may be reached by these.
    """

    lost: Function
    gone: Function
    before: Sequence[TransitionStep]
    now: Sequence[TransitionStep]
    within: Function

    def still(self, way: LayeredWay, effort: NodeLimit) -> LayeredWay | None:
        """What is left of a way, as far as that is seen with so much `effort`; None if nothing is."""
        if not ((self.lost | self.gone) & way.states).satisfiable():
            return way
        layers: list[Function] = []
        with suppress(TooMuchError):
            layers.extend(self._sound(way, effort.limited(self.now)))
        return LayeredWay.in_layers(way.target, layers) if layers and layers[-1].satisfiable() else None

    def _sound(self, way: LayeredWay, steps: Sequence[TransitionStep]) -> Iterator[Function]:
        nothing = self.lost & ~self.lost
        sound, unsound = nothing, self.gone
        for number, layer in enumerate(way.layers):
            new = layer & self.within & ~sound & ~unsound
            # The first has what is of the target, and what gets there in one tick, which is as it was.
            ask = new & (self._leading_to(unsound) if number == 0 else self.lost | self._leading_to(unsound))
            asked = nothing
            while ask.satisfiable():
                asked |= ask
                left = ask & ~self._found(ask, sound, steps)
                new, unsound = new & ~left, unsound | left
                ask = new & self._leading_to(left) & ~asked if left.satisfiable() else left
            sound |= new
            yield sound
        if (left := way.states & self.within & ~sound).satisfiable():
            yield sound | joining(left, sound, steps)

    def _leading_to(self, states: Function) -> Function:
        """Where a step there was led to `states`."""
        found = states & ~states
        if states.satisfiable():
            for step in self.before:
                found |= step.before(states)
        return found

    def _found(self, states: Function, sound: Function, steps: Sequence[TransitionStep]) -> Function:
        """Those of `states` from which a way to what is `sound` is soon found."""
        around = new = states
        found = joining(around, sound, steps) & states
        for _ in range(_MOST_AROUND):
            if not (states & ~found).satisfiable():
                break
            after = new
            for step in steps:
                after |= step.after(new) & self.within
            new = after & ~around & ~sound
            if not new.satisfiable():
                break
            around |= new
            found = joining(around, sound, steps) & states
        return found
