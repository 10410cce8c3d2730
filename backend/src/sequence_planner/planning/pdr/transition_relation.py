"""SAT transition relation of one tick for PDR: queries, and stepwise reconstruction of plans."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pysolvers

from sequence_planner.automaton.automaton import Ability, Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import synchronise
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.monitor import monitor_of
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.goals.tracking import Progress, Tracker
from sequence_planner.planning.pdr.proof_clauses import asserted, is_met
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances, Clause, Goal, Literal
from sequence_planner.planning.sat.encoding import Encoding, SymbolicTick
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.symbolic import Reading, SymbolicState
from sequence_planner.process.budget import Budget, SpentError

# One tick as a relation between states: a literal for each value of a variable before it, and one for after it.
#
# What a tick leads to is a function of the state and the choices, so a value after it is a gate and not a variable of
# its own. What the choices must keep to is gathered into one literal, `valid`: a question about a tick assumes it, and
# a question about what it takes to make a tick possible denies it.

Cube = tuple[int, ...]


class _Clauses:
    """The place that the circuit writes to; everything is handed to solvers at once."""

    def __init__(self) -> None:
        self.all: list[list[int]] = []

    def add_clause(self, clause: list[int], /) -> None:
        self.all.append(clause)


class _Gathering(Circuit):
    """A circuit that can keep what is required apart from the gates."""

    def __init__(self, sink: _Clauses) -> None:
        super().__init__(sink)
        self.gathered: list[tuple[int, ...]] | None = None

    def require(self, *literals: int) -> None:
        """Demand that at least one of `literals` is true, or note that it is demanded."""
        if self.gathered is None:
            super().require(*literals)
        else:
            self.gathered.append(literals)


class Relation:
    """One tick from states in which exactly the variables have no value that have none in `state`.

    Flags are as synchronisation leaves them if those of `state` are. `inputs` are variables that have any value in any
    tick. With several goals, states also say which have been reached. Raises `SpentError`.
    """

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        order: Iterable[Ability],
        task: PlanningTask,
        state: State,
        budget: Budget,
        inputs: frozenset[str] = frozenset(),
    ) -> None:
        goals, circumstances = task.goals, task.circumstances
        sink = _Clauses()
        self._circuit = circuit = _Gathering(sink)
        self._automaton = automaton
        unknown = frozenset(name for name in automaton.variables if state[name] is None)
        encoding = Encoding(automaton, supervisor, circuit, unknown)
        for literal in encoding.assumptions(circumstances):
            circuit.require(literal)
        self.free_flags = bool(unknown) or synchronise(automaton, state) != dict(state)
        self._before = encoding.initial(unknown, synchronised=not self.free_flags)
        progress = {goal: self._progress(goal, len(goals) == 1) for goal in goals}
        self.unfinished = [-each.reached for each in progress.values()]  # one of them is true while a goal is left
        circuit.gathered = []
        tick = encoding.tick(self._before, order, budget.require)
        tracker = Tracker(circuit)
        after = {goal: tracker.after(goal, progress[goal], tick) for goal in goals}
        kept = self._kept(tick, circumstances)
        demands = [circuit.disjunction(clause) for clause in circuit.gathered]
        circuit.gathered = None
        self.valid = circuit.conjunction([*demands, *kept])
        self.reached = circuit.conjunction(progress.reached for progress in after.values())
        self.oracles = [
            (name, literal)
            for name in sorted(inputs)
            for literal in self._before[name].literals.values()
            if literal > 0
        ]
        self.effects = dict(tick.effects)
        self.starts = tuple(tick.starts)
        self.meanings: dict[int, Literal] = {}
        self._after: dict[int, int] = {}
        self._several: set[int] = set()  # values of which exactly one is taken
        self._states(tick.end, inputs)
        for goal in goals:
            self._goal(goal, progress[goal], after[goal])
        self.bits = tuple(self.meanings)
        self.clauses = sink.all
        self.top = circuit.top

    @property
    def choices(self) -> list[int]:
        """The choices that decide a tick besides the state."""
        return [*self.effects.values(), *(choice for _, choice in self.starts), *(bit for _, bit in self.oracles)]

    def state(self, model: Sequence[int]) -> list[int]:
        """Return what a model of the clauses says of the state.

        Of a variable of several values that are the ones it does not have: so it can be left open which others it has.
        """
        chosen = (bit if bit <= len(model) and model[bit - 1] > 0 else -bit for bit in self.bits)
        return [literal for literal in chosen if literal < 0 or literal not in self._several]

    def after(self, literal: int) -> int:
        """The literal that says after the tick what `literal` says before it."""
        return self._after[literal] if literal > 0 else -self._after[-literal]

    def beginning(self, state: State, goals: Goals, free: frozenset[str] = frozenset()) -> Cube:
        """The states like `state` in which the variables `free` have any value, and the goals are as they are."""
        values = asserted(state, goals)
        return tuple(
            bit if is_met(literal, values) else -bit
            for bit, literal in self.meanings.items()
            if literal.name not in free
        )

    def excluding(self, cube: Cube) -> Clause:
        """The clause, in the model's names, that says a state is not in `cube`."""
        return tuple(self._meaning(-literal) for literal in cube)

    def values(self, model: Sequence[int]) -> dict[str, Value]:
        """Return what a model of the clauses says of the state."""
        true = set(model)
        said = (self._meaning(bit if bit in true else -bit) for bit in self.bits)
        return {literal.name: literal.value for literal in said if literal.equal}

    def includes(self, cube: Cube, state: State) -> bool:
        """Return whether `state` is in `cube`, whatever has been reached."""
        met = ((literal > 0, self.meanings[abs(literal)]) for literal in cube)
        return all((state[each.name] == each.value) is true for true, each in met if each.name in state)

    def _meaning(self, literal: int) -> Literal:
        meaning = self.meanings[abs(literal)]
        if literal > 0:
            return meaning
        variable = self._before.get(meaning.name)
        if variable is not None and variable.literals == {False: -abs(literal), True: abs(literal)}:
            return Literal(meaning.name, False)
        return Literal(meaning.name, meaning.value, equal=False)

    def _states(self, end: SymbolicState, inputs: frozenset[str]) -> None:
        flags = self._automaton.flag_predicates
        for name, symbol in self._before.items():
            if name in inputs or (name in flags and not self.free_flags):
                continue
            for value, literal in symbol.literals.items():
                if literal > 0:
                    self.meanings[literal] = Literal(name, value)
                    self._after[literal] = end[name].literal(value)
            if name not in flags and min(symbol.literals.values(), default=0) > 0:
                self._several.update(symbol.literals.values())

    def _goal(self, goal: Goal, before: Progress, after: Progress) -> None:
        if before.reached != Circuit.FALSE:
            self.meanings[before.reached] = Literal(f"goal.{goal.name}.reached", True)
            self._after[before.reached] = after.reached
        for at, literal in before.at.items():
            self.meanings[literal] = Literal(f"goal.{goal.name}.at", at)
            self._after[literal] = after.at.get(at, Circuit.FALSE)

    def _progress(self, goal: Goal, alone: bool) -> Progress:
        """Any progress; a goal that is `alone` has not been reached where anything is left to do."""
        circuit = self._circuit
        reached = Circuit.FALSE if alone else circuit.fresh()
        if goal.local == TRUE:
            return Progress(reached, {})
        monitor = monitor_of(goal.local)
        at = {number: circuit.fresh() for number in range(len(monitor.steps)) if number not in monitor.hopeless}
        circuit.at_most_one([reached, *at.values()])
        return Progress(reached, at)

    def _kept(self, tick: SymbolicTick, circumstances: Circumstances) -> list[int]:
        """That nothing barred starts, and no position satisfies a condition to be avoided, or leaves it open."""
        reading = Reading(self._circuit)
        positions: Sequence[tuple[int, SymbolicState]] = ((Circuit.TRUE, tick.synchronised), *tick.positions)
        avoided = [
            self._circuit.disjunction((-chosen, reading.truth(condition, each).no))
            for condition in circumstances.avoid
            for chosen, each in positions
        ]
        return [*tick.without(circumstances.barred), *avoided]


