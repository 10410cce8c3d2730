"""Bounded model checking: the fewest ticks, then the fewest starts (Biere et al. 1999).

The unrolled tick stays in one solver from question to question; the state to plan from, the goals and the bound on
the number of starts are assumptions.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence

from pysat.card import ITotalizer
from pysat.solvers import Solver

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State
from sequence_planner.expressions.syntax import Expression
from sequence_planner.planning.circuit import Circuit
from sequence_planner.planning.encoding import Encoding, SymbolicTick
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import Circumstances, Goal, Plan, PlanTick
from sequence_planner.planning.tracking import Progress, Tracker, beginning

# A solver for each set of unknown variables; topics come and go in few combinations.
_KEPT_SEARCHES = 4


class SearchTimeoutError(Exception):
    """The deadline passed; `searched` ticks were searched completely."""

    def __init__(self, searched: int) -> None:
        super().__init__(f"no answer in time; complete up to {searched} ticks")
        self.searched = searched


class Search:
    """Plans from any state in which exactly the variables `unknown` have no value."""

    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, order: Sequence[Ability], unknown: frozenset[str]
    ) -> None:
        self._automaton = automaton
        self._order = order
        self._solver = Solver("glucose4", incr=False)
        self._circuit = Circuit(self._solver)
        self._encoding = Encoding(automaton, supervisor, self._circuit, unknown)
        self._start = self._encoding.initial(unknown)
        self._ticks: list[SymbolicTick] = []
        self._tracker = Tracker(self._circuit)
        self._progress: dict[Goal, list[Progress]] = {}
        self._avoided: dict[Expression, list[int]] = {}
        self._bounds: dict[int, ITotalizer] = {}

    def close(self) -> None:
        """Give the solver's memory back."""
        self._solver.delete()

    def plan(
        self, state: State, goals: Sequence[Goal], circumstances: Circumstances, longest: int, budget: Budget
    ) -> Plan | None:
        """A plan with the fewest ticks, then the fewest starts; None if there is none of at most `longest` ticks.

        Raises `SearchTimeoutError` when the budget is spent before any plan is found; a plan found in time whose starts
        could not be proven fewest says so.
        """
        return self._shortest(
            state,
            circumstances,
            lambda length: [self._reached(goal, length) for goal in goals],
            longest,
            budget,
            last_starts=False,
        )

    def plan_into(
        self, states: StateSet, state: State, circumstances: Circumstances, longest: int, budget: Budget
    ) -> Plan | None:
        """The same for a run into `states`, none of whose variables is unknown, after step 3 or after a start.

        What its last tick starts counts as well.
        """

        def inside(length: int) -> list[int]:
            last = self._ticks[length - 1]
            members = (self._encoding.reading.member(states, each) for each in (last.synchronised, last.end))
            return [self._circuit.disjunction(members)]

        return self._shortest(state, circumstances, inside, longest, budget, last_starts=True)

    def _shortest(
        self,
        state: State,
        circumstances: Circumstances,
        wanted: Callable[[int], list[int]],
        longest: int,
        budget: Budget,
        last_starts: bool,
    ) -> Plan | None:
        """`wanted` has the literals that say so many ticks are enough; without `last_starts` the last has none."""
        given = [*self._given(state), *self._encoding.assumptions(circumstances)]
        for length in range(1, longest + 1):
            self._unroll(length)
            given += [self._avoids(condition, length) for condition in circumstances.avoid]
            assumptions = [*given, *wanted(length)]
            answer = self._solve(assumptions, budget)
            if answer is None:
                raise SearchTimeoutError(length - 1)
            if answer:
                return self._fewest_starts(assumptions, length, length if last_starts else length - 1, budget)
        return None

    def _fewest_starts(self, assumptions: list[int], length: int, starting: int, budget: Budget) -> Plan:
        """Of the runs of `length` ticks, of which the first `starting` have starts."""
        while True:
            ticks = self._read(length, starting)
            count = sum(len(tick.starts) for tick in ticks)
            if count == 0:
                return Plan(ticks, minimal_ticks=True, minimal_starts=True)
            answer = self._solve([*assumptions, *self._at_most(count - 1, starting)], budget)
            if not answer:
                return Plan(ticks, minimal_ticks=True, minimal_starts=answer is False)

    def _given(self, state: State) -> list[int]:
        assumptions: list[int] = []
        for name, symbol in self._start.items():
            for value, literal in symbol.literals.items():
                assumptions.append(literal if state[name] == value else -literal)
        return assumptions

    def _unroll(self, length: int) -> None:
        while len(self._ticks) < length:
            before = self._ticks[-1].end if self._ticks else self._start
            tick = self._encoding.tick(before, self._order)
            self._ticks.append(tick)
            # A needless choice is one that the solver makes without being asked.
            self._solver.set_phases([-literal for literal in (*tick.effects.values(), *(c for _, c in tick.starts))])

    def _reached(self, goal: Goal, length: int) -> int:
        """The literal that says the goal was reached in one of the first `length` ticks."""
        progress = self._progress.setdefault(goal, [beginning(goal)])
        while len(progress) <= length:
            progress.append(self._tracker.after(goal, progress[-1], self._ticks[len(progress) - 1]))
        return progress[length].reached

    def _avoids(self, condition: Expression, length: int) -> int:
        """The literal that says no position of the tick at `length` satisfies `condition` or leaves it open."""
        avoided = self._avoided.setdefault(condition, [])
        while len(avoided) < length:
            tick = self._ticks[len(avoided)]
            positions = ((self._circuit.TRUE, tick.synchronised), *tick.positions)
            avoided.append(
                self._circuit.conjunction(
                    self._circuit.disjunction((-chosen, self._encoding.reading.truth(condition, each).no))
                    for chosen, each in positions
                )
            )
        return avoided[length - 1]

    def _at_most(self, bound: int, starting: int) -> list[int]:
        """The literals that bound the number of starts in the first `starting` ticks."""
        choices = [choice for tick in self._ticks[:starting] for _, choice in tick.starts]
        if bound >= len(choices):
            return []
        counter = self._bounds.get(starting)
        if counter is None or len(counter.rhs) <= bound:
            counter = ITotalizer(choices, ubound=bound + 1, top_id=self._circuit.top)
            self._circuit.reserve(counter.top_id)
            self._solver.append_formula(counter.cnf.clauses)
            self._bounds[starting] = counter
        return [-counter.rhs[bound]]

    def _solve(self, assumptions: list[int], budget: Budget) -> bool | None:
        if budget.spent:
            return None
        with budget.interrupting(self._solver.interrupt):
            answer = self._solver.solve_limited(assumptions, expect_interrupt=True)
        self._solver.clear_interrupt()
        return answer

    def _read(self, length: int, starting: int) -> tuple[PlanTick, ...]:
        model = self._solver.get_model()
        assert model is not None
        true = {literal for literal in model if literal > 0}
        return tuple(
            PlanTick(
                tuple(name for name, choice in tick.effects.items() if choice in true),
                tuple(name for name, choice in tick.starts if choice in true) if number <= starting else (),
            )
            for number, tick in enumerate(self._ticks[:length], start=1)
        )


class Searches:
    """A search for each set of variables that are unknown together, kept warm from question to question."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, order: Sequence[Ability]) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._order = order
        self._kept: OrderedDict[frozenset[str], Search] = OrderedDict()

    def search(self, state: State) -> Search:
        """The one that plans from `state`."""
        unknown = frozenset(name for name in self._automaton.variables if state[name] is None)
        if unknown not in self._kept:
            self._kept[unknown] = Search(self._automaton, self._supervisor, self._order, unknown)
            if len(self._kept) > _KEPT_SEARCHES:
                self._kept.popitem(last=False)[1].close()
        self._kept.move_to_end(unknown)
        return self._kept[unknown]
