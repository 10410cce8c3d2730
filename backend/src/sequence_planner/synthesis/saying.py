"""How a person is told which of two sets a state is in, where that can be said in few words, and where it cannot.

It is said over the fewest variables, in whichever is shorter of a disjunction and a conjunction of simple terms.
"""

from __future__ import annotations

from functools import cached_property, partial

from sequence_planner.expressions.syntax import FALSE, And, Expression, Or
from sequence_planner.expressions.types import Value
from sequence_planner.synthesis.covers import cover, single
from sequence_planner.synthesis.diagrams import Diagrams, Function
from sequence_planner.synthesis.effort import Effort, TooMuchError
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.primes import Cube, Primes
from sequence_planner.synthesis.separation import Separation
from sequence_planner.synthesis.wording import count_literals, worded

MOST_LITERALS = 60  # of a guard that people can still read
MOST_CASES = 3  # of those in which a start must wait, where there is no short guard
MOST_LITERALS_OF_CASE = 12
_LEAST = 50  # nodes, as which what is done with fewer counts: it takes as long
_CACHE = 1 << 16  # for sets over the few variables that tell them apart


class Saying:
    """Two sets of states of a plant that are apart, the second not empty; either way to say it takes so much `effort`
    at most, see `Effort`.
    """

    def __init__(self, plant: Plant, on: Function, off: Function, effort: int) -> None:
        self._plant = plant
        self._on = on
        self._off = off
        self._effort = effort

    def shortest(self) -> Expression | None:
        """Where `on` holds and `off` does not; None if it is too long, or not found."""
        if not self._on.satisfiable():
            return FALSE
        needed = len(self._separation.names)  # each of them has to be read
        if needed > MOST_LITERALS:
            return None
        # What one cube says is soon found, and often all that has to be said. As wide as it can be where it is allowed,
        # and as narrow where it is not, it says the same as the two forms of a cover would.
        ways = (
            (single, True),
            (partial(single, widest=False), False),
            (cover, True),
            (cover, False),
        )
        shortest: Expression | None = None
        for find, allowed in ways:
            longest = MOST_LITERALS if shortest is None else count_literals(shortest)
            one, other = self._few if allowed else reversed(self._few)
            cubes = find(self._diagrams, one, other, self._new_effort(), longest)
            text = None if cubes is None else self._worded(cubes, allowed)
            if text is not None and count_literals(text) <= longest:
                shortest = text if shortest is None else min(shortest, text, key=_length)
                if _length(shortest) <= (needed, False):
                    break
        return shortest

    def blocked(self) -> tuple[Expression, ...]:
        """Some conditions wherever one of which holds, `off` does, the one nearest to the initial state first.

        What is as there is left out of them first; long ones are not said.
        """
        diagrams, initial = self._diagrams, self._initially
        on, off = self._few
        primes = Primes(diagrams, on, self._new_effort())
        found: list[Expression] = []
        try:
            for _ in range(MOST_CASES):
                changes = diagrams.exported(off, diagrams.names).nearest(initial)
                if changes is None:
                    break
                state = {**initial, **changes}
                cube = tuple(1 << domain.index(state[name]) for name, domain in diagrams.domains.items())
                cube = primes.expanded(cube, sorted(primes.axes, key=lambda axis: diagrams.names[axis] in changes))
                off &= ~primes.function(cube)
                if len(primes.restricted(cube)) <= MOST_LITERALS_OF_CASE:
                    found.append(self._worded((cube,), allowed=True))
        except TooMuchError:
            pass
        return tuple(found)

    def _new_effort(self) -> Effort:
        return Effort(self._effort, _LEAST)

    @cached_property
    def _separation(self) -> Separation:
        return Separation(self._plant, self._on, self._off, self._new_effort())

    @cached_property
    def _diagrams(self) -> Diagrams:
        types = self._plant.automaton.types
        return Diagrams({name: types[name].domain for name in self._separation.names}, cache=_CACHE)

    @cached_property
    def _few(self) -> tuple[Function, Function]:
        """Both sets over what tells them apart."""
        on, off = (self._separation.over(self._diagrams, states) for states in (self._on, self._off))
        return on, off

    @cached_property
    def _initially(self) -> dict[str, Value]:
        """What has which value in an initial state, of what tells the sets apart."""
        plant = self._plant
        state = plant.diagrams.pick(plant.initial)
        assert state is not None
        one = plant.diagrams.states(state)
        lookups = {name: plant.reader.lookup(name) for name in self._diagrams.names}
        return {
            name: state[name] if name in state else (values[True] & one).satisfiable()
            for name, values in lookups.items()
        }

    def _worded(self, cubes: tuple[Cube, ...], allowed: bool) -> Expression:
        return worded(self._plant.automaton.types, self._diagrams, cubes, allowed)


def _length(expression: Expression) -> tuple[int, bool]:
    """How long it is to read; of two that are alike, a conjunction says one reason after the other."""
    mixed = isinstance(expression, Or) and any(isinstance(part, And) for part in expression.operands)
    return count_literals(expression), mixed
