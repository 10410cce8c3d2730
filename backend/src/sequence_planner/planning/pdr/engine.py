"""Proofs that there is no plan at all, or plans that are not the shortest.

First the automaton is seen through the variables of the goals alone. A way to the goals found there is tried on the
reference tick; if it fails, the variables that it needed and that are not seen come into sight (Clarke et al. 2000). A
proof found through few variables is one for the whole automaton.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.types import Value
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.pdr.certificate import check
from sequence_planner.planning.pdr.frames import DepthError, Frames
from sequence_planner.planning.pdr.localisation import localisable, localised
from sequence_planner.planning.pdr.ordering import Orders
from sequence_planner.planning.pdr.pairs import excluded_pairs
from sequence_planner.planning.pdr.rehearsal import Rehearsal
from sequence_planner.planning.pdr.relation import Cube, Relation
from sequence_planner.planning.pdr.sight import Sight
from sequence_planner.planning.pdr.steps import Step
from sequence_planner.planning.plan import Contract, Plan, PlanTick, Proof
from sequence_planner.planning.sat.following import Following
from sequence_planner.planning.sat.sweep import Order

NAME = "pdr"

# Frames after which it is better to see more.
DEEP = 10

# Rounds of seeing more; then everything that could matter is seen.
_MOST_ROUNDS = 40


@dataclass(frozen=True)
class Decision:
    """A plan from `state`, or a proof that there is none from any of the states in question."""

    state: State
    ticks: tuple[PlanTick, ...]
    proof: Proof | None = None


class Reachability:
    """Decides for one automaton under one supervisor whether goals can be reached at all."""

    name = NAME

    def __init__(self, automaton: Automaton, supervisor: Supervisor, order: Order | None = None) -> None:
        """Starts are taken in `order`, if every order that can make a difference is a part of it."""
        self._automaton = automaton
        self._supervisor = supervisor
        self._orders = Orders(automaton, supervisor, order)
        self._sight = Sight(automaton, supervisor)

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A proof, which has been checked, or, where the contract allows it, a plan; or nothing."""
        try:
            decision = self.decide(task, budget)
            if decision.proof is None:
                plan = Plan(decision.ticks, minimal_ticks=False, minimal_starts=False)
                return Finding(plan) if task.contract is Contract.FAST else Finding()
            check(self._automaton, self._supervisor, task, decision.proof, budget, self._orders)
        except SpentError:
            return Finding()
        return Finding(proof=decision.proof)

    def decide(self, task: Task, budget: Budget, free: frozenset[str] = frozenset()) -> Decision:
        """Whether the goals can be reached from a state like that of `task`, with any values of the variables `free`.

        A plan has a tick at least: the goals count after step 3. Flags are synchronised with values that are free.
        Raises `SpentError`.
        """
        state = task.state
        if free:
            state = synchronise(self._automaton, {**state, **{name: self._default(name) for name in free}})
        question = _Question(self._automaton, self._supervisor, self._orders, self._sight, task, state, free, budget)
        return question.through_few() or question.through_all()

    def _default(self, name: str) -> Value:
        return self._automaton.variables[name].type.domain[0]


@dataclass(frozen=True)
class _Question:
    automaton: Automaton
    supervisor: Supervisor
    orders: Orders
    sight: Sight
    task: Task
    state: State
    free: frozenset[str]
    budget: Budget

    def through_few(self) -> Decision | None:
        """The answer, as far as it can be had without regard to unknown values and the course of a run."""
        if not localisable(self.automaton, self.state, self.task.goals):
            return None
        asked = [goal.predicate for goal in self.task.goals]
        kept = self.sight.first([*asked, *self.task.circumstances.avoid])
        for _ in range(_MOST_ROUNDS):
            decision, more = self._seen_through(kept)
            if decision is not None or not more:
                return decision
            kept = self.sight.further(kept, more)
        return None

    def through_all(self) -> Decision:
        """The answer."""
        order = self.orders.whole(self.task, self.budget)
        relation = Relation(self.automaton, self.supervisor, order, self.task, self.state, self.budget)
        outcome = self._decided(relation)
        if isinstance(outcome, Decision):
            return outcome
        first, begin = outcome
        return Decision(begin, ticks_of(first))

    def _seen_through(self, kept: frozenset[str]) -> tuple[Decision | None, frozenset[str]]:
        """The answer, or further variables that matter; neither when nothing tells which."""
        seen = localised(self.automaton, self.supervisor, kept)
        state = seen.state(self.state)
        order = self.orders.part(seen, self.task, self.budget)
        relation = Relation(
            seen.automaton, seen.supervisor, order, self.task, state, self.budget, frozenset(seen.oracles)
        )
        hidden = frozenset[str]().union(*seen.oracles.values()) - kept
        try:
            outcome = self._decided(relation, DEEP if hidden else inf)
        except DepthError:
            return None, hidden
        if isinstance(outcome, Decision):
            return outcome, frozenset()
        first, begin = outcome
        rehearsal = Rehearsal(self.automaton, self.supervisor, self.task, kept, seen.oracles)
        missing = rehearsal.missing(begin, first.run, relation)
        if missing is None:
            return Decision(begin, ticks_of(first)), frozenset()
        needed = frozenset[str]().union(*(seen.oracles[name] for step in first.run for name in step.oracles))
        return None, (needed - kept) or missing or hidden

    def _decided(self, relation: Relation, depth: float = inf) -> Decision | tuple[Step, State]:
        """A proof, or the first step of a way and the state that it begins in."""
        beginning = relation.beginning(self.state, self.task.goals, self._freed())
        pairs = excluded_pairs(relation, beginning, self.budget)
        if pairs is not None:
            return self._proven(relation, pairs)
        frames = Frames(relation, beginning, self.budget, depth)
        outcome = frames.decide()
        if isinstance(outcome, tuple):
            return self._proven(relation, outcome)
        model = frames.member(outcome.cube) if self.free else None
        return outcome, self.state if model is None else self._begin(relation, model)

    def _proven(self, relation: Relation, excluded: tuple[Cube, ...]) -> Decision:
        return Decision(self.state, (), Proof(NAME, tuple(map(relation.excluding, excluded))))

    def _begin(self, relation: Relation, model: list[int]) -> State:
        """The state of a model, as far as it is free."""
        values = {name: value for name, value in relation.values(model).items() if name in self.free}
        return synchronise(self.automaton, {**self.state, **values})

    def _freed(self) -> frozenset[str]:
        """What can have any value: flags that are not functions of the variables follow what is free."""
        following = Following(self.automaton).flags(self.free)
        return self.free | {flag.name for flag in following}


def ticks_of(first: Step) -> tuple[PlanTick, ...]:
    """The ticks of a way. What is started in the last one is not needed."""
    run = first.run
    last = PlanTick(run[-1].effects, ())
    return (*(PlanTick(step.effects, step.starts) for step in run[:-1]), last)
