"""Questions about one tick to a SAT solver.

It is Minisat 2.2 (Een and Sorensson 2003): most questions are small, and its answers to them come soonest. As in
`sat.solver`, the functions that python-sat wraps are called themselves.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pysolvers

from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.pdr.relation import Relation

# Conflicts within which most questions are answered; only longer ones are worth an alarm clock, which is a thread.
_AT_ONCE = 1000

# Clauses for one question each, after which the solver is worn.
_MOST_PASSING = 4000


class Inquiry:
    """A solver that knows `relation`, and what else is demanded. Each question may raise `SpentError`."""

    def __init__(self, relation: Relation, budget: Budget) -> None:
        self._budget = budget
        self._handle: object = pysolvers.minisat22_new()
        for clause in relation.clauses:
            pysolvers.minisat22_add_cl(self._handle, clause)
        self.prefer([-choice for choice in relation.choices])
        self._top = relation.top
        self._passed = 0
        self._current = self.fresh()

    def __del__(self) -> None:
        pysolvers.minisat22_del(self._handle)

    @property
    def worn(self) -> bool:
        """Whether a new one would be quicker."""
        return self._passed >= _MOST_PASSING

    def fresh(self) -> int:
        """A new variable."""
        self._top += 1
        return self._top

    def demand(self, clause: Sequence[int]) -> None:
        """Demand that one of the literals is true."""
        pysolvers.minisat22_add_cl(self._handle, clause)

    def prefer(self, literals: Sequence[int]) -> None:
        """Try these literals true first, where nothing decides them."""
        pysolvers.minisat22_setphases(self._handle, literals)

    def passing(self, clause: Iterable[int]) -> int:
        """The literal that puts `clause` in force, for questions until the next one."""
        self.demand([-self._current])
        self._passed += 1
        self._current = self.fresh()
        self.demand([-self._current, *clause])
        return self._current

    def solves(self, assumptions: Sequence[int]) -> bool:
        """Whether the assumptions can hold together."""
        self._budget.require()
        pysolvers.minisat22_cbudget(self._handle, _AT_ONCE)
        answer: bool | None = pysolvers.minisat22_solve_lim(self._handle, assumptions, 0, 0)
        if answer is None:
            answer = self._solves_in_time(assumptions)
        if answer is None:
            raise SpentError
        return answer

    def model(self) -> list[int]:
        """The literals that are true in the answer to the last question, which was yes, by their variables."""
        return pysolvers.minisat22_model(self._handle) or []

    def core(self) -> set[int]:
        """Assumptions that cannot hold together, of the last question, whose answer was no."""
        return set(pysolvers.minisat22_core(self._handle) or ())

    def _solves_in_time(self, assumptions: Sequence[int]) -> bool | None:
        pysolvers.minisat22_cbudget(self._handle, -1)
        with self._budget.interrupting(self._interrupt):
            answer: bool | None = pysolvers.minisat22_solve_lim(self._handle, assumptions, 0, 1)
        pysolvers.minisat22_clearint(self._handle)
        return answer

    def _interrupt(self) -> None:
        pysolvers.minisat22_interrupt(self._handle)
