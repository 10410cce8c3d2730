"""The tick as a circuit: the same steps as `automaton.tick`, over symbolic states.

Choices are free variables: which effects happen, which abilities start. Everything else is a function of the state
before, so a state is never copied: unrolling builds one circuit from the initial values.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, Flag, target
from sequence_planner.expressions.syntax import Assignment, variables
from sequence_planner.planning.circuit import Circuit
from sequence_planner.planning.plan import Circumstances
from sequence_planner.planning.symbolic import Reading, Symbol, SymbolicState


@dataclass(frozen=True)
class Write:
    """A value that is written to a variable where `where` is true."""

    where: int
    value: Symbol


Writes = dict[str, Write]


@dataclass(frozen=True)
class SymbolicTick:
    """One tick: the choices, the state after step 3, and after each place in the order of starts.

    A position counts where its start is chosen; the last is the end of the tick, whatever is chosen.
    """

    effects: Mapping[str, int]
    starts: Sequence[tuple[str, int]]
    synchronised: SymbolicState
    positions: Sequence[tuple[int, SymbolicState]]

    @property
    def end(self) -> SymbolicState:
        """The state at the end of the tick."""
        return self.positions[-1][1] if self.positions else self.synchronised


class Encoding:
    """Reads an automaton under its supervisor into a circuit; `unknown` variables have no value and get none."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, circuit: Circuit, unknown: frozenset[str]) -> None:
        self.automaton = automaton
        self._circuit = circuit
        self.reading = Reading(circuit)
        self._effects = [effect for effect in automaton.effects if not effect.fault]
        self._affected = {name: _affected_flags(automaton, {name}) for name in automaton.variables}
        self._safe = supervisor.safe.for_all(unknown)
        # The guards speak of states whose flags are determined. With unknown values a flag can be older than the state,
        # and only the safe set itself tells where a start may lead.
        self._by_guards = not unknown
        self._guards = supervisor.guards
        acting = {a.resource for a in automaton.abilities.values()} | {e.resource for e in self._effects}
        self._online = {resource: circuit.fresh() for resource in sorted(acting)}
        self._restart = circuit.fresh()

    def assumptions(self, circumstances: Circumstances) -> list[int]:
        """The literals that say which resources are online, and whether restart abilities may start."""
        online = [-one if name in circumstances.offline else one for name, one in self._online.items()]
        return [*online, self._restart if circumstances.restart else -self._restart]

    def initial(self, unknown: frozenset[str], synchronised: bool = False) -> SymbolicState:
        """A state of free values; flags are free too (and may be undetermined), or functions of the variables."""
        state: dict[str, Symbol] = {}
        for name, variable in self.automaton.variables.items():
            if name in unknown:
                state[name] = Symbol({}, Circuit.FALSE)
                continue
            domain = variable.type.domain
            if domain == (False, True):
                literal = self._circuit.fresh()
                state[name] = Symbol({False: -literal, True: literal})
            else:
                literals = {value: self._circuit.fresh() for value in domain}
                self._circuit.require(*literals.values())
                for one, other in combinations(literals.values(), 2):
                    self._circuit.require(-one, -other)
                state[name] = Symbol(literals)
        for flag in self.automaton.flags:
            if synchronised:
                state[flag.name] = Symbol({}, Circuit.FALSE)
            else:
                yes, no = self._circuit.fresh(), self._circuit.fresh()
                self._circuit.require(-yes, -no)
                state[flag.name] = Symbol({False: no, True: yes}, self._circuit.disjunction((yes, no)))
        return self._synchronise(state, self.automaton.flags) if synchronised else state

    def tick(self, state: SymbolicState, order: Iterable[Ability]) -> SymbolicTick:
        """One tick from `state`; each ability starts at most once, at one of its places in `order`."""
        effects, sensed = self._sense(state)
        synchronised = self._synchronise(self._finish(sensed), self.automaton.flags)
        end, safe = synchronised, self.safe(synchronised)
        starts: list[tuple[str, int]] = []
        positions: list[tuple[int, SymbolicState]] = []
        for ability in order:
            choice = self._circuit.fresh()
            starts.append((ability.name, choice))
            allowed, end = self.start(ability, end, state, choice)
            positions.append((choice, end))
            self._circuit.require(-choice, safe)
            self._circuit.require(-choice, allowed)
            self._circuit.require(-choice, self._online[ability.resource])
            if ability.restart:
                self._circuit.require(-choice, self._restart)
        for (one, first), (other, second) in combinations(starts, 2):
            if one == other:
                self._circuit.require(-first, -second)
        return SymbolicTick(effects, starts, synchronised, positions)

    def safe(self, state: SymbolicState) -> int:
        """The literal that says the state is safe."""
        return self.reading.member(self._safe, state)

    def start(
        self, ability: Ability, state: SymbolicState, published: SymbolicState, choice: int
    ) -> tuple[int, SymbolicState]:
        """Whether `ability` may start in a safe `state`, and the state after it where `choice` is true."""
        writes, determined = self._writes(ability.start_actions, state)
        after = self._applied(state, {n: Write(self._both(choice, w.where), w.value) for n, w in writes.items()})
        conditions = [
            determined,
            state[ability.flag("enabled")].literal(True),
            self.reading.truth(ability.enabled, state).yes,
            self.reading.truth(ability.start_guard, state).yes,
            *(-self._reverts(name, state, published, write) for name, write in writes.items()),
        ]
        if not self._by_guards or ability.restart:
            conditions.append(self.safe(after))
        elif ability.name in self._guards:
            conditions.append(self.reading.member(self._guards[ability.name], state))
        changed = dict.fromkeys(flag for name in writes for flag in self._affected[name])
        flags = [flag for flag in self.automaton.flags if flag.name in changed]
        return self._circuit.conjunction(conditions), self._synchronise(after, flags)

    def _both(self, one: int, other: int) -> int:
        return self._circuit.conjunction((one, other))

    def _sense(self, state: SymbolicState) -> tuple[dict[str, int], SymbolicState]:
        choices: dict[str, int] = {}
        taken: list[tuple[int, Writes]] = []
        for effect in self._effects:
            choice = choices[effect.name] = self._circuit.fresh()
            self._circuit.require(-choice, self._online[effect.resource])
            writes, determined = self._writes(effect.actions, state)
            self._circuit.require(-choice, determined)
            self._circuit.require(-choice, self.reading.truth(effect.guard, state).yes)
            # An unknown variable stays unknown, whatever the effect would make of it.
            known = {n: w for n, w in writes.items() if state[n].known != Circuit.FALSE}
            taken.append((choice, known))
        for (one, first), (other, second) in combinations(taken, 2):
            self._circuit.require(-one, -other, -self._conflict(first, second))
        return choices, self._applied(state, _merged(self._circuit, taken))

    def _finish(self, state: SymbolicState) -> SymbolicState:
        candidates: list[tuple[int, Writes]] = []
        for ability in self.automaton.abilities.values():
            if ability.finish_guard is None or not ability.finish_actions:
                continue
            writes, determined = self._writes(ability.finish_actions, state)
            holds = self.reading.truth(ability.finish_guard, state).yes
            candidates.append((self._both(holds, determined), writes))
        applied: list[tuple[int, Writes]] = []
        for i, (holds, writes) in enumerate(candidates):
            disputes = [
                self._both(other, self._conflict(writes, others))
                for j, (other, others) in enumerate(candidates)
                if i != j
            ]
            applied.append((self._circuit.conjunction((holds, *(-dispute for dispute in disputes))), writes))
        return self._applied(state, _merged(self._circuit, applied))

    def _synchronise(self, state: SymbolicState, flags: Iterable[Flag]) -> SymbolicState:
        after = dict(state)
        for flag in flags:
            truth = self.reading.truth(flag.predicate, after)
            old = after[flag.name]
            if truth.no == -truth.yes:
                after[flag.name] = Symbol({False: truth.no, True: truth.yes})
                continue
            undetermined = self._both(-truth.yes, -truth.no)
            yes = self._circuit.disjunction((truth.yes, self._both(undetermined, old.literal(True))))
            no = self._circuit.disjunction((truth.no, self._both(undetermined, old.literal(False))))
            after[flag.name] = Symbol({False: no, True: yes}, self._circuit.disjunction((yes, no)))
        return after

    def _writes(self, actions: Iterable[Assignment], state: SymbolicState) -> tuple[Writes, int]:
        """What `actions` write, and the literal that says nothing about it is undetermined."""
        writes: Writes = {}
        determined: list[int] = []
        for action in actions:
            # Where it is taken, an action writes a value of the domain; it is encoded for all states.
            domain = self.automaton.variables[target(action)].type.domain
            value = self.reading.symbol(action.value, state).within(domain)
            if action.condition is None:
                writes[target(action)] = Write(Circuit.TRUE, value)
                determined.append(value.known)
            else:
                condition = self.reading.truth(action.condition, state)
                writes[target(action)] = Write(condition.yes, value)
                determined.append(self._circuit.disjunction((condition.no, self._both(condition.yes, value.known))))
        return writes, self._circuit.conjunction(determined)

    def _applied(self, state: SymbolicState, writes: Writes) -> SymbolicState:
        after = dict(state)
        for name, write in writes.items():
            after[name] = self.reading.chosen(write.where, write.value, state[name])
        return after

    def _conflict(self, first: Writes, second: Writes) -> int:
        return self._circuit.disjunction(
            self._circuit.conjunction(
                (first[n].where, second[n].where, -self.reading.same(first[n].value, second[n].value))
            )
            for n in first
            if n in second
        )

    def _reverts(self, name: str, state: SymbolicState, published: SymbolicState, write: Write) -> int:
        """The start would set the output back to what was published, and nobody would have seen its value now."""
        if name not in self.automaton.outputs:
            return Circuit.FALSE
        changed = -self.reading.same(state[name], published[name])
        return self._circuit.conjunction((changed, write.where, self.reading.same(write.value, published[name])))


def _merged(circuit: Circuit, taken: Iterable[tuple[int, Writes]]) -> Writes:
    """All writes of what is taken, none of which conflict."""
    merged: Writes = {}
    for choice, writes in taken:
        for name, write in writes.items():
            where = circuit.conjunction((choice, write.where))
            if name in merged:
                before = merged[name]
                value = Reading(circuit).chosen(where, write.value, before.value)
                merged[name] = Write(circuit.disjunction((where, before.where)), value)
            else:
                merged[name] = Write(where, write.value)
    return merged


def _affected_flags(automaton: Automaton, changed: set[str]) -> frozenset[str]:
    """The flags that can change when the variables `changed` do."""
    affected: set[str] = set()
    for flag in automaton.flags:
        if any(name in changed or name in affected for name in variables(flag.predicate)):
            affected.add(flag.name)
    return frozenset(affected)
