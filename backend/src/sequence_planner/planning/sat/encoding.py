"""The tick as a circuit: the same steps as `automaton.tick`, over symbolic states.

Choices are free variables: which effects happen, which abilities start. Everything else is a function of the state
before, so a state is never copied: unrolling builds one circuit from the initial values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from itertools import combinations
from types import MappingProxyType
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability, Automaton, Flag, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.types import Value
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.problem import Circumstances
from sequence_planner.planning.sat.flag_dependencies import FollowingFlags
from sequence_planner.planning.sat.single_step import SingleStep
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.symbolic import (
    FollowingState,
    Reading,
    Symbol,
    SymbolicState,
    SymbolicWriter,
    Write,
    Writes,
    sharing,
)


class SymbolicTick(NamedTuple):
    """One tick: the choices, the finishes applied, the state after step 3 and after each place in the order of starts.

    A position counts where its start is chosen; the last is the end of the tick, whatever is chosen. Where one start at
    a time is taken there is one position, and `earlier` says at each place that the start there or one before it is.
    """

    effects: Mapping[str, int]
    finishes: Mapping[str, int]
    starts: Sequence[tuple[str, int]]
    synchronised: SymbolicState
    positions: Sequence[tuple[int, SymbolicState]]
    earlier: Sequence[int] = ()

    @property
    def end(self) -> SymbolicState:
        """The state at the end of the tick."""
        return self.positions[-1][1] if self.positions else self.synchronised

    def without(self, barred: Set[str]) -> list[int]:
        """The literals that say none of the abilities `barred` starts."""
        return [-choice for name, choice in self.starts if name in barred]


class Encoding:
    """Reads an automaton under its supervisor into a circuit; `unknown` variables have no value and get none.

    With `inside`, runs begin in safe states, which only a start could leave. With `lazily`, flags after step 3 are read
    into the circuit when they are asked for, as far as nothing is unknown.
    """

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        circuit: Circuit,
        unknown: frozenset[str],
        inside: bool = False,
        lazily: bool = False,
        starts: Starts | None = None,
    ) -> None:
        self.automaton = automaton
        self._starts = starts or Starts(automaton, supervisor) if automaton.one_at_a_time else None
        self._circuit = circuit
        self.reading = Reading(circuit)
        self._writing = SymbolicWriter(automaton, circuit)
        self._effects = [effect for effect in automaton.effects if not effect.fault]
        self._following = FollowingFlags(automaton)
        self._safe = supervisor.safe.for_all(unknown)
        # The guards speak of states whose flags are determined. With unknown values a flag can be older than the state,
        # and only the safe set itself tells where a start may lead.
        self._by_guards = not unknown
        self._inside = inside and not unknown
        self._lazily = lazily and not unknown
        self._guards = supervisor.guards
        acting = {a.resource for a in automaton.abilities.values()} | {e.resource for e in self._effects}
        self._online = {resource: circuit.fresh() for resource in sorted(acting)}
        self._restart = circuit.fresh()

    def assumptions(self, circumstances: Circumstances) -> list[int]:
        """The literals that say which resources are online, and whether restart abilities may start.

        Which abilities are barred is said of each tick (`SymbolicTick.without`): mostly none is.
        """
        online = [-one if name in circumstances.offline else one for name, one in self._online.items()]
        return [*online, self._restart if circumstances.restart else -self._restart]

    def initial(
        self,
        unknown: frozenset[str],
        synchronised: bool = False,
        determined: Set[str] = frozenset(),
        frozen: State = MappingProxyType({}),
    ) -> SymbolicState:
        """A state of free values, but for those `frozen`. Flags are functions of the variables, or free too; all but
        those `determined` may then have no value.
        """
        state: dict[str, Symbol] = {}
        for name, variable in self.automaton.variables.items():
            if name in unknown:
                state[name] = Symbol({}, Circuit.FALSE)
            elif (value := frozen.get(name)) is not None:
                # Both values of a truth value, as wherever one is chosen.
                others = dict.fromkeys(variable.type.domain, Circuit.FALSE)
                state[name] = Symbol({**others, value: Circuit.TRUE})
            else:
                state[name] = self._free(variable.type.domain)
        for flag in self.automaton.flags:
            if synchronised:
                state[flag.name] = Symbol({}, Circuit.FALSE)
            elif flag.name in determined:
                state[flag.name] = self._free((False, True))
            else:
                yes, no = self._circuit.fresh(), self._circuit.fresh()
                self._circuit.require(-yes, -no)
                state[flag.name] = Symbol({False: no, True: yes}, self._circuit.disjunction((yes, no)))
        return self._synchronise(state, self.automaton.flags) if synchronised else state

    def tick(
        self, state: SymbolicState, order: Iterable[Ability], pause: Callable[[], object] = lambda: None
    ) -> SymbolicTick:
        """One tick from `state`; each ability starts at most once, at one of its places in `order`.

        `pause` is called before each place, and may raise.
        """
        if self.automaton.one_at_a_time:
            return self._step(state, order, pause)
        effects, sensed = self._sense(state)
        finishes, finished = self._finish(sensed)
        synchronised = self._synchronise(finished, self.automaton.flags)
        safe = Circuit.TRUE if self._inside else self.safe(synchronised)
        end = synchronised
        positions: list[tuple[int, SymbolicState]] = []
        starts: list[tuple[str, int]] = []
        places: dict[str, list[int]] = {}
        for ability in order:
            pause()
            choice = self._circuit.fresh()
            starts.append((ability.name, choice))
            places.setdefault(ability.name, []).append(choice)
            allowed, end = self.start(ability, end, state, choice)
            positions.append((choice, end))
            for condition in (safe, allowed, self._online[ability.resource]):
                self._circuit.require(-choice, condition)
            if ability.restart:
                self._circuit.require(-choice, self._restart)
        for choices in places.values():
            self._circuit.at_most_one(choices)
        return SymbolicTick(effects, finishes, starts, synchronised, positions)

    def _step(self, state: SymbolicState, order: Iterable[Ability], pause: Callable[[], object]) -> SymbolicTick:
        """At most one start from a safe state in which nothing is unknown, of an automaton with nothing but starts."""
        assert self._starts is not None
        step = SingleStep(self._starts, self._circuit, self.reading, self._writing)
        starts, earlier, end = step.choices(state, order, self._permitted, pause)
        return SymbolicTick({}, {}, starts, state, [(earlier[-1] if earlier else Circuit.FALSE, end)], earlier)

    def _permitted(self, ability: Ability, state: SymbolicState) -> int:
        """Return whether the supervisor allows a start in a safe state in which nothing is unknown."""
        guard = self._guards.get(ability.name)
        return Circuit.TRUE if guard is None else self.reading.member(guard, state)

    def safe(self, state: SymbolicState) -> int:
        """The literal that says the state is safe."""
        return self.reading.member(self._safe, state)

    def start(
        self, ability: Ability, state: SymbolicState, published: SymbolicState, choice: int
    ) -> tuple[int, SymbolicState]:
        """Return whether `ability` may start in a safe `state`, and the state after it where `choice` is true."""
        writes, determined = self._writing.writes(ability.start_actions, state)
        after = self._writing.applied(
            state, {n: Write(self._circuit.both(choice, w.where), w.value) for n, w in writes.items()}
        )
        conditions = [
            determined,
            self.reading.truth(ability.enabled, state).yes,
            self.reading.truth(ability.start_guard, state).yes,
            *(-self._reverts(name, state, published, write) for name, write in writes.items()),
        ]
        if not self._lazily:
            conditions.append(state[ability.flag("enabled")].literal(True))
        if not self._by_guards or ability.restart:
            conditions.append(self.safe(after))
        else:
            conditions.append(self._permitted(ability, state))
        return self._circuit.conjunction(conditions), self._synchronise(after, self._following.flags(writes))

    def _free(self, domain: Sequence[Value]) -> Symbol:
        if domain == (False, True):
            literal = self._circuit.fresh()
            return Symbol({False: -literal, True: literal})
        literals = {value: self._circuit.fresh() for value in domain}
        self._circuit.require(*literals.values())
        for one, other in combinations(literals.values(), 2):
            self._circuit.require(-one, -other)
        return Symbol(literals)

    def _sense(self, state: SymbolicState) -> tuple[dict[str, int], SymbolicState]:
        choices: dict[str, int] = {}
        taken: dict[str, tuple[int, Writes]] = {}
        for effect in self._effects:
            choice = choices[effect.name] = self._circuit.fresh()
            self._circuit.require(-choice, self._online[effect.resource])
            writes, determined = self._writing.writes(effect.actions, state)
            self._circuit.require(-choice, determined)
            self._circuit.require(-choice, self.reading.truth(effect.guard, state).yes)
            # An unknown variable stays unknown, whatever the effect would make of it.
            known = {n: w for n, w in writes.items() if state[n].known != Circuit.FALSE}
            taken[effect.name] = (choice, known)
        for one, other in sharing({name: writes for name, (_, writes) in taken.items()}):
            self._circuit.require(
                -choices[one], -choices[other], -self._writing.conflict(taken[one][1], taken[other][1])
            )
        return choices, self._writing.together(state, taken.values())

    def _finish(self, state: SymbolicState) -> tuple[dict[str, int], SymbolicState]:
        candidates: dict[str, tuple[int, Writes]] = {}
        for name, ability in self.automaton.abilities.items():
            if ability.finish_guard is None or not ability.finish_actions:
                continue
            writes, determined = self._writing.writes(ability.finish_actions, state)
            holds = self.reading.truth(ability.finish_guard, state).yes
            candidates[name] = (self._circuit.both(holds, determined), writes)
        disputes: dict[str, list[int]] = {name: [] for name in candidates}
        for one, other in sharing({name: writes for name, (_, writes) in candidates.items()}):
            (holds, first), (other_holds, second) = candidates[one], candidates[other]
            conflict = self._writing.conflict(first, second)
            disputes[one].append(self._circuit.both(other_holds, conflict))
            disputes[other].append(self._circuit.both(holds, conflict))
        applied = {
            name: (self._circuit.conjunction((holds, *(-dispute for dispute in disputes[name]))), writes)
            for name, (holds, writes) in candidates.items()
        }
        finishes = {name: holds for name, (holds, _) in applied.items()}
        return finishes, self._writing.together(state, applied.values())

    def _synchronise(self, state: SymbolicState, flags: Iterable[Flag]) -> SymbolicState:
        if self._lazily:
            return FollowingState(state, flags, self.automaton.flag_predicates, self.reading)
        after = dict(state)
        for flag in flags:
            truth = self.reading.truth(flag.predicate, after)
            old = after[flag.name]
            if truth.no == -truth.yes:
                after[flag.name] = Symbol({False: truth.no, True: truth.yes})
                continue
            # What is undetermined keeps its value; a flag that had one never loses it.
            undetermined = self._circuit.both(-truth.yes, -truth.no)
            yes = self._circuit.disjunction((truth.yes, self._circuit.both(undetermined, old.literal(True))))
            if old.known == Circuit.TRUE:
                after[flag.name] = Symbol({False: -yes, True: yes})
                continue
            no = self._circuit.disjunction((truth.no, self._circuit.both(undetermined, old.literal(False))))
            after[flag.name] = Symbol({False: no, True: yes}, self._circuit.disjunction((yes, no)))
        return after

    def _reverts(self, name: str, state: SymbolicState, published: SymbolicState, write: Write) -> int:
        """The start would set the output back to what was published, and nobody would have seen its value now."""
        if name not in self.automaton.outputs:
            return Circuit.FALSE
        circuit, now, then = self._circuit, state[name], published[name]
        back = [
            circuit.conjunction((literal, then.literal(value), -now.literal(value)))
            for value, literal in write.value.literals.items()
        ]
        return circuit.conjunction((write.where, circuit.disjunction(back)))
