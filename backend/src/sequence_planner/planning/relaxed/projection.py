"""The engine that freezes all that a relaxed plan does not touch, and plans with the rest.

What is left is small however large the station is. A plan of it counts only when it replays on the whole; as long as
it does not, or there is none, more variables are let loose, and in the end other engines decide.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, target
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.expressions.syntax import Expression
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.plan import Contract, Plan
from sequence_planner.planning.relaxed.part import part_of
from sequence_planner.planning.relaxed.relaxed_plan import RelaxedPlan
from sequence_planner.planning.relaxed.relevance import Relevance
from sequence_planner.planning.relaxed.shortest import shortest
from sequence_planner.planning.replaying.acceptance import Acceptance
from sequence_planner.planning.sat.sweep import Sweep
from sequence_planner.planning.sat.unrolling import Unrolling

# A plan that is much longer than the relaxed one, in ticks, is left to others.
_LONGER, _MORE = 2, 4
_SHARE = 0.4  # of the time that is left, for each attempt
_MOST = 0.7  # of the variables; beyond, nothing is gained


class Projection:
    """Fast plans for one automaton under one supervisor."""

    name = "projection"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._relevance = Relevance(automaton)
        self._acceptance = Acceptance(automaton, supervisor)

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan, if freezing what does not seem to matter leaves one that replays; nothing by another contract."""
        if task.contract is not Contract.FAST:
            return Finding()
        found = self._relaxed_plan(task)
        if found is None:
            return Finding()
        relaxed, layers = found
        longest = min(task.longest, _LONGER * layers + _MORE)
        last: Set[str] = frozenset()
        for loose in self._loosened(task, relaxed):
            if budget.spent or loose == last or len(loose) > max(_MOST * len(self._automaton.variables), 1):
                break
            last = loose
            plan = self._planned(task, loose, longest, budget.part(_SHARE))
            if plan is not None and self._acceptance.accepts(task, plan):
                return Finding(plan)
        return Finding()

    def _relaxed_plan(self, task: Task) -> tuple[Sequence[Transition], int] | None:
        """A relaxed plan, made of what seems to matter if possible, and its layers."""
        goals = [goal.predicate for goal in task.goals]
        for moves in (
            lambda: self._relevance.towards(goals, task.state, task.circumstances),
            lambda: self._relevance.counted_on(task.state, task.circumstances),
        ):
            guess = RelaxedPlan(self._automaton, task.state, moves())
            relaxed = guess.towards(goals)
            if relaxed is not None:
                return relaxed, guess.layers
        return None

    def _loosened(self, task: Task, relaxed: Sequence[Transition]) -> Iterator[frozenset[str]]:
        """Sets of variables to be let loose, each larger than the one before.

        First those that the relaxed plan writes, then those that it reads, and at last all that transitions touch which
        write one of these, and all that keeps starts of these.
        """
        written = frozenset(name for move in relaxed for name in (*move.writes, *self._ending(move)))
        yield written
        loose = written | read_variables(self._automaton, _asked(task))
        yield loose.union(*map(self._touched, relaxed))
        while True:
            loose = self._widened(loose)
            yield loose

    def _touched(self, move: Transition) -> frozenset[str]:
        values = (action.value for action in move.actions)
        conditions = (action.condition for action in move.actions if action.condition is not None)
        return move.writes | read_variables(self._automaton, (move.guard, *values, *conditions))

    def _ending(self, move: Transition) -> frozenset[str]:
        """What comes after a start in any case."""
        if move.phase is not Phase.START:
            return frozenset()
        return frozenset(map(target, self._automaton.abilities[move.name.removesuffix(".start")].finish_actions))

    def _widened(self, loose: frozenset[str]) -> frozenset[str]:
        found = set(loose)
        for move in self._relevance.writing(loose):
            found |= self._touched(move)
            guard = self._supervisor.guards.get(move.name.removesuffix(".start"))
            found |= set(() if guard is None else guard.names)
        return frozenset(found)

    def _planned(self, task: Task, loose: Set[str], longest: int, budget: Budget) -> Plan | None:
        state = task.state
        part = part_of(self._automaton, self._supervisor, self._relevance, state, loose, _asked(task))
        frozen = {name: value for name in part.variables if name not in loose and (value := state[name]) is not None}
        unknown = frozenset(name for name in part.types if state[name] is None)
        order = Sweep(part, self._supervisor).quick()
        inside = self._supervisor.safe.includes(state)
        try:
            unrolling = Unrolling(part, self._supervisor, order, unknown, inside, frozen, budget)
            return shortest(unrolling, task, longest, budget)
        except SpentError:
            return None


def _asked(task: Task) -> list[Expression]:
    """The predicates and formulas of a task."""
    return [*task.circumstances.avoid, *(part for goal in task.goals for part in (goal.predicate, goal.local))]
