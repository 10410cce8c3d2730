"""SAT planning engine: incremental plan length for fewest ticks, on the whole or part of an automaton."""

from __future__ import annotations

from collections import OrderedDict, defaultdict
from collections.abc import Callable, Collection, Iterable
from functools import partial

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.core.immutable import replace
from sequence_planner.language.syntax import Expression, UnaryTemporal, children
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.heuristic.relaxed_plan import RelaxedPlan, Relevance
from sequence_planner.planning.pdr.abstraction import localisable, localised
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Circumstances, Contract, Plan
from sequence_planner.planning.sat.search import Search, Searches, SearchTimeoutError, SoughtPlans
from sequence_planner.planning.sat.start_order import Sweep
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.process.budget import Budget, SpentError
from sequence_planner.process.gc_tuning import collection_put_off

# The engine that searches plan lengths one after the other with a SAT solver, and so finds the fewest ticks.

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

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan of the fewest ticks, or up to how many there is none.

        Of a minimal contract its starts are proven fewest if it says so. A fast one may take a tick more.
        """
        seen = self._seen(task)
        exact = task.contract is Contract.MINIMAL and len(seen) <= _MOST_SEEN
        try:
            plan = self._searched(task, seen, budget).search(task.state).plan(SoughtPlans.of(task), budget)
        except SpentError:
            return Finding()
        except SearchTimeoutError as late:
            return Finding(searched=late.searched if exact else 0)
        if plan is None:
            return Finding(searched=task.bound if exact else 0)
        if not exact:
            return Finding(replace(plan, minimal_ticks=False, minimal_starts=False))
        return Finding(plan, searched=len(plan.ticks))

    def _seen(self, task: PlanningTask) -> frozenset[str]:
        """The abilities whose starts formulas and conditions can tell apart: all, where a formula counts positions."""
        asked = (*task.circumstances.avoid, *(goal.local for goal in task.goals))
        if any(_counts_positions(each) for each in asked):
            return frozenset(self._automaton.abilities)
        return self._sweep.writers(read_variables(self._automaton, asked))

    def _searched(self, task: PlanningTask, seen: frozenset[str], budget: Budget) -> Searches:
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
    """Return whether a formula speaks of the next position, so that one more start can decide it, whatever it
    writes.
    """
    match formula:
        case UnaryTemporal("X" | "N", _):
            return True
    return any(_counts_positions(part) for part in children(formula))


# The engine that plans with sight of a part of the automaton, and shows that no more is needed.
#
# What is not seen may be as it is needed, so that no plan of the whole is shorter than those of the part, or has fewer
# starts. One of these that replays on the whole is therefore one of the best; as long as none does, more is looked at
# (abstraction refinement, Clarke et al. 2003).

_MOST = 0.7  # of the variables; beyond, nothing is gained


class _Part:
    """The part of the automaton that is seen through its variables `kept`, and a search in it."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, kept: frozenset[str]) -> None:
        self._seen = localised(automaton, supervisor, kept)
        self._sweep = Sweep(self._seen.automaton, self._seen.supervisor, known=True)
        self._searches: dict[bool, Search] = {}  # by whether restart abilities may start
        self._latest: Search | None = None

    @property
    def finishing(self) -> frozenset[str]:
        """The abilities that write what is seen when they finish, and may do so over what is not."""
        return frozenset(name for name, each in self._seen.automaton.abilities.items() if each.finish_guard is not None)

    def plan(self, task: PlanningTask, promising: Callable[[Plan], bool], budget: Budget) -> Plan | None:
        """As `Search.plan`. Raises `SpentError` too."""
        seen, restart = self._seen, task.circumstances.restart
        if restart not in self._searches:
            order = seen.order(self._sweep.complete(budget, restart=restart))
            oracles = frozenset(seen.oracles)
            self._searches[restart] = Search(
                seen.automaton, seen.supervisor, order, frozenset(), inside=True, oracles=oracles
            )
        self._latest = self._searches[restart]
        sought = SoughtPlans(seen.state(task.state), task.goals, task.circumstances, task.bound, promising=promising)
        return self._latest.plan(sought, budget)

    def made_of(self, plan: Plan) -> frozenset[str]:
        """The effects and abilities of `plan`, which has just been found, what finishes without a start included."""
        assert self._latest is not None
        taken = (name for tick in plan.ticks for name in (*tick.effects, *tick.starts))
        return self._latest.finishing(plan).union(taken)

    def close(self) -> None:
        """Give the memory of its solvers back."""
        for search in self._searches.values():
            search.close()


