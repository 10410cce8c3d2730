"""Proofs that there is no plan, checked by another solver, on clauses of their own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Ability, Automaton
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.syntax import TRUE, Variable
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import replace
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.goals.monitor import monitor_of
from sequence_planner.planning.goals.tracking import Progress, Tracker
from sequence_planner.planning.pdr.invariants import asserted, one_of, open_to
from sequence_planner.planning.pdr.localisation import localisable, localised
from sequence_planner.planning.pdr.ordering import Orders
from sequence_planner.planning.pdr.second_solver import SecondSolver
from sequence_planner.planning.plan import Clause, Goal, Literal, Proof
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.encoding import Encoding, SymbolicTick
from sequence_planner.planning.sat.symbolic import Reading, Symbol, SymbolicState


class CertificateError(Exception):
    """What was given as a proof proves nothing; the message says which step fails."""


def check(
    automaton: Automaton,
    supervisor: Supervisor,
    task: Task,
    proof: Proof,
    budget: Budget,
    orders: Orders | None = None,
    whole: bool = False,
    free: frozenset[str] = frozenset(),
) -> None:
    """Raises `CertificateError` unless `proof` shows that the goals of `task` cannot be reached from its state.

    Nor may they from one like it with any values of the variables `free`; flags follow what is free.

    What the proof speaks of is looked at first, which is enough for most; the whole automaton if that is not enough or
    if it is wanted. `orders` are those of the automaton, if they are at hand. Where the state's flags are as
    synchronisation leaves them, those of every state on the way are. Raises `SpentError`.
    """
    orders = orders or Orders(automaton, supervisor)
    task = replace(task, state=one_of(automaton, task.state, free))
    open_ = open_to(automaton, free)
    if whole or not _without_need_of_the_rest(automaton, supervisor, task, proof, budget, orders, open_):
        _Check(automaton, supervisor, task, orders.whole(task, budget), budget).run(proof, open_)


def _without_need_of_the_rest(
    automaton: Automaton,
    supervisor: Supervisor,
    task: Task,
    proof: Proof,
    budget: Budget,
    orders: Orders,
    open_: frozenset[str],
) -> bool:
    """Whether the proof is one for the part of the automaton that it speaks of, and so for all of it."""
    if not localisable(automaton, task.state, task.goals):
        return False
    names = {literal.name for clause in proof.invariant for literal in clause} & automaton.types.keys()
    read = [Variable(name, automaton.types[name]) for name in sorted(names)]
    asked = [*(goal.predicate for goal in task.goals), *task.circumstances.avoid]
    kept = read_variables(automaton, [*read, *asked])
    seen = localised(automaton, supervisor, kept)
    part = replace(task, state=seen.state(task.state))
    order = orders.part(seen, task, budget)
    try:
        _Check(seen.automaton, seen.supervisor, part, order, budget).run(proof, open_ | seen.oracles.keys())
    except CertificateError:
        return False
    return True


class _Check:
    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, task: Task, order: Iterable[Ability], budget: Budget
    ) -> None:
        self._budget = budget
        self._task = task
        self._automaton = automaton
        self._solver = SecondSolver()
        self._circuit = Circuit(self._solver)
        self._reading = Reading(self._circuit)
        unknown = frozenset(name for name in automaton.variables if task.state[name] is None)
        encoding = Encoding(automaton, supervisor, self._circuit, unknown)
        self._before = encoding.initial(unknown)
        self._synchronised = synchronise(automaton, task.state) == dict(task.state)
        if self._synchronised:
            for literal in self._follow(self._before):
                self._circuit.require(literal)
        progress = {goal: self._any_progress(goal) for goal in task.goals}
        tick = encoding.tick(self._before, order, budget.require)
        tracker = Tracker(self._circuit)
        after = {goal: tracker.after(goal, progress[goal], tick) for goal in task.goals}
        self._end = tick.end
        self._values_before = _values(self._before, progress)
        self._values_after = _values(tick.end, after)
        self._reached = self._circuit.conjunction(each.reached for each in after.values())
        # Where all have been reached there is nothing left to do; no tick is about to lead there.
        open_ = -self._circuit.conjunction(each.reached for each in progress.values())
        barred = tick.without(task.circumstances.barred)
        self._given = [open_, *encoding.assumptions(task.circumstances), *barred, *self._avoided(tick)]

    def run(self, proof: Proof, open_: frozenset[str]) -> None:
        """All steps of the proof, from the state with any values of what is `open_`."""
        beginning = self._beginning(open_)
        before = [self._clause(clause, self._values_before) for clause in proof.invariant]
        after = [self._clause(clause, self._values_after) for clause in proof.invariant]
        if self._satisfiable([*beginning, -self._circuit.conjunction(before)]):
            raise CertificateError("the state to plan from does not satisfy the invariant")
        if self._satisfiable([*self._given, *before, self._reached]):
            raise CertificateError("the goals are reached from a state that satisfies the invariant")
        if self._satisfiable([*self._given, *before, -self._circuit.conjunction(after)]):
            raise CertificateError("a tick leads out of the states that satisfy the invariant")
        if self._synchronised and self._satisfiable([-self._circuit.conjunction(self._follow(self._end))]):
            raise CertificateError("a tick leaves flags unsynchronised")

    def _beginning(self, open_: frozenset[str]) -> list[int]:
        given = asserted(self._task.state, self._task.goals)
        return [
            literal if given[name] == value else -literal
            for name, symbol in self._values_before.items()
            if name not in open_
            for value, literal in symbol.literals.items()
        ]

    def _follow(self, state: SymbolicState) -> list[int]:
        """That each flag is what its predicate is, where that is determined."""
        follow: list[int] = []
        for flag in self._automaton.flags:
            truth = self._reading.truth(flag.predicate, state)
            for condition, value in ((truth.yes, True), (truth.no, False)):
                follow.append(self._circuit.disjunction((-condition, state[flag.name].literal(value))))
        return follow

    def _clause(self, clause: Clause, values: Mapping[str, Symbol]) -> int:
        return self._circuit.disjunction(self._literal(literal, values) for literal in clause)

    def _literal(self, literal: Literal, values: Mapping[str, Symbol]) -> int:
        if literal.name not in values:
            raise CertificateError(f"the proof speaks of {literal.name}, which the model does not have")
        equal = values[literal.name].literal(literal.value)
        return equal if literal.equal else -equal

    def _any_progress(self, goal: Goal) -> Progress:
        circuit = self._circuit
        reached = circuit.fresh()
        if goal.local == TRUE:
            return Progress(reached, {})
        at = {number: circuit.fresh() for number in range(len(monitor_of(goal.local).steps))}
        circuit.at_most_one([reached, *at.values()])
        return Progress(reached, at)

    def _avoided(self, tick: SymbolicTick) -> list[int]:
        positions = [(Circuit.TRUE, tick.synchronised), *tick.positions]
        return [
            self._circuit.disjunction((-chosen, self._reading.truth(condition, state).no))
            for condition in self._task.circumstances.avoid
            for chosen, state in positions
        ]

    def _satisfiable(self, assumptions: list[int]) -> bool:
        return self._solver.solve(assumptions, self._budget)


def _values(state: SymbolicState, progress: Mapping[Goal, Progress]) -> dict[str, Symbol]:
    """What clauses can speak of."""
    values = dict(state)
    for goal, made in progress.items():
        values[f"goal.{goal.name}.reached"] = Symbol({False: -made.reached, True: made.reached})
        at: dict[Value, int] = {}
        at.update(made.at.items())
        values[f"goal.{goal.name}.at"] = Symbol(at)
    return values
