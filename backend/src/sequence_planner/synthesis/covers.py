"""Few words for a set of states: a cover by cubes that together hold all of it, and nothing of another set.

What is in neither set does not matter. Each restricted variable of a cube is a literal, and there shall be few of them.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence

from sequence_planner.synthesis.diagrams import Diagrams, Function
from sequence_planner.synthesis.effort import Effort, TooMuchError
from sequence_planner.synthesis.hitting import least_hitting
from sequence_planner.synthesis.primes import Cube, Primes

MOST_CUBES = 400  # to choose from; as long as there are no more in all, the cover has the fewest literals
_MOST_ROUNDS = 8  # of looking for better cubes, where there are more
_NEEDLESS = 2  # times as many literals as wanted are too many to go on, of which few will be left out
_ORDERS = 12  # in which a cube is expanded


def single(
    diagrams: Diagrams, on: Function, off: Function, effort: Effort, most_literals: int, widest: bool = True
) -> tuple[Cube] | None:
    """A cube that alone holds all of `on` and nothing of `off`, if there is one; its values are the `widest` or least.

    No literal can be left out, and there are `most_literals` at most.
    """
    primes = Primes(diagrams, off, effort)
    try:
        around = primes.around(on)
        if not primes.fits(around):
            return None
        cube = primes.expanded(around, primes.axes, widest=widest)
    except TooMuchError:
        return None
    return (cube,) if len(primes.restricted(cube)) <= most_literals else None


def cover(
    diagrams: Diagrams, on: Function, off: Function, effort: Effort, most_literals: int
) -> tuple[Cube, ...] | None:
    """Cubes that hold all of `on` and nothing of `off`, with few literals; None if that takes far more than the most.

    No literal can be widened or left out, and no cube be left out. `on` and `off` are apart, and neither is empty. No
    more than `effort` is spent: where there is a cover by then, it may not have the fewest literals.
    """
    primes = Primes(diagrams, off, effort)
    try:
        begin = primes.holding(on, MOST_CUBES, _NEEDLESS * most_literals)
    except TooMuchError:
        return None
    if begin is None:
        return None
    chosen = _Cover(diagrams, primes, on, begin)
    with contextlib.suppress(TooMuchError):
        chosen.improve(_needed(diagrams, on, off))
    return tuple(sorted(chosen.best, key=lambda cube: (len(primes.restricted(cube)), primes.restricted(cube))))


def _needed(diagrams: Diagrams, on: Function, off: Function) -> int:
    """A number of literals that no cover goes below: those of variables in which alone two states differ."""
    return sum((diagrams.exists(on, (name,)) & off).satisfiable() for name in diagrams.names)


class _Cover:
    """Chooses from the cubes found so far, which hold all of `on`; those of `best` do as well."""

    def __init__(self, diagrams: Diagrams, primes: Primes, on: Function, found: dict[Cube, Function]) -> None:
        self._diagrams = diagrams
        self._primes = primes
        self._on = on
        self._found = found
        self.best = self._irredundant(tuple(found))

    def literals(self, cubes: Iterable[Cube]) -> int:
        """How many the cubes have together."""
        return sum(len(self._primes.restricted(cube)) for cube in cubes)

    def improve(self, needed: int) -> None:
        """Find the best cover, or a good one where there are too many cubes. None has fewer than `needed` literals."""
        if len(self.best) > 1:
            self._choose()
        if needed < self.literals(self.best):
            if self._complete():
                self._choose()
            else:
                self._look_around()

    def _complete(self) -> bool:
        """Find all cubes; False if they are too many."""
        every = self._primes.every(MOST_CUBES)
        for cube in every or ():
            self._add(cube)
        return every is not None

    def _look_around(self) -> None:
        """Find cubes that are better."""
        for _ in range(_MOST_ROUNDS):
            known = len(self._found)
            self._vary(self.best)
            if len(self._found) == known:
                break
            self._choose()

    def _choose(self) -> None:
        """Of the cubes found, those of fewest literals, then fewest cubes, that hold all."""
        cubes = list(self._found)
        number = {cube: position for position, cube in enumerate(cubes)}
        weights = [self.literals((cube,)) for cube in cubes]

        def missed(chosen: frozenset[int]) -> list[int] | None:
            missing = self._on & ~self._held(cubes[each] for each in chosen)
            return self._holding(missing, cubes) if missing.satisfiable() else None

        start = frozenset(number[cube] for cube in self.best)
        chosen = least_hitting(start, (weights, [1] * len(cubes)), missed)
        self.best = self._irredundant(tuple(cubes[each] for each in sorted(chosen)))

    def _vary(self, cubes: Sequence[Cube]) -> None:
        """Find other cubes for what each of `cubes` alone holds, all of it or a part."""
        for cube in cubes:
            own = self._on & self._found[cube] & ~self._held(other for other in cubes if other != cube)
            for start in (self._primes.around(own), self._primes.around(own, one=True)):
                for order in self._orders():
                    if len(self._found) < MOST_CUBES:
                        self._add(self._primes.expanded(start, order))

    def _add(self, cube: Cube) -> None:
        if cube not in self._found:
            function = self._primes.function(cube)
            if (function & self._on).satisfiable():
                self._found[cube] = function

    def _held(self, cubes: Iterable[Cube]) -> Function:
        return self._diagrams.disjunction(self._found[cube] for cube in cubes)

    def _holding(self, states: Function, cubes: Sequence[Cube]) -> list[int]:
        """The cubes that hold one of `states`, of which few cubes do."""
        for cube in cubes:
            self._primes.effort.spend(states)
            if (rest := states & ~self._found[cube]).satisfiable():
                states = rest
        return [each for each, cube in enumerate(cubes) if (states & self._found[cube]).satisfiable()]

    def _irredundant(self, cubes: tuple[Cube, ...]) -> tuple[Cube, ...]:
        """`cubes` without those that the others make needless."""
        kept = cubes
        for cube in sorted(cubes, key=lambda each: -self.literals((each,))):
            others = tuple(other for other in kept if other != cube)
            if not (self._on & ~self._held(others)).satisfiable():
                kept = others
        return kept

    def _orders(self) -> Iterator[list[int]]:
        """Some orders of the variables, forwards and backwards."""
        axes = list(self._primes.axes)
        for first in range(0, len(axes), max(1, 2 * len(axes) // _ORDERS)):
            turned = axes[first:] + axes[:first]
            yield turned
            yield turned[::-1]
