"""Whether the order of two starts in one tick matters, over all safe states."""

from __future__ import annotations

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, target
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.encoding import Encoding
from sequence_planner.planning.sat.solver import Solver
from sequence_planner.planning.sat.symbolic import SymbolicState

_AS_LONG_AS_IT_TAKES = 1e7  # seconds


class Pairs:
    """All safe states in one solver, with the starts of pairs of abilities from them."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, known: bool) -> None:
        """With `known`, two starts of which the second undoes the first need not be told from none: where every
        variable has a value, a tick with no needless starts has them one after the other only around a third, whose
        order with both matters.
        """
        self._abilities = automaton.abilities
        self._known = known
        self._solver = Solver()
        self._circuit = Circuit(self._solver)
        self._encoding = Encoding(automaton, supervisor, self._circuit, frozenset(), lazily=True)
        self._state = self._encoding.initial(frozenset(), synchronised=True)
        self._published = self._encoding.initial(frozenset(), determined=automaton.flag_predicates.keys())
        self._circuit.require(self._encoding.safe(self._state))
        self._first: dict[str, tuple[int, SymbolicState]] = {}
        self._second: dict[tuple[str, str], tuple[int, SymbolicState]] = {}

    def order_matters(self, one: str, other: str) -> bool:
        """Whether in some safe state `one` then `other` can start, and the other way round not, or differently."""
        first_now, _ = self._started(one)
        second_then, end = self._both(one, other)
        if Circuit.FALSE in (first_now, second_then):
            return False
        second_now, _ = self._started(other)
        first_then, end_other = self._both(other, one)
        names = self._written(one, other)
        exchangeable = self._circuit.conjunction((second_now, first_then, *self._same(names, end, end_other)))
        undone = self._circuit.conjunction(self._same(names, end, self._state)) if self._known else Circuit.FALSE
        if Circuit.TRUE in (exchangeable, undone) or -first_now in (second_then, -exchangeable):
            return False
        budget = Budget.seconds(_AS_LONG_AS_IT_TAKES)
        return bool(self._solver.solve([first_now, second_then, -exchangeable, -undone], budget))

    def _same(self, names: list[str], one: SymbolicState, other: SymbolicState) -> list[int]:
        return [self._encoding.reading.same(one[name], other[name]) for name in names]

    def _started(self, name: str) -> tuple[int, SymbolicState]:
        if name not in self._first:
            self._first[name] = self._start(name, self._state)
        return self._first[name]

    def _both(self, one: str, other: str) -> tuple[int, SymbolicState]:
        """Whether `other` can start after `one`, and what they have written then; either order of a pair needs both."""
        if (one, other) not in self._second:
            then, end = self._start(other, self._started(one)[1])
            self._second[one, other] = then, {name: end[name] for name in self._written(one, other)}
        return self._second[one, other]

    def _written(self, one: str, other: str) -> list[str]:
        return sorted({target(action) for name in (one, other) for action in self._abilities[name].start_actions})

    def _start(self, name: str, state: SymbolicState) -> tuple[int, SymbolicState]:
        return self._encoding.start(self._abilities[name], state, self._published, Circuit.TRUE)
