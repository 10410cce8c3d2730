"""The planner's SAT solver: Glucose 4.1 (Audemard and Simon 2009), as python-sat builds it.

`pysat.solvers` wraps the same functions, but takes longer to import than many a question takes to answer.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from itertools import repeat

import pysolvers

from sequence_planner.planning.budget import Budget

# Conflicts within which most questions are answered; only longer ones are worth an alarm clock, which is a thread.
_AT_ONCE = 200
_SOON = 500  # within which it is worth while to wait for an answer without which there is another way


class Solver:
    """Clauses are added and questions asked in any order; what is learnt is kept."""

    def __init__(self) -> None:
        self._handle: object | None = pysolvers.glucose41_new()

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        """Give the memory back; nothing else may follow."""
        if self._handle is not None:
            pysolvers.glucose41_del(self._handle)
            self._handle = None

    def add_clause(self, clause: Sequence[int]) -> None:
        """Demand that one of the literals is true."""
        pysolvers.glucose41_add_cl(self._handle, clause)

    def add_clauses(self, clauses: Iterable[Sequence[int]]) -> None:
        """Demand all of them."""
        # There are many, and this is the fastest way to exhaust an iterator.
        deque(map(pysolvers.glucose41_add_cl, repeat(self._handle), clauses), maxlen=0)

    def prefer(self, literals: Sequence[int]) -> None:
        """Try these literals true first, where nothing decides them."""
        pysolvers.glucose41_setphases(self._handle, literals)

    def solve(self, assumptions: Sequence[int], budget: Budget, soon: bool = False) -> bool | None:
        """Whether the clauses can be satisfied under `assumptions`; None when the budget is spent before.

        Or, with `soon`, when it takes much longer than most questions do.
        """
        if budget.spent:
            return None
        pysolvers.glucose41_cbudget(self._handle, _SOON if soon else _AT_ONCE)
        answer = pysolvers.glucose41_solve_lim(self._handle, assumptions, 0, 0)
        if answer is not None or soon or budget.spent:
            return answer
        pysolvers.glucose41_cbudget(self._handle, -1)
        with budget.interrupting(self._interrupt):
            answer = pysolvers.glucose41_solve_lim(self._handle, assumptions, 0, 1)
        pysolvers.glucose41_clearint(self._handle)
        return answer

    def model(self) -> list[int]:
        """The literals that are true in the answer to the last question, which was yes."""
        return pysolvers.glucose41_model(self._handle) or []

    def core(self) -> list[int]:
        """The assumptions that made the answer to the last question no; others may be needless too."""
        return pysolvers.glucose41_core(self._handle) or []

    def _interrupt(self) -> None:
        pysolvers.glucose41_interrupt(self._handle)
