"""Actions over symbolic states: what is written, where, and whether it goes together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from sequence_planner.automaton.structure import Automaton, target
from sequence_planner.expressions.syntax import Assignment
from sequence_planner.expressions.types import Value
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.symbolic import Reading, Symbol, SymbolicState


class Write(NamedTuple):
    """A value that is written to a variable where `where` is true."""

    where: int
    value: Symbol


Writes = dict[str, Write]


class Writing:
    """Reads the actions of an automaton into a circuit."""

    def __init__(self, automaton: Automaton, circuit: Circuit) -> None:
        self._automaton = automaton
        self._circuit = circuit
        self._reading = Reading(circuit)

    def writes(self, actions: Iterable[Assignment], state: SymbolicState) -> tuple[Writes, int]:
        """What `actions` write, and the literal that says nothing about it is undetermined."""
        writes: Writes = {}
        determined: list[int] = []
        for action in actions:
            # Where it is taken, an action writes a value of the domain; it is encoded for all states.
            domain = self._automaton.variables[target(action)].type.domain
            value = self._reading.symbol(action.value, state).within(domain)
            written = Symbol(value.literals)  # nothing undetermined is ever written
            if action.condition is None:
                writes[target(action)] = Write(Circuit.TRUE, written)
                determined.append(value.known)
            else:
                condition = self._reading.truth(action.condition, state)
                writes[target(action)] = Write(condition.yes, written)
                determined.append(
                    self._circuit.disjunction((condition.no, self._circuit.conjunction((condition.yes, value.known))))
                )
        return writes, self._circuit.conjunction(determined)

    def applied(self, state: SymbolicState, writes: Writes) -> SymbolicState:
        """The state after `writes`."""
        after = dict(state)
        for name, write in writes.items():
            after[name] = self._reading.chosen(write.where, write.value, state[name])
        return after

    def together(self, state: SymbolicState, taken: Iterable[tuple[int, Writes]]) -> SymbolicState:
        """The state after all writes of what is taken, none of which conflict."""
        all_writes: dict[str, list[Write]] = defaultdict(list)
        for choice, writes in taken:
            for name, write in writes.items():
                all_writes[name].append(Write(self._circuit.both(choice, write.where), write.value))
        return {**state, **{name: self._written(state[name], writes) for name, writes in all_writes.items()}}

    def _written(self, before: Symbol, writes: list[Write]) -> Symbol:
        """The value after `writes`, of which any two that are taken write the same."""
        circuit = self._circuit
        values = dict.fromkeys(value for symbol in (before, *(w.value for w in writes)) for value in symbol.literals)
        kept = circuit.conjunction(-write.where for write in writes)

        def after(value: Value) -> int:
            old = circuit.both(kept, before.literal(value))
            return circuit.disjunction((old, *(circuit.both(w.where, w.value.literal(value)) for w in writes)))

        if set(values) == {False, True} and before.known == circuit.TRUE:
            literal = after(True)
            return Symbol({False: -literal, True: literal})
        return Symbol({value: after(value) for value in values}, circuit.disjunction((before.known, -kept)))

    def conflict(self, first: Writes, second: Writes) -> int:
        """The literal that says that the two write different values to a variable."""
        return self._circuit.disjunction(
            self._circuit.conjunction(
                (first[n].where, second[n].where, -self._reading.same(first[n].value, second[n].value))
            )
            for n in first
            if n in second
        )


def sharing(all_writes: Mapping[str, Writes]) -> list[tuple[str, str]]:
    """The pairs of those that write a common variable, the earlier one first."""
    writers: dict[str, list[str]] = {}
    pairs: dict[tuple[str, str], None] = {}
    for one, writes in all_writes.items():
        for name in writes:
            others = writers.setdefault(name, [])
            pairs |= dict.fromkeys((other, one) for other in others)
            others.append(one)
    return list(pairs)
