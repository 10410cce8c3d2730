"""The tick of an automaton with nothing but starts, taken one at a time: clauses over values before and after.

What a start asks of single variables and writes without looking at several is said by clauses of its choice alone. All
else is read into the circuit.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from itertools import combinations
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability
from sequence_planner.language.types import BOOLEAN, Value
from sequence_planner.planning.demands import Domains, Some, Starts, Written
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.symbolic import Reading, Symbol, SymbolicState, SymbolicWriter, Writes

_FEW = 8  # values of a variable of which each is said to exclude the others: pairs of more are too many


class Choices(NamedTuple):
    """The choice of each start in order, that it or one before it is made, and the state after the one that is."""

    starts: Sequence[tuple[str, int]]
    earlier: Sequence[int]
    end: SymbolicState


class SingleStep:
    """Reads starts into a circuit, from safe states in which nothing is unknown."""

    def __init__(self, starts: Starts, circuit: Circuit, reading: Reading, writing: SymbolicWriter) -> None:
        self._starts = starts
        self._circuit = circuit
        self._reading = reading
        self._writing = writing

    def choices(
        self,
        state: SymbolicState,
        order: Iterable[Ability],
        permitted: Callable[[Ability, SymbolicState], int],
        pause: Callable[[], object],
    ) -> Choices:
        """At most one of the starts in `order`, where it can be taken and is `permitted`."""
        circuit = self._circuit
        starts: list[tuple[str, int]] = []
        earlier: list[int] = []
        writing: dict[str, list[tuple[int, Written]]] = defaultdict(list)
        before = circuit.FALSE
        for ability in order:
            pause()
            demands, choice = self._starts[ability.name], circuit.fresh()
            for name, values in demands.asked.items():
                self._ask(choice, state[name], self._starts.domains, name, values)
            for part in demands.others:
                circuit.require(-choice, self._reading.truth(part, state).yes)
            circuit.require(-choice, permitted(ability, state))
            circuit.require(-choice, -before)
            before = circuit.disjunction((before, choice))
            starts.append((ability.name, choice))
            earlier.append(before)
            for written in demands.writes:
                writing[written.name].append((choice, written))
        return Choices(starts, earlier, {**state, **{name: self._after(state, name, w) for name, w in writing.items()}})

    def _ask(self, choice: int, symbol: Symbol, domains: Domains, name: str, values: Some) -> None:
        """Require that, where the choice is made, the variable has one of `values`."""
        domain = domains.values[name]
        refused = [symbol.literal(value) for n, value in enumerate(domain) if not values >> n & 1]
        if 2 * len(refused) <= len(domain):
            for literal in refused:
                self._circuit.require(-choice, -literal)
        else:
            self._circuit.require(-choice, *(symbol.literal(value) for value in domains.some(name, values)))

    def _after(self, state: SymbolicState, name: str, writing: Sequence[tuple[int, Written]]) -> Symbol:
        """The value of a variable after one of these starts, or none of them."""
        domain = self._starts.domains.values[name]
        plain = all(w.becomes is not None and w.action.condition is None for _, w in writing)
        constant = all(w.source is None for _, w in writing)
        if not plain or (len(domain) > _FEW and not constant):
            return self._computed(state, name, writing)
        after = self._fresh(domain)
        circuit, before = self._circuit, state[name]
        others: dict[Value, list[int]] = {value: [] for value in domain}  # choices that may write another value
        same: dict[Value, list[int]] = {value: [] for value in domain}  # and those that may write this one
        for choice, written in writing:
            self._write(choice, written, state, after)
            assert written.becomes is not None
            results = {value for _, value in written.becomes}
            for value in domain:
                if value in results:
                    same[value].append(choice)
                if results - {value}:
                    others[value].append(choice)
        changed = Circuit.FALSE if len(domain) <= _FEW else self._one_of([choice for choice, _ in writing])
        for value in domain:
            was, becomes = before.literal(value), after.literal(value)
            circuit.require(was, -becomes, *same[value])
            if len(domain) <= _FEW:
                circuit.require(-was, becomes, *others[value])
            else:
                circuit.require(-was, becomes, changed)
                circuit.require(-becomes, -changed, *same[value])
        return after

    def _write(self, choice: int, written: Written, state: SymbolicState, after: Symbol) -> None:
        """Require that, where the choice is made, the variable has the value that is written, and there is one in its
        domain.
        """
        circuit = self._circuit
        if written.source is None:
            circuit.require(-choice, *(after.literal(value) for _, value in written.becomes or ()))
            return
        becomes = dict(written.becomes or ())
        for value, literal in state[written.source].literals.items():
            if value in becomes:
                circuit.require(-choice, -literal, after.literal(becomes[value]))
            else:
                circuit.require(-choice, -literal)

    def _fresh(self, domain: Sequence[Value]) -> Symbol:
        circuit = self._circuit
        if domain == BOOLEAN.domain:
            literal = circuit.fresh()
            return Symbol({False: -literal, True: literal})
        symbol = Symbol({value: circuit.fresh() for value in domain})
        self._exclude(symbol)
        return symbol

    def _one_of(self, choices: Iterable[int]) -> int:
        """A literal that is true where one of the choices is made, and nowhere else."""
        one = self._circuit.fresh()
        made = list(choices)
        self._circuit.require(-one, *made)
        for choice in made:
            self._circuit.require(-choice, one)
        return one

    def _computed(self, state: SymbolicState, name: str, writing: Sequence[tuple[int, Written]]) -> Symbol:
        """The same by the circuit."""
        taken: list[tuple[int, Writes]] = []
        for choice, written in writing:
            writes, determined = self._writing.writes((written.action,), state)
            self._circuit.require(-choice, determined)
            taken.append((choice, writes))
        after = self._writing.together(state, taken)[name]
        self._exclude(after)  # it follows from all else, but not at a glance
        return after

    def _exclude(self, symbol: Symbol) -> None:
        """It has no two values."""
        if 2 < len(symbol.literals) <= _FEW:
            for one, other in combinations(symbol.literals.values(), 2):
                self._circuit.require(-one, -other)
