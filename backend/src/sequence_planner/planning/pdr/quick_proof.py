"""A quick look for a proof that there is no plan, before anything else is tried."""

from __future__ import annotations

from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Circumstances
from sequence_planner.process.budget import Budget, SpentError

if TYPE_CHECKING:
    from sequence_planner.planning.pdr.ic3 import Reachability

# Variables beyond which something else is tried first, and seconds of work for a look: those during which others have
# the processor do not count, or a busy machine would turn away what is soon seen.
_FEW = 100
_GLANCE = 0.1
_MOST_IN_VAIN = 16  # questions that are remembered


class QuickProof:
    """Looks whether pairs of the variables that are seen first exclude the goals, and takes little time for it."""

    name = "first sight"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._few = len(automaton.variables) <= _FEW
        self._automaton = automaton
        self._supervisor = supervisor
        self._in_vain: set[tuple[Goals, Circumstances]] = set()

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A proof, which has been checked, or nothing; where there was none before, it does not look again."""
        asked = task.goals, task.circumstances
        if not self._few or asked in self._in_vain or budget.spent:
            return Finding()
        with suppress(SpentError):
            finding = self._reachability.at_first_sight(task, budget.working(_GLANCE))
            if finding.decided:
                return finding
        if len(self._in_vain) == _MOST_IN_VAIN:
            self._in_vain.clear()
        self._in_vain.add(asked)
        return Finding()

    @cached_property
    def _reachability(self) -> Reachability:
        # Not before there is something to look at: importing it takes longer than many a plan.
        from sequence_planner.planning.pdr.ic3 import Reachability  # noqa: PLC0415

        return Reachability(self._automaton, self._supervisor)
