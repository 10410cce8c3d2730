"""The engine that searches plan lengths one after the other with a SAT solver, and so finds the fewest ticks."""

from __future__ import annotations

from collections import OrderedDict

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.syntax import Expression, UnaryTemporal, children
from sequence_planner.immutable import replace
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.plan import Contract
from sequence_planner.planning.sat.search import Searches, SearchTimeoutError, Sought
from sequence_planner.planning.sat.sweep import Sweep

# Formulas and conditions that more abilities than this write to are looked at after their starts in one order only.
_MOST_SEEN = 6
_KEPT = 3


class BoundedModelChecking:
    """Plans for one automaton under one supervisor, warm from question to question.

    For a fast plan one place for each ability in the order of starts is enough; only a minimal one needs an order of
    which all others are parts.
    """

    name = "bmc"

    def __init__(self, automaton: Automaton, supervisor: Supervisor, thorough: bool = False) -> None:
        """With `thorough`, fast plans too are made with all orders of starts."""
        self._automaton = automaton
        self._supervisor = supervisor
        self._thorough = thorough
        self._sweep = Sweep(automaton, supervisor)
        self._sweep_of_known = Sweep(automaton, supervisor, known=True)  # states
        self._searches: OrderedDict[tuple[bool, tuple[bool, frozenset[str]] | None], Searches] = OrderedDict()

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan of the fewest ticks, or up to how many there is none.

        Of a minimal contract its starts are proven fewest if it says so. A fast one may take a tick more.
        """
        seen = self._seen(task)
        exact = task.contract is Contract.MINIMAL and len(seen) <= _MOST_SEEN
        try:
            plan = self._searched(task, seen, budget).search(task.state).plan(Sought.of(task), budget)
        except SpentError:
            return Finding()
        except SearchTimeoutError as late:
            return Finding(searched=late.searched if exact else 0)
        if plan is None:
            return Finding(searched=task.bound if exact else 0)
        if not exact:
            return Finding(replace(plan, minimal_ticks=False, minimal_starts=False))
        return Finding(plan, searched=len(plan.ticks))

    def _seen(self, task: Task) -> frozenset[str]:
        """The abilities whose starts formulas and conditions can tell apart: all, where a formula counts positions."""
        asked = (*task.circumstances.avoid, *(goal.local for goal in task.goals))
        if any(_counts_positions(each) for each in asked):
            return frozenset(self._automaton.abilities)
        return self._sweep.writers(read_variables(self._automaton, asked))

    def _searched(self, task: Task, seen: frozenset[str], budget: Budget) -> Searches:
        quickly = task.contract is Contract.FAST and not self._thorough
        if len(seen) > _MOST_SEEN:
            seen = frozenset()
        known, restart = None not in task.state.values(), task.circumstances.restart
        key = restart, None if quickly else (known, seen)
        if key not in self._searches:
            sweep = self._sweep_of_known if known else self._sweep
            order = sweep.quick(restart) if quickly else sweep.complete(budget, seen, restart)
            self._searches[key] = Searches(self._automaton, self._supervisor, order)
            if len(self._searches) > _KEPT:
                self._searches.popitem(last=False)[1].close()
        self._searches.move_to_end(key)
        return self._searches[key]


def _counts_positions(formula: Expression) -> bool:
    """Whether a formula speaks of the next position, so that one more start can decide it, whatever it writes."""
    match formula:
        case UnaryTemporal("X" | "N", _):
            return True
    return any(_counts_positions(part) for part in children(formula))