_MOST_KEPT = 1000  # questions of which it is remembered what matters


class PartialSight:
    """Minimal plans for one automaton under one supervisor, warm from question to question."""

    name = "partial sight"

    def __init__(self, automaton: Automaton, supervisor: Supervisor, most: float = _MOST) -> None:
        """It gives up where more than the share `most` of all variables matters."""
        self._most = most * len(automaton.variables)
        self._automaton = automaton
        self._supervisor = supervisor
        self._acceptance = Acceptance.of(automaton, supervisor)
        self._relevance = Relevance(automaton)
        self._effects = frozenset(effect.name for effect in automaton.effects)
        self._moves: dict[str, list[Transition]] = defaultdict(list)  # by ability or effect
        for move in self._relevance.transitions:
            self._moves[self._owner(move.name)].append(move)
        self._parts: OrderedDict[frozenset[str], _Part] = OrderedDict()
        self._kept: dict[tuple[Goals, Circumstances], frozenset[str]] = {}

    @collection_put_off()
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan with the fewest ticks and then the fewest starts, or up to how many there is none.

        Nothing by another contract, nor where formulas or conditions look at positions that are not seen.
        """
        if task.contract is Contract.FAST or task.circumstances.avoid:
            return Finding()
        if not localisable(self._automaton, task.state, task.goals):
            return Finding()
        searched = 0
        question = task.goals, task.circumstances
        try:
            if len(self._kept) > _MOST_KEPT:
                self._kept.clear()
            kept = self._kept[question] = self._kept.get(question) or self._first(task)
            while len(kept) <= self._most:
                part = self._part(kept)
                plan = part.plan(task, partial(self._acceptance.accepts, task), budget)
                if plan is None:
                    return Finding(searched=task.bound)
                if self._acceptance.accepts(task, plan):
                    return Finding(plan, searched=len(plan.ticks))
                searched = max(searched, len(plan.ticks) - 1)
                wider = kept | self._touched(part.made_of(plan))
                if wider == kept:
                    wider |= self._touched(part.finishing)
                if wider == kept:
                    break
                kept = self._kept[question] = wider
        except SpentError:
            pass
        except SearchTimeoutError as late:
            searched = max(searched, late.searched)
        return Finding(searched=searched)

    def _first(self, task: PlanningTask) -> frozenset[str]:
        """The variables to begin with: what a relaxed plan touches, and abilities that may finish to the same effect.

        These would be seen to finish whenever that is needed, whether they have been started or not.
        """
        asked = [goal.predicate for goal in task.goals]
        mattering = self._relevance.towards(asked, task.state, task.circumstances)
        relaxed = RelaxedPlan(self._automaton, task.state, mattering).towards(asked)
        if relaxed is None:
            moves = self._relevance.counted_on(task.state, task.circumstances)
            relaxed = RelaxedPlan(self._automaton, task.state, moves).towards(asked) or ()
        touching = (*relaxed, *(move for move in mattering if move.phase is Phase.FINISH))
        return read_variables(self._automaton, asked) | self._touched({self._owner(move.name) for move in touching})

    def _part(self, kept: frozenset[str]) -> _Part:
        if kept not in self._parts:
            self._parts[kept] = _Part(self._automaton, self._supervisor, kept)
            if len(self._parts) > _KEPT:
                self._parts.popitem(last=False)[1].close()
        self._parts.move_to_end(kept)
        return self._parts[kept]

    def _owner(self, transition: str) -> str:
        """The effect or ability whose transition it is."""
        return transition if transition in self._effects else transition.rpartition(".")[0]

    def _touched(self, owners: Collection[str]) -> frozenset[str]:
        """All that decides whether these effects, and the starts and finishes of these abilities, can happen."""
        moves = [move for owner in owners for move in self._moves[owner]]
        guards = (self._supervisor.guards[owner].names for owner in owners if owner in self._supervisor.guards)
        return frozenset[str]().union(*map(self._reads, moves), *guards)

    def _reads(self, move: Transition) -> Iterable[str]:
        """The variables that `move` reads and writes."""
        values = (action.value for action in move.actions)
        conditions = (action.condition for action in move.actions if action.condition is not None)
        return move.writes | read_variables(self._automaton, (move.guard, *values, *conditions))
