"""Questions about one tick to a SAT solver."""

from __future__ import annotations

from collections.abc import Iterable

from pysat.solvers import Solver

from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.pdr.relation import Relation

# Clauses for one question each, after which the solver is worn.
_MOST_PASSING = 4000


class Inquiry:
    """A solver that knows `relation`, and what else is demanded. Each question may raise `SpentError`."""

    def __init__(self, relation: Relation, budget: Budget) -> None:
        self._budget = budget
        # Most questions are small, and this solver's answers to them come soonest.
        self._solver = Solver("minisat22", bootstrap_with=relation.clauses)
        self._solver.set_phases([-choice for choice in relation.choices])
        self._top = relation.top
        self._passed = 0
        self._current = self.fresh()

    @property
    def worn(self) -> bool:
        """Whether a new one would be quicker."""
        return self._passed >= _MOST_PASSING

    def fresh(self) -> int:
        """A new variable."""
        self._top += 1
        return self._top

    def demand(self, clause: list[int]) -> None:
        """Demand that one of the literals is true."""
        self._solver.add_clause(clause)

    def passing(self, clause: Iterable[int]) -> int:
        """The literal that puts `clause` in force, for questions until the next one."""
        self._solver.add_clause([-self._current])
        self._passed += 1
        self._current = self.fresh()
        self._solver.add_clause([-self._current, *clause])
        return self._current

    def solves(self, assumptions: list[int]) -> bool:
        """Whether the assumptions can hold together."""
        self._budget.require()
        answer = self._solver.solve_limited(assumptions, expect_interrupt=True)
        if answer is None:
            raise SpentError
        return answer

    def model(self) -> list[int]:
        """The literals that are true in the answer to the last question, which was yes, by their variables."""
        return self._solver.get_model() or []

    def core(self) -> set[int]:
        """Assumptions that cannot hold together, of the last question, whose answer was no."""
        return set(self._solver.get_core() or ())

    def interrupt(self) -> None:
        """Answer nothing from now on. From any thread."""
        self._solver.interrupt()
