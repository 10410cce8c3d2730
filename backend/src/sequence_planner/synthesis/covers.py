"""Few words for a set of states: a cover by cubes that together hold all of it, and nothing of another set.

What is in neither set does not matter. Each restricted variable of a cube is a literal, and there shall be few of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from sequence_planner.synthesis.diagrams import Diagrams, Function
from sequence_planner.synthesis.hitting import least_hitting
from sequence_planner.synthesis.primes import Cube, Primes

MOST_CUBES = 400  # to choose from; as long as there are no more in all, the cover has the fewest literals
_MOST_ROUNDS = 8  # of looking for better cubes, where there are more
_ORDERS = 12  # in which a cube is expanded


def cover(diagrams: Diagrams, on: Function, off: Function, most_literals: int) -> tuple[Cube, ...] | None:
    """Cubes that hold all of `on` and nothing of `off`, with few literals; None if that takes far more than the most.

    No literal can be widened or left out, and no cube be left out. `on` and `off` are apart, and neither is empty.
    """
    primes = Primes(diagrams, off)
    begin = primes.holding(on, 2 * most_literals)
    if begin is None:
        return None
    cover = _Cover(diagrams, primes, on, begin)
    best = cover.least(tuple(begin))
    literals = cover.literals(best)
    if literals > 2 * most_literals:
        return None
    if literals > _needed(diagrams, on, off):
        best = cover.least(best) if cover.complete() else cover.improved(best)
    return tuple(sorted(best, key=lambda cube: (len(primes.restricted(cube)), primes.restricted(cube))))


def _needed(diagrams: Diagrams, on: Function, off: Function) -> int:
    """A number of literals that no cover goes below: those of variables in which alone two states differ."""
    return sum((diagrams.exists(on, (name,)) & off).satisfiable() for name in diagrams.names)


class _Cover:
    """Chooses from the cubes found so far, which hold all of `on`."""

    def __init__(self, diagrams: Diagrams, primes: Primes, on: Function, found: dict[Cube, Function]) -> None:
        self._diagrams = diagrams
        self._primes = primes
        self._on = on
        self._found = found

    def literals(self, cubes: Iterable[Cube]) -> int:
        """How many the cubes have together."""
        return sum(len(self._primes.restricted(cube)) for cube in cubes)

    def complete(self) -> bool:
        """Find all cubes; False if they are too many."""
        every = self._primes.every(MOST_CUBES)
        for cube in every or ():
            self._add(cube)
        return every is not None

    def improved(self, best: tuple[Cube, ...]) -> tuple[Cube, ...]:
        """A cover as good as `best` or better."""
        for _ in range(_MOST_ROUNDS):
            known = len(self._found)
            self._vary(best)
            if len(self._found) == known:
                break
            best = self.least(best)
        return best

    def least(self, known: tuple[Cube, ...]) -> tuple[Cube, ...]:
        """Of the cubes found, those of fewest literals, then fewest cubes, that hold all; `known` do as well."""
        cubes = list(self._found)
        number = {cube: position for position, cube in enumerate(cubes)}
        weights = [self.literals((cube,)) for cube in cubes]

        def missed(chosen: frozenset[int]) -> list[int] | None:
            missing = self._on & ~self._held(cubes[each] for each in chosen)
            return self._holding(missing, cubes) if missing.satisfiable() else None

        start = frozenset(number[cube] for cube in self._irredundant(known))
        chosen = least_hitting(start, (weights, [1] * len(cubes)), missed)
        return self._irredundant(tuple(cubes[each] for each in sorted(chosen)))

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
