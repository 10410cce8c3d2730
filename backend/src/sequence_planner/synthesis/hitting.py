"""The least set that meets all sets of a family, of which only some need to be known (Moreno-Centeno & Karp 2013).

A solver proposes members; `missed` answers with a set of the family that they do not meet, which becomes a clause.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from itertools import count
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pysat.solvers import Solver

Missed = Callable[[frozenset[int]], Collection[int] | None]

# How many proposals are made in all, and how hard the solver thinks about one. They are counted, not timed, so that the
# answer is always the same.
MOST_PROPOSALS = 2_000
MOST_CONFLICTS = 20_000


def least_hitting(
    known: frozenset[int],
    criteria: Sequence[Sequence[int]],
    missed: Missed,
    family: Iterable[Collection[int]] = (),
    earliest: bool = False,
) -> frozenset[int]:
    """A set that meets all, of least weight by the first of `criteria`, then by the next ones.

    The members are numbered from 0; each criterion gives each of them a weight. With `earliest`, it is the set with the
    earliest members of those that are least. `known` meets all; where the effort is too great, the best set found.
    `family` are sets that are known to have to be met.
    """
    from pysat.solvers import Solver  # noqa: PLC0415 - see above

    clauses = [[member + 1 for member in each] for each in family]
    with Solver("glucose4", bootstrap_with=clauses) as solver:
        return _Search(solver, len(criteria[0]), missed).least(known, criteria, earliest)


class _Search:
    def __init__(self, solver: Solver, size: int, missed: Missed) -> None:
        self._solver = solver
        self._size = size
        self._missed = missed
        self._top = size
        self._proposals = count(1)
        self._tired = False  # it has thought too hard once, and would again
        solver.set_phases([-member for member in range(1, size + 1)])

    def least(self, known: frozenset[int], criteria: Sequence[Sequence[int]], earliest: bool) -> frozenset[int]:
        best, held = known, list[int]()
        for weights in criteria:
            best, bound = self._lightest(best, weights, held)
            held += bound
        return self._earliest(best, held) if earliest else best

    def _lightest(
        self, best: frozenset[int], weights: Sequence[int], held: Sequence[int]
    ) -> tuple[frozenset[int], list[int]]:
        """A set of least weight, and what says that no heavier ones are wanted."""
        from pysat.card import ITotalizer  # noqa: PLC0415 - see above

        weight = sum(weights[member] for member in best)
        counted = [member + 1 for member, each in enumerate(weights) for _ in range(each)]
        if weight == len(counted):  # nothing heavier exists, and with one more there is always a bound to set
            counted.append(self._fresh())
        with ITotalizer(counted, ubound=weight, top_id=self._top) as totals:
            self._solver.append_formula(totals.cnf.clauses)
            self._top = max(self._top, totals.top_id)
            more_than = list(totals.rhs)
        while weight > 0 and (found := self._found([*held, -more_than[weight - 1]])) is not None:
            best, weight = found, sum(weights[member] for member in found)
        return best, [-more_than[weight]]

    def _earliest(self, best: frozenset[int], held: Sequence[int]) -> frozenset[int]:
        """Of the sets that satisfy `held`, as `best` does, the one with the earliest members."""
        chosen = list(held)
        for member in range(self._size):
            if member not in best:
                best = self._found([*chosen, member + 1]) or best
            chosen.append(member + 1 if member in best else -(member + 1))
        return best

    def _found(self, assumptions: Sequence[int]) -> frozenset[int] | None:
        """A set that meets all; None if there is none, or none was found."""
        while not self._tired and next(self._proposals) <= MOST_PROPOSALS:
            self._solver.conf_budget(MOST_CONFLICTS)
            if not (answer := self._solver.solve_limited(assumptions)):
                self._tired = answer is None
                return None
            model = self._solver.get_model()
            assert model is not None
            proposed = frozenset(literal - 1 for literal in model if 0 < literal <= self._size)
            unmet = self._missed(proposed)
            if unmet is None:
                return proposed
            self._solver.add_clause([member + 1 for member in unmet])
        return None

    def _fresh(self) -> int:
        self._top += 1
        return self._top
