"""A plan of a small automaton, asked for once: of the fewest ticks, and without starts that it can do without."""

from __future__ import annotations

from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.plan import Plan, PlanTick
from sequence_planner.planning.sat.unrolling import Unrolling


def shortest(unrolling: Unrolling, task: Task, longest: int, budget: Budget) -> Plan | None:
    """A plan of `task` in at most `longest` ticks; None if there is none, or the budget is spent before.

    Whatever is known for certain becomes a clause, so that nothing else can be asked of `unrolling` afterwards. Raises
    `SpentError`.
    """
    solver = unrolling.solver
    solver.add_clauses([literal] for literal in unrolling.given(task.state, task.circumstances))
    for length in range(1, longest + 1):
        unrolling.extend(length, budget)
        solver.add_clauses([unrolling.avoids(condition, length)] for condition in task.circumstances.avoid)
        wanted = [unrolling.reached(goal, length) for goal in task.goals]
        answer = solver.solve(wanted, budget)
        if answer is None:
            return None
        if answer:
            solver.add_clauses([literal] for literal in wanted)
            return Plan(_without_needless(unrolling, length, budget), minimal_ticks=False, minimal_starts=False)
    return None


def _without_needless(unrolling: Unrolling, length: int, budget: Budget) -> tuple[PlanTick, ...]:
    """The plan in the solver, less the starts without which the rest of it still is one, earlier ones first."""
    solver = unrolling.solver
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
