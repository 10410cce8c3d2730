"""A plan of a small automaton, asked for once: of the fewest ticks, and without starts that it can do without."""

from __future__ import annotations

from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Task
from sequence_planner.planning.plan import Plan, PlanTick
from sequence_planner.planning.sat.unrolling import Unrolling


class Shortest:
    """Looks for a plan of one task, and goes on where it was when the budget was spent.

    Whatever is known for certain becomes a clause, so that nothing else can be asked of its solver afterwards.
    """

    def __init__(self, unrolling: Unrolling, task: Task) -> None:
        self._unrolling = unrolling
        self._task = task
        self._searched = 0  # ticks up to which there is no plan
        unrolling.solver.add_clauses([literal] for literal in unrolling.given(task.state, task.circumstances))

    def plan(self, longest: int, budget: Budget) -> Plan | None:
        """A plan in at most `longest` ticks; None if there is none. Raises `SpentError`."""
        unrolling, task = self._unrolling, self._task
        while self._searched < longest:
            length = self._searched + 1
            unrolling.extend(length, budget)
            unrolling.solver.add_clauses([literal] for literal in unrolling.keeps(task.circumstances, length))
            wanted = [unrolling.reached(goal, length) for goal in task.goals]
            answer = unrolling.solver.solve(wanted, budget)
            if answer is None:
                raise SpentError
            if answer:
                unrolling.solver.add_clauses([literal] for literal in wanted)
                return Plan(self._without_needless(length, budget), minimal_ticks=False, minimal_starts=False)
            self._searched = length
        return None

    def _without_needless(self, length: int, budget: Budget) -> tuple[PlanTick, ...]:
        """The plan in the solver, less the starts without which the rest of it still is one, earlier ones first."""
        unrolling, solver = self._unrolling, self._unrolling.solver
        model = solver.model()
        starts = unrolling.starts(length)
        taken = set(starts).intersection(model)
        solver.add_clauses([-choice] for choice in starts if choice not in taken)
        for choice in unrolling.starts(length - 1):
            if choice not in taken:
                continue
            answer = solver.solve([-choice], budget)
            if answer is None:
                break
            if answer:
                model = solver.model()
                left_out = taken.difference(model)
                taken -= left_out
                solver.add_clauses([-each] for each in left_out)
            else:
                solver.add_clause([choice])
        return unrolling.read(length, length - 1, model)
