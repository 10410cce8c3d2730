"""Cubes, which say for some variables what values they may have, and the largest of those that miss a set of states.

They are found by expansion, or all of them by cutting off what must be missed, as the minimisation of logic knows it
(Brayton et al. 1984), over variables of many values (Rudell & Sangiovanni-Vincentelli 1987).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from sequence_planner.synthesis.diagrams import Diagrams, Function
from sequence_planner.synthesis.effort import Effort

# For each variable of the diagrams, the positions in its domain of the values it may have, as bits of a number.
Cube = tuple[int, ...]

_MOST_PIECES = 4_000  # of cubes while something is cut off from them


class Primes:
    """The largest cubes that hold nothing of `off`. Raises `TooMuchError` when they take more than `effort`."""

    def __init__(self, diagrams: Diagrams, off: Function, effort: Effort) -> None:
        self._diagrams = diagrams
        self._off = off
        self.effort = effort
        self._literals: dict[tuple[int, int], Function] = {}
        self.whole = tuple((1 << len(domain)) - 1 for domain in diagrams.domains.values())
        self.axes = range(len(self.whole))

    def function(self, cube: Cube) -> Function:
        """The states that a cube holds, and perhaps some that do not exist."""
        return self._diagrams.conjunction(self._literal(axis, cube[axis]) for axis in reversed(self.restricted(cube)))

    def restricted(self, cube: Cube) -> list[int]:
        """The variables that have a literal in it."""
        return [axis for axis in self.axes if cube[axis] != self.whole[axis]]

    def holding(self, states: Function, most: int, literals: int | None = None) -> dict[Cube, Function] | None:
        """Cubes that together hold `states`; None if there would be more than `most`, or more than so many literals."""
        found: dict[Cube, Function] = {}
        while states.satisfiable():
            if len(found) == most:
                return None
            cube = self.expanded(self.around(states, one=True), self.axes, states)
            if literals is not None:
                literals -= len(self.restricted(cube))
                if literals < 0:
                    return None
            found[cube] = self.function(cube)
            states &= ~found[cube]
        return found

    def around(self, states: Function, one: bool = False) -> Cube:
        """The smallest cube that holds all of the states, or else one of them."""
        if one:
            state = self._diagrams.pick(states)
            assert state is not None
            return tuple(1 << domain.index(state[name]) for name, domain in self._diagrams.domains.items())
        return tuple(
            sum(
                1 << position
                for position, where in enumerate(self._diagrams.values(name).values())
                if (states & where).satisfiable()
            )
            for name in self._diagrams.names
        )

    def expanded(self, cube: Cube, order: Iterable[int], wanted: Function | None = None, widest: bool = True) -> Cube:
        """A largest cube that holds `cube`: literals are left out in `order`, then the others widened, if `widest`.

        With `wanted`, the literal without which it holds most of that goes first.
        """
        axes = list(order)
        if wanted is None:
            for axis in axes:
                if self.fits(freed := _with(cube, axis, self.whole[axis])):
                    cube = freed
        else:
            cube = self._freed_for(wanted, cube, axes)
        return self._widened(cube, axes) if widest else cube

    def _freed_for(self, wanted: Function, cube: Cube, axes: Iterable[int]) -> Cube:
        left = list(axes)
        while True:
            freed = self._freed(cube)
            gains = {axis: self._gain(freed[axis], wanted) for axis in left}
            left = [axis for axis in left if gains[axis] >= 0]  # a literal that is needed stays so in larger cubes
            if not left:
                return cube
            best = max(left, key=gains.__getitem__)
            cube = _with(cube, best, self.whole[best])
            left.remove(best)

    def _widened(self, cube: Cube, axes: Iterable[int]) -> Cube:
        for axis in axes:
            for position in range(self.whole[axis].bit_length()):
                wider = _with(cube, axis, cube[axis] | 1 << position)
                if wider != cube and self.fits(wider):
                    cube = wider
        return cube

    def every(self, most: int) -> list[Cube] | None:
        """All of them; None if they are too many."""
        excluded = Primes(self._diagrams, self._diagrams.valid & ~self._off, self.effort).holding(self._off, most)
        return None if excluded is None else self._missing(excluded, most)

    def _missing(self, excluded: Iterable[Cube], most: int) -> list[Cube] | None:
        """The largest cubes that have nothing in common with any of `excluded`; None if they are too many.

        Each excluded cube is cut off by taking its values from one variable.
        """
        widths = [mask.bit_length() for mask in self.whole]
        found = [self.whole]
        for cut in excluded:
            met = {cube for cube in found if all(a & b for a, b in zip(cube, cut, strict=True))}
            pieces = {
                _with(cube, axis, left) for cube in met for axis, mask in enumerate(cut) if (left := cube[axis] & ~mask)
            }
            if len(pieces) > _MOST_PIECES:
                return None
            self.effort.use(len(pieces) * (len(found) + len(pieces)))
            found = _largest([cube for cube in found if cube not in met], pieces, widths)
            if len(found) > most:
                return None
        return found

    def _freed(self, cube: Cube) -> list[Function]:
        """What the cube holds without its literal of each variable."""
        true = self._diagrams.true
        literals = [self._literal(a, cube[a]) if cube[a] != self.whole[a] else true for a in self.axes]
        before = [true]
        for literal in literals:
            before.append(before[-1] & literal)
        freed, after = before[:-1], true
        for axis in reversed(self.axes):
            freed[axis] &= after
            after &= literals[axis]
        return freed

    def _gain(self, freed: Function, wanted: Function) -> int:
        """How much of `wanted` is in what is left of a cube; less than nothing if that is too large."""
        self.effort.spend(freed)
        return -1 if (freed & self._off).satisfiable() else self._diagrams.count(freed & wanted)

    def fits(self, cube: Cube) -> bool:
        """Whether the cube holds nothing of `off`."""
        self.effort.spend(self._off)
        return not (self.function(cube) & self._off).satisfiable()

    def _literal(self, axis: int, mask: int) -> Function:
        if (axis, mask) not in self._literals:
            values = self._diagrams.values(self._diagrams.names[axis]).values()
            allowed = (where for position, where in enumerate(values) if mask >> position & 1)
            self._literals[axis, mask] = self._diagrams.disjunction(allowed)
        return self._literals[axis, mask]


def _with(cube: Cube, axis: int, mask: int) -> Cube:
    return (*cube[:axis], mask, *cube[axis + 1 :])


def _largest(apart: Sequence[Cube], pieces: Iterable[Cube], widths: Sequence[int]) -> list[Cube]:
    """`apart`, and those of `pieces` that are within no other cube."""
    kept = {cube: _packed(cube, widths) for cube in apart}
    for piece in sorted(pieces, key=lambda cube: (-sum(mask.bit_count() for mask in cube), cube)):
        values = _packed(piece, widths)
        if all(values | other != other for other in kept.values()):
            kept[piece] = values
    return list(kept)


def _packed(cube: Cube, widths: Sequence[int]) -> int:
    """The values of all variables as bits of one number."""
    packed = 0
    for mask, width in zip(cube, widths, strict=True):
        packed = packed << width | mask
    return packed