# Questions about one tick to a SAT solver.
#
# It is Minisat 2.2 (Een and Sorensson 2003): most questions are small, and its answers to them come soonest. As in
# `sat.solver`, the functions that python-sat wraps are called themselves.

# Conflicts within which most questions are answered; only longer ones are worth an alarm clock, which is a thread.
_AT_ONCE = 1000

# Clauses for one question each, after which the solver is worn.
_MOST_PASSING = 4000


class TickQueries:
    """A solver that knows `relation`, and what else is demanded. Each question may raise `SpentError`."""

    def __init__(self, relation: Relation, budget: Budget) -> None:
        self._budget = budget
        self._handle: object = pysolvers.minisat22_new()
        for clause in relation.clauses:
            pysolvers.minisat22_add_cl(self._handle, clause)
        self.prefer([-choice for choice in relation.choices])
        self._top = relation.top
        self._passed = 0
        self._current = self.fresh()

    def __del__(self) -> None:
        pysolvers.minisat22_del(self._handle)

    @property
    def worn(self) -> bool:
        """True if a new one would be quicker."""
        return self._passed >= _MOST_PASSING

    def fresh(self) -> int:
        """A new variable."""
        self._top += 1
        return self._top

    def demand(self, clause: Sequence[int]) -> None:
        """Demand that one of the literals is true."""
        pysolvers.minisat22_add_cl(self._handle, clause)

    def prefer(self, literals: Sequence[int]) -> None:
        """Try these literals true first, where nothing decides them."""
        pysolvers.minisat22_setphases(self._handle, literals)

    def passing(self, clause: Iterable[int]) -> int:
        """The literal that puts `clause` in force, for questions until the next one."""
        self.demand([-self._current])
        self._passed += 1
        self._current = self.fresh()
        self.demand([-self._current, *clause])
        return self._current

    def solves(self, assumptions: Sequence[int]) -> bool:
        """Return whether the assumptions can hold together."""
        self._budget.require()
        pysolvers.minisat22_cbudget(self._handle, _AT_ONCE)
        answer: bool | None = pysolvers.minisat22_solve_lim(self._handle, assumptions, 0, 0)
        if answer is None:
            answer = self._solves_in_time(assumptions)
        if answer is None:
            raise SpentError
        return answer

    def model(self) -> list[int]:
        """The literals that are true in the answer to the last question, which was yes, by their variables."""
        return pysolvers.minisat22_model(self._handle) or []

    def core(self) -> set[int]:
        """Assumptions that cannot hold together, of the last question, whose answer was no."""
        return set(pysolvers.minisat22_core(self._handle) or ())

    def _solves_in_time(self, assumptions: Sequence[int]) -> bool | None:
        pysolvers.minisat22_cbudget(self._handle, -1)
        with self._budget.interrupting(self._interrupt):
            answer: bool | None = pysolvers.minisat22_solve_lim(self._handle, assumptions, 0, 1)
        pysolvers.minisat22_clearint(self._handle)
        return answer

    def _interrupt(self) -> None:
        pysolvers.minisat22_interrupt(self._handle)


# Ways to the goals, step by step.


class ChoiceStep(Immutable):
    """From each state of `cube` a tick with these choices leads into the cube that follows, or reaches the goals.

    `oracles` are the inputs that it takes.
    """

    cube: Cube
    effects: tuple[str, ...]
    starts: tuple[str, ...]
    oracles: frozenset[str]
    following: ChoiceStep | None

    @property
    def run(self) -> list[ChoiceStep]:
        """This step and those that follow."""
        steps, step = [self], self.following
        while step is not None:
            steps.append(step)
            step = step.following
        return steps
