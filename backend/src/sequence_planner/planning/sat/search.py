"""Bounded model checking: the fewest ticks, then the fewest starts (Biere et al. 1999).

The unrolled tick stays in one solver from question to question; the state to plan from and the goals are assumptions.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from types import MappingProxyType

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State
from sequence_planner.counting import counted
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.plan import Circumstances, Contract, Goal, Plan, PlanTick
from sequence_planner.planning.sat.fewest import Fewest
from sequence_planner.planning.sat.succession import Succession
from sequence_planner.planning.sat.unrolling import Unrolling

# A solver for each set of unknown variables; topics come and go in few combinations.
_KEPT_SEARCHES = 4


class SearchTimeoutError(Exception):
    """The deadline passed; `searched` ticks were searched completely."""

    def __init__(self, searched: int) -> None:
        super().__init__(f"no answer in time; complete up to {counted(searched, 'tick')}")
        self.searched = searched


class Search:
    """Plans from any state in which exactly `unknown`, variables and flags, have no value; with `inside`, from any
    safe one. The variables `frozen` have these values throughout: no transition writes others.
    The `oracles`, which no transition writes, have any value anew in each tick. What is asked `once` only is asked
    faster.
    """

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        order: Sequence[Ability],
        unknown: frozenset[str],
        inside: bool = False,
        frozen: State = MappingProxyType({}),
        once: bool = False,
        oracles: frozenset[str] = frozenset(),
        succession: Succession = (),
    ) -> None:
        self._made_of = (automaton, supervisor, order, unknown, inside, frozen, oracles)
        self._succession = succession
        self._one_at_a_time = automaton.one_at_a_time
        self._once = once
        self._unrolling: Unrolling | None = None

    def close(self) -> None:
        """Give the solver's memory back."""
        if self._unrolling is not None:
            self._unrolling.solver.close()
            self._unrolling = None

    def plan(
        self,
        state: State,
        goals: Sequence[Goal],
        circumstances: Circumstances,
        longest: int,
        budget: Budget,
        contract: Contract = Contract.MINIMAL,
        promising: Callable[[Plan], bool] = lambda _: True,
        least: int = 1,
    ) -> Plan | None:
        """A plan with the fewest ticks, then the fewest starts, or nearly so by a fast contract; None if there is none
        of at most `longest` ticks. It is known that none has fewer than `least`. If one of so many ticks is not
        `promising`, none with fewer starts is looked for.

        Raises `SearchTimeoutError` when the budget is spent before any plan is found; a plan found in time whose starts
        could not be proven fewest says so.
        """

        def reached(unrolling: Unrolling, length: int) -> list[int]:
            return [unrolling.reached(goal, length) for goal in goals]

        return self._shortest(state, circumstances, reached, longest, budget, contract, promising, False, least)

    def plan_within(
        self, state: State, goals: Sequence[Goal], circumstances: Circumstances, longest: int, budget: Budget
    ) -> tuple[PlanTick, ...] | None:
        """Some plan of at most `longest` ticks, of which there have been as many before; None if there is none.

        Raises `SearchTimeoutError`.
        """
        unrolling = self._unrolling
        assert unrolling is not None
        given = unrolling.given(state, circumstances)
        for length in range(1, longest + 1):
            given += unrolling.keeps(circumstances, length)
        given += (unrolling.reached(goal, longest) for goal in goals)
        answer = unrolling.solver.solve(given, budget)
        if answer is None:
            raise SearchTimeoutError(0)
        return unrolling.read(longest, longest - 1, unrolling.solver.model()) if answer else None

    @property
    def ticks(self) -> int:
        """How many have been asked about."""
        return 0 if self._unrolling is None else len(self._unrolling.ticks)

    def finishing(self, plan: Plan) -> frozenset[str]:
        """The abilities that finish in `plan`, which has just been found."""
        assert self._unrolling is not None
        return self._unrolling.finishing(len(plan.ticks), self._unrolling.solver.model())

    def plan_into(
        self, states: StateSet, state: State, circumstances: Circumstances, longest: int, budget: Budget
    ) -> Plan | None:
        """The same for a run into `states`, none of whose variables is unknown, after step 3 or after a start.

        What its last tick starts counts as well.
        """

        def inside(unrolling: Unrolling, length: int) -> list[int]:
            return [unrolling.inside(states, length)]

        return self._shortest(
            state, circumstances, inside, longest, budget, Contract.MINIMAL, lambda _: True, last_starts=True
        )

    def _shortest(
        self,
        state: State,
        circumstances: Circumstances,
        wanted: Callable[[Unrolling, int], list[int]],
        longest: int,
        budget: Budget,
        contract: Contract,
        promising: Callable[[Plan], bool],
        last_starts: bool,
        least: int = 1,
    ) -> Plan | None:
        """`wanted` has the literals that say so many ticks are enough; without `last_starts` the last has none."""
        length = least
        try:
            if self._unrolling is None:
                self._unrolling = Unrolling(*self._made_of, budget, self._succession)
            unrolling = self._unrolling
            given = unrolling.given(state, circumstances)
            if self._once:
                unrolling.solver.add_clauses([literal] for literal in given)
                given = []
            for length in range(1, longest + 1):
                unrolling.extend(length, budget)
                given += unrolling.keeps(circumstances, length)
                if length < least:
                    continue
                assumptions = [*given, *wanted(unrolling, length)]
                answer = unrolling.solver.solve(assumptions, budget)
                if answer is None:
                    raise SearchTimeoutError(length - 1)
                if answer:
                    starting = length if last_starts else length - 1
                    if self._one_at_a_time:  # with fewer starts a plan would have fewer ticks
                        return Plan(unrolling.read(length, starting, unrolling.solver.model()), True, True)
                    fewest = Fewest(unrolling, assumptions, length, starting)
                    return fewest.plan(contract, promising, budget)
        except SpentError:
            raise SearchTimeoutError(length - 1) from None
        return None


class Searches:
    """A search for each set of variables that are unknown together, kept warm from question to question."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, order: Sequence[Ability]) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._order = order
        self._kept: OrderedDict[tuple[frozenset[str], bool], Search] = OrderedDict()

    def search(self, state: State) -> Search:
        """The one that plans from `state`."""
        key = (frozenset(name for name, value in state.items() if value is None), self._supervisor.safe.includes(state))
        if key not in self._kept:
            self._kept[key] = Search(self._automaton, self._supervisor, self._order, *key)
            if len(self._kept) > _KEPT_SEARCHES:
                self._kept.popitem(last=False)[1].close()
        self._kept.move_to_end(key)
        return self._kept[key]

    def close(self) -> None:
        """Give the memory of all solvers back."""
        while self._kept:
            self._kept.popitem()[1].close()
