"""One tick encoded once, and put down again and again.

The clauses of a tick are recorded over free literals for the state before it. Each further tick has the same clauses
with other literals: those of the state before it are those at the end of the tick before, and the rest are new.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import combinations, count, repeat

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton, State, reads
from sequence_planner.expressions.syntax import Expression, variables
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.plan import Circumstances
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.encoding import Encoding, SymbolicTick
from sequence_planner.planning.sat.flattening import flattened
from sequence_planner.planning.sat.symbolic import Reading, Symbol, SymbolicState

# The literal of each literal of the template: at its own index, that of a negated one counted from the end.
Renaming = Sequence[int]

_ANEW = 0  # instead of a literal: a new one in each tick
_MOST_EXCLUDING = 8  # values of a variable of which each is said to exclude the others; pairs of more are too many


class Recorder:
    """Keeps clauses."""

    def __init__(self) -> None:
        self.clauses: list[list[int]] = []

    def add_clause(self, clause: list[int], /) -> None:
        """Add one clause."""
        self.clauses.append(clause)


class Template:
    """The tick from states in which exactly `unknown`, variables and flags, have no value.

    With `inside`, only from safe states. The variables `frozen` have these values throughout, and the `oracles` any
    value anew in each tick. `pause` is called now and then while it is made, and may raise. Where one start is taken at
    a time, `starts` knows what these ask for.
    """

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        order: Sequence[Ability],
        unknown: frozenset[str],
        inside: bool,
        frozen: State,
        oracles: frozenset[str],
        pause: Callable[[], object],
        starts: Starts | None = None,
    ) -> None:
        recorder = Recorder()
        circuit = Circuit(recorder, later=True)
        blind = unknown & automaton.variables.keys()
        self._predicates = automaton.flag_predicates
        self._encoding = Encoding(automaton, supervisor, circuit, blind, inside, lazily=not unknown, starts=starts)
        self._shared = circuit.top  # literals up to here mean the same in all ticks
        free = self._encoding.initial(blind, determined=self._predicates.keys() - unknown, frozen=frozen)
        kept = free.keys() if unknown else automaton.variables.keys() | _read_before_synchronising(automaton)
        self.start = {name: symbol for name, symbol in free.items() if name in kept and name not in oracles}
        self._inputs = circuit.top
        recorder.clauses = [[Circuit.TRUE]]  # what must hold of a state holds at the end of each tick
        for name in unknown - blind:
            # An undetermined flag is known where one of its values is; this gate is part of the tick.
            recorder.clauses += _known(self.start[name])
        anew = {name: free[name] for name in sorted(oracles)}
        for symbol in anew.values():
            recorder.clauses += _one_value(symbol)
        self._tick = self._encoding.tick(self.start | anew, order, pause)
        if not automaton.one_at_a_time:
            recorder.clauses += _no_two_values(self._tick.synchronised.values())
        self._carried = self._carry(anew.values())
        asked = set(map(abs, self._asked()))
        self._literals: dict[int, list[int]] = defaultdict(list)  # of all clauses of a length, one after the other
        for clause in flattened(recorder.clauses, circuit.gates, self._inputs, asked, pause):
            self._literals[len(clause)] += clause
        self.top = circuit.top
        met = {abs(literal) for literals in self._literals.values() for literal in literals}
        self._own = [literal in met for literal in range(self._inputs + 1, self.top + 1)]  # the others mean nothing

    def assumptions(self, circumstances: Circumstances) -> list[int]:
        """The literals that say what may happen."""
        return self._encoding.assumptions(circumstances)

    def first(self) -> Renaming:
        """The renaming of the first tick, which leaves everything as it is."""
        return _both_signs(list(range(self.top + 1)))

    def next(self, before: Renaming, top: int) -> Renaming:
        """The renaming of the tick after one renamed `before`; new variables come after `top`."""
        literals, new = list(range(self._shared + 1)), count(top + 1)
        literals += [next(new) if literal == _ANEW else before[literal] for literal in self._carried]
        literals += [next(new) if own else Circuit.FALSE for own in self._own]
        return _both_signs(literals)

    def renamed(self, renaming: Renaming) -> Iterator[tuple[int, ...]]:
        """The clauses of the tick so renamed."""
        for length, literals in self._literals.items():
            yield from zip(*repeat(map(renaming.__getitem__, literals), length), strict=True)

    def tick(self, renaming: Renaming, reading: Reading) -> SymbolicTick:
        """The tick so renamed; `reading` is asked for flags that the tick itself does not need."""
        tick = self._tick

        def renamed(state: SymbolicState) -> SymbolicState:
            return RenamedState(state, renaming, self._predicates, reading)

        return SymbolicTick(
            {name: renaming[choice] for name, choice in tick.effects.items()},
            {name: renaming[applied] for name, applied in tick.finishes.items()},
            [(name, renaming[choice]) for name, choice in tick.starts],
            renamed(tick.synchronised),
            [(renaming[choice], renamed(state)) for choice, state in tick.positions],
            [renaming[one] for one in tick.earlier],
        )

    def _asked(self) -> Iterator[int]:
        """The literals that anybody may ask to be true or false: those of states, finishes, starts and the end."""
        states = (self._tick.synchronised, *(state for _, state in self._tick.positions))
        symbols = {id(symbol): symbol for state in states for symbol in state.values()}
        for symbol in symbols.values():
            yield from symbol.literals.values()
            yield symbol.known
        yield from self._tick.finishes.values()
        yield from self._tick.earlier
        yield from self._carried

    def _carry(self, anew: Iterable[Symbol]) -> list[int]:
        """For each literal of the state before, in order, the one that says the same at the end."""
        end = self._tick.end
        carried = {abs(literal): _ANEW for symbol in anew for literal in symbol.literals.values()}
        for name, symbol in self.start.items():
            pairs = [(literal, end[name].literal(value)) for value, literal in symbol.literals.items()]
            for literal, after in (*pairs, (symbol.known, end[name].known)):
                carried[abs(literal)] = after if literal > 0 else -after
        # Flags that no tick needs from the one before are no part of the state: their literals stay without meaning.
        return [carried.get(literal, Circuit.FALSE) for literal in range(self._shared + 1, self._inputs + 1)]


class RenamedState(Mapping[str, Symbol]):
    """A state with other literals, read as it is asked for."""

    __slots__ = ("_known", "_predicates", "_reading", "_renaming", "_state")

    def __init__(
        self, state: SymbolicState, renaming: Renaming, predicates: Mapping[str, Expression], reading: Reading
    ) -> None:
        self._state = state
        self._renaming = renaming
        self._predicates = predicates
        self._reading = reading
        self._known: dict[str, Symbol] = {}

    def __getitem__(self, name: str) -> Symbol:
        if name not in self._known:
            self._known[name] = self._renamed(name) if name in self._state else self._followed(name)
        return self._known[name]

    def _renamed(self, name: str) -> Symbol:
        symbol, renaming = self._state[name], self._renaming
        literals = {value: renaming[literal] for value, literal in symbol.literals.items()}
        return Symbol(literals, renaming[symbol.known])

    def _followed(self, flag: str) -> Symbol:
        truth = self._reading.truth(self._predicates[flag], self)
        return Symbol({False: truth.no, True: truth.yes})

    def __iter__(self) -> Iterator[str]:
        return iter(self._state)

    def __len__(self) -> int:
        return len(self._state)


def _both_signs(literals: list[int]) -> list[int]:
    return literals + [-literal for literal in literals[:0:-1]]


def _known(flag: Symbol) -> list[list[int]]:
    """That a flag is known exactly where it has a value."""
    values = list(flag.literals.values())
    return [[-flag.known, *values], *([flag.known, -value] for value in values)]


def _one_value(symbol: Symbol) -> list[list[int]]:
    """That it has one of its values, and no other."""
    return [list(symbol.literals.values()), *_excluding(symbol)]


def _excluding(symbol: Symbol) -> Iterator[list[int]]:
    """That it has no two values."""
    return ([-one, -other] for one, other in combinations(symbol.literals.values(), 2))


def _no_two_values(symbols: Iterable[Symbol]) -> Iterator[list[int]]:
    """That none has two values. It follows from all else, but not at a glance: said, it spares a solver conflicts."""
    for symbol in symbols:
        if 2 < len(symbol.literals) <= _MOST_EXCLUDING and Circuit.TRUE not in symbol.literals.values():
            yield from _excluding(symbol)


def _read_before_synchronising(automaton: Automaton) -> set[str]:
    """What effects and finishes read, flags as the tick before left them."""
    found: set[str] = set()
    for effect in automaton.effects:
        found.update(variables(effect.guard), *map(reads, effect.actions))
    for ability in automaton.abilities.values():
        if ability.finish_guard is not None:
            found.update(variables(ability.finish_guard), *map(reads, ability.finish_actions))
    return found
