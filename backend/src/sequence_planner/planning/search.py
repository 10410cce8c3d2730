"""Bounded model checking: the fewest ticks, then the fewest starts (Biere et al. 1999).

The unrolled tick stays in one solver from question to question; the state to plan from, the goals and the bound on
the number of starts are assumptions.
"""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Sequence

from pysat.card import ITotalizer
from pysat.solvers import Solver

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State
from sequence_planner.planning.circuit import Circuit
from sequence_planner.planning.encoding import Encoding, SymbolicTick
from sequence_planner.planning.plan import Plan, PlanTick

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
        self._reached: dict[str, list[int]] = {}
        self._bounds: dict[int, ITotalizer] = {}

    def close(self) -> None:
        """Give the solver's memory back."""
        self._solver.delete()

    def plan(self, state: State, goals: Sequence[str], longest: int, deadline: float) -> Plan | None:
        """A plan with the fewest ticks, then the fewest starts; None if there is none of at most `longest` ticks.

        `deadline` is on the clock of `time.monotonic`. Raises `SearchTimeoutError` when it passes before any plan is
        found; a plan found in time whose starts could not be proven fewest says so.
        """
        return self._shortest(
            state, lambda length: [self._goal(goal, length) for goal in goals], longest, deadline, last_starts=False
        )

    def plan_into(self, states: StateSet, state: State, longest: int, deadline: float) -> Plan | None:
        """The same for a run into `states`, none of whose variables is unknown, after step 3 or after a start.

        What its last tick starts counts as well.
        """

        def inside(length: int) -> list[int]:
            last = self._ticks[length - 1]
            members = (self._encoding.reading.member(states, each) for each in (last.synchronised, last.end))
            return [self._circuit.disjunction(members)]

        return self._shortest(state, inside, longest, deadline, last_starts=True)

    def _shortest(
        self, state: State, wanted: Callable[[int], list[int]], longest: int, deadline: float, last_starts: bool
    ) -> Plan | None:
        """`wanted` has the literals that say so many ticks are enough; without `last_starts` the last has none."""
        given = self._given(state)
        for length in range(1, longest + 1):
            self._unroll(length)
            assumptions = [*given, *wanted(length)]
            answer = self._solve(assumptions, deadline)
            if answer is None:
                raise SearchTimeoutError(length - 1)
            if answer:
                return self._fewest_starts(assumptions, length, length if last_starts else length - 1, deadline)
        return None

    def _fewest_starts(self, assumptions: list[int], length: int, starting: int, deadline: float) -> Plan:
        """Of the runs of `length` ticks, of which the first `starting` have starts."""
        while True:
            ticks = self._read(length, starting)
            count = sum(len(tick.starts) for tick in ticks)
            if count == 0:
                return Plan(ticks, minimal_ticks=True, minimal_starts=True)
            answer = self._solve([*assumptions, *self._at_most(count - 1, starting)], deadline)
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

    def _goal(self, operation: str, length: int) -> int:
        """The literal that says the goal held after step 3 of one of the first `length` ticks."""
        reached = self._reached.setdefault(operation, [])
        goal = self._automaton.operations[operation].goal
        while len(reached) < length:
            holds = self._encoding.reading.truth(goal, self._ticks[len(reached)].synchronised).yes
            reached.append(self._circuit.disjunction((holds, *reached[-1:])))
        return reached[length - 1]

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

    def _solve(self, assumptions: list[int], deadline: float) -> bool | None:
        remaining = deadline - time.monotonic()
        if remaining <= 0:
            return None
        alarm = threading.Timer(remaining, self._solver.interrupt)
        alarm.start()
        try:
            return self._solver.solve_limited(assumptions, expect_interrupt=True)
        finally:
            alarm.cancel()
            alarm.join()
            self._solver.clear_interrupt()

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
