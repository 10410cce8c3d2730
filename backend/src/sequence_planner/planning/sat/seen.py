"""The engine that plans with sight of a part of the automaton, and shows that no more is needed.

What is not seen may be as it is needed, so that no plan of the whole is shorter than those of the part, or has fewer
starts. One of these that replays on the whole is therefore one of the best; as long as none does, more is looked at
(abstraction refinement, Clarke et al. 2003).
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.transitions import Transition, transitions
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.pdr.localisation import Localised, localisable, localised
from sequence_planner.planning.plan import Circumstances, Contract, Plan
from sequence_planner.planning.relaxed.relaxation import counted_on
from sequence_planner.planning.relaxed.relaxed_plan import RelaxedPlan
from sequence_planner.planning.replaying.acceptance import Acceptance
from sequence_planner.planning.sat.search import Search, SearchTimeoutError
from sequence_planner.planning.sat.sweep import Sweep

_MOST = 0.7  # of the variables; beyond, nothing is gained
_KEPT = 3  # parts


@dataclass(frozen=True)
class _Part:
    """What is seen of the automaton, and a search in it."""

    seen: Localised
    search: Search


class PartialSight:
    """Minimal plans for one automaton under one supervisor, warm from question to question."""

    name = "partial sight"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._acceptance = Acceptance(automaton, supervisor)
        self._transitions = {move.name: move for move in transitions(automaton)}
        self._parts: OrderedDict[frozenset[str], _Part] = OrderedDict()
        self._sufficient: dict[tuple[Goals, Circumstances], frozenset[str]] = {}

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A plan with the fewest ticks and then the fewest starts, or up to how many there is none.

        Nothing by another contract, nor where formulas or conditions look at positions that are not seen.
        """
        if task.contract is Contract.FAST or task.circumstances.avoid:
            return Finding()
        if not localisable(self._automaton, task.state, task.goals):
            return Finding()
        searched = 0
        try:
            kept = self._first(task)
            while len(kept) <= _MOST * len(self._automaton.variables):
                plan = self._planned(task, kept, budget)
                if plan is None:
                    return Finding(searched=task.longest)
                if self._acceptance.accepts(task, plan):
                    self._sufficient[task.goals, task.circumstances] = kept
                    return Finding(plan, searched=len(plan.ticks))
                searched = max(searched, len(plan.ticks) - 1)
                wider = kept | self._touched(plan)
                if wider == kept:
                    break
                kept = wider
        except SpentError:
            pass
        except SearchTimeoutError as late:
            searched = max(searched, late.searched)
        return Finding(searched=searched)

    def _first(self, task: Task) -> frozenset[str]:
        """The variables to begin with: what was enough last time, or else what a relaxed plan touches."""
        known = self._sufficient.get((task.goals, task.circumstances))
        if known is not None:
            return known
        asked = [goal.predicate for goal in task.goals]
        moves = counted_on(self._automaton, task.circumstances)
        relaxed = RelaxedPlan(self._automaton, task.state, moves).towards(asked) or ()
        return read_variables(self._automaton, asked).union(*map(self._reads, relaxed))

    def _planned(self, task: Task, kept: frozenset[str], budget: Budget) -> Plan | None:
        part = self._part(kept, budget)
        state = part.seen.state(task.state)
        return part.search.plan(state, task.goals, task.circumstances, task.longest, budget)

    def _part(self, kept: frozenset[str], budget: Budget) -> _Part:
        if kept not in self._parts:
            seen = localised(self._automaton, self._supervisor, kept)
            order = seen.order(Sweep(seen.automaton, seen.supervisor).complete(budget))
            oracles = frozenset(seen.oracles)
            search = Search(seen.automaton, seen.supervisor, order, frozenset(), inside=True, oracles=oracles)
            self._parts[kept] = _Part(seen, search)
            if len(self._parts) > _KEPT:
                self._parts.popitem(last=False)[1].search.close()
        self._parts.move_to_end(kept)
        return self._parts[kept]

    def _touched(self, plan: Plan) -> frozenset[str]:
        """All that decides whether the effects and starts of a plan, and the ends of these, can happen."""
        effects = {name for tick in plan.ticks for name in tick.effects}
        abilities = {name for _, name in plan.starts}
        names = [*effects, *(f"{name}.{phase}" for name in abilities for phase in ("start", "finish"))]
        moves = (self._transitions[name] for name in names if name in self._transitions)
        guards = (self._supervisor.guards[name].names for name in abilities if name in self._supervisor.guards)
        return frozenset[str]().union(*map(self._reads, moves), *guards)

    def _reads(self, move: Transition) -> Iterable[str]:
        """The variables that `move` reads and writes."""
        values = (action.value for action in move.actions)
        conditions = (action.condition for action in move.actions if action.condition is not None)
        return move.writes | read_variables(self._automaton, (move.guard, *values, *conditions))
