"""Unrolling of ticks in a SAT solver: a tick's clauses encoded once and instantiated per step."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import combinations, count, repeat

from sequence_planner.automaton.automaton import Ability, Automaton, State, reads
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.language.syntax import Expression, variables
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.goals.tracking import Progress, Tracker, beginning
from sequence_planner.planning.problem import Circumstances, Goal, PlanTick
from sequence_planner.planning.sat.encoding import Encoding, SymbolicTick
from sequence_planner.planning.sat.flattening import flattened
from sequence_planner.planning.sat.partial_order import ANY_START, Singly, in_order
from sequence_planner.planning.sat.solver import Circuit, Solver
from sequence_planner.planning.sat.symbolic import Reading, Symbol, SymbolicState
from sequence_planner.process.budget import Budget
from sequence_planner.process.gc_tuning import collection_put_off

# One tick encoded once, and put down again and again.
#
# The clauses of a tick are recorded over free literals for the state before it. Each further tick has the same clauses
# with other literals: those of the state before it are those at the end of the tick before, and the rest are new.

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
    """Return what effects and finishes read, flags as the tick before left them."""
    found: set[str] = set()
    for effect in automaton.effects:
        found.update(variables(effect.guard), *map(reads, effect.actions))
    for ability in automaton.abilities.values():
        if ability.finish_guard is not None:
            found.update(variables(ability.finish_guard), *map(reads, ability.finish_actions))
    return found


# Ticks one after another in one solver, and what is asked of them as literals of it.


class Unrolling:
    """Runs from any state that gives exactly `unknown`, variables and flags, no value; with `inside`, any safe one."""

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        order: Sequence[Ability],
        unknown: frozenset[str],
        inside: bool,
        frozen: State,
        oracles: frozenset[str],
        budget: Budget,
        singly: Singly = ANY_START,
    ) -> None:
        """Of runs in which the variables `frozen` have these values throughout, which no transition writes to others,
        and the `oracles`, which none writes, any value anew in each tick. Of runs of single starts only those in which
        one follows another as `singly` says, if it says anything.

        Raises `SpentError` when the budget is spent before the first tick is encoded."""
        self.solver = Solver()
        self.circuit = Circuit(self.solver)
        self.ticks: list[SymbolicTick] = []
        with collection_put_off():
            self._template = Template(
                automaton, supervisor, order, unknown, inside, frozen, oracles, budget.require, singly.starts
            )
        self.circuit.reserve(self._template.top)
        self._renaming = self._template.first()
        self._reading = Reading(self.circuit)
        self._tracker = Tracker(self.circuit)
        self._progress: dict[Goal, list[Progress]] = {}
        self._succession = singly.succession
        self._avoided: dict[Expression, list[int]] = {}
        self._counted: dict[tuple[str, int], tuple[int, int]] = {}  # by ability and number: in how many ticks, and how

    def extend(self, length: int, budget: Budget) -> None:
        """So many ticks at least. Raises `SpentError` when the budget is spent meanwhile."""
        while len(self.ticks) < length:
            budget.require()
            if self.ticks:
                self._renaming = self._template.next(self._renaming, self.circuit.top)
                self.circuit.reserve(max(self._renaming))
            self.solver.add_clauses(self._template.renamed(self._renaming))
            tick = self._template.tick(self._renaming, self._reading)
            if self.ticks and tick.earlier:
                self.solver.add_clauses(in_order(self._succession, self.ticks[-1], tick))
            self.ticks.append(tick)
            # A needless choice is one that the solver makes without being asked.
            self.solver.prefer([-choice for choice in (*tick.effects.values(), *(c for _, c in tick.starts))])

    def given(self, state: State, circumstances: Circumstances) -> list[int]:
        """The literals that say runs begin in `state`, and what may happen."""
        literals = self._template.assumptions(circumstances)
        for name, symbol in self._template.start.items():
            for value, literal in symbol.literals.items():
                literals.append(literal if state[name] == value else -literal)
        return literals

    def reached(self, goal: Goal, length: int) -> int:
        """The literal that says the goal was reached in one of the first `length` ticks."""
        progress = self._progress.setdefault(goal, [beginning(goal)])
        while len(progress) <= length:
            progress.append(self._tracker.after(goal, progress[-1], self.ticks[len(progress) - 1]))
        return progress[length].reached

    def keeps(self, circumstances: Circumstances, length: int) -> list[int]:
        """The literals that say the tick at `length` starts nothing barred, and avoids what is to be avoided."""
        barred = self.ticks[length - 1].without(circumstances.barred)
        return [*barred, *(self._avoids(condition, length) for condition in circumstances.avoid)]

    def _avoids(self, condition: Expression, length: int) -> int:
        """The literal that says no position of the tick at `length` satisfies `condition` or leaves it open."""
        avoided = self._avoided.setdefault(condition, [])
        while len(avoided) < length:
            tick = self.ticks[len(avoided)]
            positions = ((Circuit.TRUE, tick.synchronised), *tick.positions)
            avoided.append(
                self.circuit.conjunction(
                    self.circuit.disjunction((-chosen, self._reading.truth(condition, each).no))
                    for chosen, each in positions
                )
            )
        return avoided[length - 1]

    def inside(self, states: StateSet, length: int) -> int:
        """The literal that says the tick at `length` leads into `states`, after step 3 or at its end."""
        last = self.ticks[length - 1]
        return self.circuit.disjunction(self._reading.member(states, each) for each in (last.synchronised, last.end))

    def starts(self, length: int) -> list[int]:
        """The literals that say a start is taken in one of the first `length` ticks."""
        return [choice for tick in self.ticks[:length] for _, choice in tick.starts]

    @cached_property
    def places(self) -> dict[str, list[int]]:
        """By ability, its places in the order of starts, which is the same in all ticks, one of which there must be."""
        places: dict[str, list[int]] = defaultdict(list)
        for place, (name, _) in enumerate(self.ticks[0].starts):
            places[name].append(place)
        return places

    def starting_more(self, ability: str, length: int, number: int) -> int:
        """A literal that is true wherever more than `number` starts of `ability` are taken in the first `length` ticks.

        It may be elsewhere. Where it was asked of more ticks before, it says the same of those: a run to be looked for
        in the first ticks goes on without starts just as well.
        """
        counted, literal = self._counted.get((ability, number), (0, Circuit.FALSE))
        if counted < length:
            places = self.places[ability]
            choices = [tick.starts[place][1] for tick in self.ticks[:length] for place in places]
            literal = self.circuit.exceeding(choices, number)
            self._counted[ability, number] = length, literal
        return literal

    def read(self, length: int, starting: int, model: Sequence[int]) -> tuple[PlanTick, ...]:
        """The run of a model of the solver; only the first `starting` ticks have starts."""
        true = set(model)
        return tuple(
            PlanTick(
                tuple(name for name, choice in tick.effects.items() if choice in true),
                tuple(name for name, choice in tick.starts if choice in true) if number <= starting else (),
            )
            for number, tick in enumerate(self.ticks[:length], start=1)
        )

    def finishing(self, length: int, model: Sequence[int]) -> frozenset[str]:
        """The abilities that finish in the first `length` ticks of a model."""
        true = set(model)
        ticks = self.ticks[:length]
        return frozenset(name for tick in ticks for name, applied in tick.finishes.items() if applied in true)
