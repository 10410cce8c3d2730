"""Bounded model checking: search for the fewest ticks, then the fewest starts (Biere et al. 1999)."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from functools import partial
from types import MappingProxyType

from sequence_planner.automaton.automaton import Ability, Automaton, State
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.core.numerals import counted
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances, Contract, Goal, Plan
from sequence_planner.planning.sat.partial_order import ANY_START, Singly
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.unrolling import Unrolling
from sequence_planner.process.budget import Budget, SpentError

# The fewest starts of plans with so many ticks.
#
# Sets of starts are collected of which every plan has one, until a plan has no more starts than these demand (Morgado
# et al. 2014, *Core-guided MaxSAT with soft cardinality constraints*). Where there is no time for that, the starts of
# one plan that it can do without are left out. Starts of one ability are counted together, as it is seldom needed
# twice.

# Of the time that is left, what it may cost to look for fewer starts of a fast plan.
_SHARE = 0.02
_PROVING = 0.8  # and of a minimal one, first without needless starts and then with the fewest

Counter = Callable[[int], int]  # for a number, a literal that is true where there are more


class FewestSearch:
    """Plans of `length` ticks, of which the first `starting` have starts, under the assumptions `given`.

    The solver has just found one.
    """

    def __init__(self, unrolling: Unrolling, given: Sequence[int], length: int, starting: int) -> None:
        self._unrolling = unrolling
        self._given = given
        self._length = length
        self._starting = starting
        self._model = unrolling.solver.model()
        self._demanded = 0  # starts that every plan has
        self._counters: dict[int, tuple[Counter, int]] = {}  # by what is assumed: that there are no more than so many
        for ability in unrolling.places:
            self._assume(partial(unrolling.starting_more, ability, starting), 0)

    def plan(self, contract: Contract, promising: Callable[[Plan], bool], budget: Budget) -> Plan:
        """The one with the fewest starts.

        Of a fast contract, it is only tried for a moment whether there are fewer than are left when the needless ones
        are left out. Nor is it of any other tried for longer, when what is left is not `promising`.
        """
        fast = contract is Contract.FAST
        if not fast and self._lower(budget, soon=True):
            return self._plan(proven=True)
        self._leave_needless_out(budget if fast else budget.part(_PROVING))
        if not fast and not promising(self._plan(proven=False)):
            return self._plan(proven=False)
        return self._plan(self._lower(budget.part(_SHARE if fast else _PROVING)))

    def _plan(self, proven: bool) -> Plan:
        ticks = self._unrolling.read(self._length, self._starting, self._model)
        return Plan(ticks, minimal_ticks=True, minimal_starts=proven)

    def _leave_needless_out(self, budget: Budget) -> None:
        """Leave out starts without which the rest of the plan still is one."""
        solver = self._unrolling.solver
        choices = self._unrolling.starts(self._starting)
        taken = set(choices).intersection(self._model)
        without = self._unrolling.circuit.fresh()  # assumed: none of those that have been left out
        given = [*self._given, without]
        solver.add_clauses((-without, -choice) for choice in choices if choice not in taken)
        for choice in choices:
            if choice in taken:
                answer = solver.solve([*given, -choice], budget)
                if answer is None:
                    break
                if answer:
                    self._model = solver.model()
                    needless = taken.difference(self._model)
                    taken -= needless
                    solver.add_clauses((-without, -each) for each in needless)
        solver.add_clause((-without,))

    def _lower(self, budget: Budget, soon: bool = False) -> bool:
        """Find the fewest, at most as many as now; whether it is proven that they are. With `soon`, not for long."""
        solver = self._unrolling.solver
        most = len(set(self._unrolling.starts(self._starting)).intersection(self._model))
        while self._demanded < most:
            answer = solver.solve([*self._given, *self._counters], budget, soon)
            if answer is None:
                return False
            if answer:
                self._model = solver.model()
                return True
            core = [literal for literal in solver.core() if literal in self._counters]
            self._demanded += 1
            for literal in core:
                counter, number = self._counters.pop(literal)
                self._assume(counter, number + 1)
            self._assume(partial(self._unrolling.circuit.exceeding, [-literal for literal in core]), 1)
        return True

    def _assume(self, counter: Counter, number: int) -> None:
        """Assume from now on that there are no more than `number`."""
        more = counter(number)
        if more != Circuit.FALSE:
            self._counters[-more] = counter, number


# Bounded model checking: the fewest ticks, then the fewest starts (Biere et al. 1999).
#
# The unrolled tick stays in one solver from question to question; the state to plan from and the goals are assumptions.

_NOTHING: State = MappingProxyType({})

# A solver for each set of unknown variables; topics come and go in few combinations.
_KEPT_SEARCHES = 4


def _any(_: Plan) -> bool:
    return True


class SearchTimeoutError(Exception):
    """The deadline passed; `searched` ticks were searched completely."""

    def __init__(self, searched: int) -> None:
        super().__init__(f"no answer in time; complete up to {counted(searched, 'tick')}")
        self.searched = searched


class SoughtPlans(Immutable):
    """Plans from `state` of at most `longest` ticks that reach `goals`; it is known that none has fewer than `least`.

    Or, instead of goals, that lead `into` states none of whose variables is unknown, after step 3 or after a start:
    what the last tick starts counts as well then. If one of the fewest ticks is not `promising`, none with fewer starts
    is looked for. Those sought `at_once` are any that are short enough: one question, and not one for each length.
    """

    state: State
    goals: Sequence[Goal]
    circumstances: Circumstances
    longest: int
    contract: Contract = Contract.MINIMAL
    promising: Callable[[Plan], bool] = _any
    least: int = 1
    into: StateSet | None = None
    at_once: bool = False

    @classmethod
    def of(cls, task: PlanningTask) -> SoughtPlans:
        """Return what is asked by a task."""
        return cls(task.state, task.goals, task.circumstances, task.bound, task.contract)

    def reached(self, unrolling: Unrolling, length: int) -> list[int]:
        """The literals that say so many ticks are enough."""
        if self.into is not None:
            return [unrolling.inside(self.into, length)]
        return [unrolling.reached(goal, length) for goal in self.goals]


class Search:
    """Plans from any state in which exactly `unknown`, variables and flags, have no value; with `inside`, from any
    safe one. The `oracles`, which no transition writes, have any value anew in each tick.
    """

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        order: Sequence[Ability],
        unknown: frozenset[str],
        inside: bool = False,
        oracles: frozenset[str] = frozenset(),
        singly: Singly = ANY_START,
    ) -> None:
        self._made_of = (automaton, supervisor, order, unknown, inside, _NOTHING, oracles)
        self._singly = singly
        self._one_at_a_time = automaton.one_at_a_time
        self._unrolling: Unrolling | None = None

    def close(self) -> None:
        """Give the solver's memory back."""
        if self._unrolling is not None:
            self._unrolling.solver.close()
            self._unrolling = None

    def plan(self, sought: SoughtPlans, budget: Budget) -> Plan | None:
        """A plan with the fewest ticks, then the fewest starts, or nearly so by a fast contract; None if there is none
        that is short enough. Where it is sought `at_once`, any that is.

        Raises `SearchTimeoutError` when the budget is spent before any plan is found; a plan found in time whose starts
        could not be proven fewest says so.
        """
        known = sought.least - 1
        first = sought.longest if sought.at_once else sought.least
        try:
            if self._unrolling is None:
                self._unrolling = Unrolling(*self._made_of, budget, self._singly)
            unrolling = self._unrolling
            given = unrolling.given(sought.state, sought.circumstances)
            for length in range(1, sought.longest + 1):
                unrolling.extend(length, budget)
                given += unrolling.keeps(sought.circumstances, length)
                if length < first:
                    continue
                assumptions = [*given, *sought.reached(unrolling, length)]
                answer = unrolling.solver.solve(assumptions, budget)
                if answer is None:
                    raise SearchTimeoutError(known)
                if answer:
                    return self._found(sought, assumptions, length, budget)
                known = length
        except SpentError:
            raise SearchTimeoutError(known) from None
        return None

    @property
    def ticks(self) -> int:
        """The number of ticks that have been asked about."""
        return 0 if self._unrolling is None else len(self._unrolling.ticks)

    def finishing(self, plan: Plan) -> frozenset[str]:
        """The abilities that finish in `plan`, which has just been found."""
        assert self._unrolling is not None
        return self._unrolling.finishing(len(plan.ticks), self._unrolling.solver.model())

    def _found(self, sought: SoughtPlans, assumptions: Sequence[int], length: int, budget: Budget) -> Plan:
        """The plan of so many ticks that the solver has just found, or one with fewer starts."""
        unrolling = self._unrolling
        assert unrolling is not None
        starting = length - 1 if sought.into is None else length
        if sought.at_once or self._one_at_a_time:  # with fewer starts of one at a time it would have fewer ticks
            ticks, proven = unrolling.read(length, starting, unrolling.solver.model()), not sought.at_once
            return Plan(ticks, proven, proven)
        fewest = FewestSearch(unrolling, assumptions, length, starting)
        return fewest.plan(sought.contract, sought.promising, budget)


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
