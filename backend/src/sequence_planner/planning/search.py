"""Bounded model checking: the fewest ticks, then the fewest starts (Biere et al. 1999).

The unrolled tick stays in one solver from question to question; the state to plan from, the goals and the bound on
the number of starts are assumptions.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence

from pysat.card import ITotalizer
from pysat.solvers import Solver

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State
from sequence_planner.planning.circuit import Circuit
from sequence_planner.planning.encoding import Encoding, SymbolicTick
from sequence_planner.planning.plan import Plan, PlanTick


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
        given = self._given(state)
        for length in range(1, longest + 1):
            self._unroll(length)
            wanted = [self._goal(goal, length) for goal in goals]
            answer = self._solve([*given, *wanted], deadline)
            if answer is None:
                raise SearchTimeoutError(length - 1)
            if answer:
                return self._fewest_starts([*given, *wanted], length, deadline)
        return None

    def _fewest_starts(self, assumptions: list[int], length: int, deadline: float) -> Plan:
        while True:
            ticks = self._read(length)
            count = sum(len(tick.starts) for tick in ticks)
            if count == 0:
                return Plan(ticks, minimal_ticks=True, minimal_starts=True)
            answer = self._solve([*assumptions, *self._at_most(count - 1, length)], deadline)
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

    def _choices(self, length: int) -> list[int]:
        """The choices of starts that can still serve a goal: all but those of the last tick."""
        return [choice for tick in self._ticks[: length - 1] for _, choice in tick.starts]

    def _at_most(self, bound: int, length: int) -> list[int]:
        choices = self._choices(length)
        if bound >= len(choices):
            return []
        counter = self._bounds.get(length)
        if counter is None or len(counter.rhs) <= bound:
            counter = ITotalizer(choices, ubound=bound + 1, top_id=self._circuit.top)
            self._circuit.reserve(counter.top_id)
            self._solver.append_formula(counter.cnf.clauses)
            self._bounds[length] = counter
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

    def _read(self, length: int) -> tuple[PlanTick, ...]:
        model = self._solver.get_model()
        assert model is not None
        true = {literal for literal in model if literal > 0}
        return tuple(
            PlanTick(
                tuple(name for name, choice in tick.effects.items() if choice in true),
                tuple(name for name, choice in tick.starts if choice in true) if number < length else (),
            )
            for number, tick in enumerate(self._ticks[:length], start=1)
        )
