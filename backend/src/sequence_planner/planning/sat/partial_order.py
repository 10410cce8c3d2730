"""The order of single starts: of runs that differ only in the order of starts that do not matter to each other, one.

Two starts that follow one another, of which neither reads or writes what the other writes, can change places. Done as
long as the second comes first in the order of the automaton, this ends in a run in which no start comes right after
such a one (partial order reduction: Valmari 1990, Godefroid and Wolper 1991). So these runs are enough to look at,
where only the end counts.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import Final, NamedTuple

from sequence_planner.planning.demands import Starts
from sequence_planner.planning.sat.encoding import SymbolicTick

# Of each start, by its place, those places from its own on that it may come right after; None where it may any.
Succession = Sequence[Sequence[int] | None]


class Singly(NamedTuple):
    """The way starts are taken one at a time: which after which, and what they ask for, if anybody knows it already."""

    succession: Succession = ()
    starts: Starts | None = None


ANY_START: Final = Singly()

Places = int  # a set of them, a bit each

_MOST = 120  # places that a start may come after: beyond, to say so takes longer than it spares


def in_order(succession: Succession, before: SymbolicTick, tick: SymbolicTick) -> Iterator[list[int]]:
    """The clauses that say a start of `tick` comes right after one of `before` that it may come after."""
    yield [-tick.earlier[-1], before.earlier[-1]]  # who has come to rest stays there
    for place, after in enumerate(succession):
        if after is not None:
            own = [-tick.starts[place][1], *(before.starts[other][1] for other in after)]
            yield [*own, before.earlier[place - 1]] if place else own


def succession(starts: Starts, order: Sequence[str], pause: Callable[[], object] = lambda: None) -> Succession:
    """For starts that are taken one at a time, in any `order`. `pause` is called before each, and may raise."""
    demands = [starts[name] for name in order]
    touched = [each.reads | each.written | starts.guarded(name) for name, each in zip(order, demands, strict=True)]
    touching: dict[str, Places] = defaultdict(int)  # of those that read or write a variable, and of those that write it
    writing: dict[str, Places] = defaultdict(int)
    for place, start in enumerate(demands):
        for name in touched[place]:
            touching[name] |= 1 << place
        for name in start.written:
            writing[name] |= 1 << place
    found: list[list[int] | None] = []
    for place, start in enumerate(demands):
        pause()
        related: Places = 0
        for name in touched[place]:
            related |= touching[name] if name in start.written else writing[name]
        possible = (other for other in _places(related, place) if not demands[other].excludes(start))
        after = list(islice(possible, _MOST + 1))
        found.append(after if len(after) <= _MOST else None)
    return found


def _places(places: Places, least: int) -> Iterator[int]:
    """Those from `least` on."""
    places >>= least
    while places:
        lowest = places & -places
        yield lowest.bit_length() - 1 + least
        places ^= lowest
