"""The fewest starts of plans with so many ticks.

Sets of starts are collected of which every plan has one, until a plan has no more starts than these demand (Morgado et
al. 2014, *Core-guided MaxSAT with soft cardinality constraints*). Where there is no time for that, the starts of one
plan that it can do without are left out. Starts of one ability are counted together, as it is seldom needed twice.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import Contract, Plan
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.unrolling import Unrolling

# Of the time that is left, what it may cost to look for fewer starts of a fast plan.
_SHARE = 0.02
_PROVING = 0.8  # and of a minimal one, first without needless starts and then with the fewest

Counter = Callable[[int], int]  # for a number, a literal that is true where there are more


class Fewest:
    """Plans of `length` ticks, of which the first `starting` have starts, under the assumptions `given`.

    The solver has just found one.
    """

    def __init__(self, unrolling: Unrolling, given: Sequence[int], length: int, starting: int) -> None:
        self._unrolling = unrolling
        self._given = given
        self._length = length
        self._starting = starting
        self._model = unrolling.solver.model()
        self._demanded = 0  # starts that every plan has
        self._counters: dict[int, tuple[Counter, int]] = {}  # by what is assumed: that there are no more than so many
        for ability in unrolling.places:
            self._assume(partial(unrolling.starting_more, ability, starting), 0)

    def plan(self, contract: Contract, promising: Callable[[Plan], bool], budget: Budget) -> Plan:
        """The one with the fewest starts.

        Of a fast contract, it is only tried for a moment whether there are fewer than are left when the needless ones
        are left out. Nor is it of any other tried for longer, when what is left is not `promising`.
        """
        fast = contract is Contract.FAST
        if not fast and self._lower(budget, soon=True):
            return self._plan(proven=True)
        self._leave_needless_out(budget if fast else budget.part(_PROVING))
        if not fast and not promising(self._plan(proven=False)):
            return self._plan(proven=False)
        return self._plan(self._lower(budget.part(_SHARE if fast else _PROVING)))

    def _plan(self, proven: bool) -> Plan:
        ticks = self._unrolling.read(self._length, self._starting, self._model)
        return Plan(ticks, minimal_ticks=True, minimal_starts=proven)

    def _leave_needless_out(self, budget: Budget) -> None:
        """Leave out starts without which the rest of the plan still is one."""
        solver = self._unrolling.solver
        choices = self._unrolling.starts(self._starting)
        taken = set(choices).intersection(self._model)
        without = self._unrolling.circuit.fresh()  # assumed: none of those that have been left out
        given = [*self._given, without]
        solver.add_clauses((-without, -choice) for choice in choices if choice not in taken)
        for choice in choices:
            if choice in taken:
                answer = solver.solve([*given, -choice], budget)
                if answer is None:
                    break
                if answer:
                    self._model = solver.model()
                    needless = taken.difference(self._model)
                    taken -= needless
                    solver.add_clauses((-without, -each) for each in needless)
        solver.add_clause((-without,))

    def _lower(self, budget: Budget, soon: bool = False) -> bool:
        """Find the fewest, at most as many as now; whether it is proven that they are. With `soon`, not for long."""
        solver = self._unrolling.solver
        most = len(set(self._unrolling.starts(self._starting)).intersection(self._model))
        while self._demanded < most:
            answer = solver.solve([*self._given, *self._counters], budget, soon)
            if answer is None:
                return False
            if answer:
                self._model = solver.model()
                return True
            core = [literal for literal in solver.core() if literal in self._counters]
            self._demanded += 1
            for literal in core:
                counter, number = self._counters.pop(literal)
                self._assume(counter, number + 1)
            self._assume(partial(self._unrolling.circuit.exceeding, [-literal for literal in core]), 1)
        return True

    def _assume(self, counter: Counter, number: int) -> None:
        """Assume from now on that there are no more than `number`."""
        more = counter(number)
        if more != Circuit.FALSE:
            self._counters[-more] = counter, number
