"""The solver of those who check: CaDiCaL 1.5.3 (Biere et al. 2020), with which no proof was found."""

from __future__ import annotations

from collections.abc import Sequence

import pysolvers

from sequence_planner.planning.budget import Budget

# Conflicts after which the clock is looked at; nothing else can stop this solver.
_AT_ONCE = 1000


class SecondSolver:
    """Clauses are added and questions asked in any order."""

    def __init__(self) -> None:
        self._handle: object = pysolvers.cadical153_new()

    def __del__(self) -> None:
        pysolvers.cadical153_del(self._handle, None)

    def add_clause(self, clause: Sequence[int]) -> None:
        """Demand that one of the literals is true."""
        pysolvers.cadical153_add_cl(self._handle, clause)

    def solve(self, assumptions: Sequence[int], budget: Budget) -> bool:
        """Whether the clauses can be satisfied under `assumptions`. Raises `SpentError`."""
        while True:
            budget.require()
            pysolvers.cadical153_cbudget(self._handle, _AT_ONCE)
            answer = pysolvers.cadical153_solve_lim(self._handle, assumptions, 0)
            if answer != 0:
                return answer > 0
