"""One question to property-directed reachability: seen through more and more, until there is an answer."""

from __future__ import annotations

from math import inf

from sequence_planner.automaton.cone import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.expressions.syntax import Expression
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.pdr.frames import DepthError, Frames
from sequence_planner.planning.pdr.invariants import open_to
from sequence_planner.planning.pdr.localisation import Localised, localisable, localised
from sequence_planner.planning.pdr.ordering import Orders
from sequence_planner.planning.pdr.pairs import excluded_pairs
from sequence_planner.planning.pdr.rehearsal import Rehearsal
from sequence_planner.planning.pdr.relation import Cube, Relation
from sequence_planner.planning.pdr.sight import Sight
from sequence_planner.planning.pdr.steps import Step
from sequence_planner.planning.plan import PlanTick, Proof

NAME = "pdr"

# Frames after which it is better to see more.
DEEP = 10

# Rounds of seeing more; then everything that could matter is seen.
_MOST_ROUNDS = 40


class Decision(Immutable):
    """A plan from `state`, or a proof that there is none from any of the states in question.

    Where values are unknown and others free, a plan that begins with flags as they never are is not `certain`.
    """

    state: State
    ticks: tuple[PlanTick, ...]
    proof: Proof | None = None
    certain: bool = True


class Question(Immutable):
    """Whether the goals of `task` can be reached from `state`, or one like it with any values of `free`."""

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
        kept = self._first_seen()
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
        return Decision(begin, _ticks(first), certain=relation.includes(first.cube, begin))

    def _seen_through(self, kept: frozenset[str]) -> tuple[Decision | None, frozenset[str]]:
        """The answer, or further variables that matter; neither when nothing tells which."""
        seen, relation = self._related(kept)
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
            return Decision(begin, _ticks(first)), frozenset()
        needed = frozenset[str]().union(*(seen.oracles[name] for step in first.run for name in step.oracles))
        return None, (needed - kept) or missing or hidden

    def by_pairs(self) -> Proof | None:
        """A proof by pairs of what is seen first, if there is one and more is seen than what the goals read."""
        kept = self._first_seen()
        if kept == read_variables(self.automaton, self._asked()):
            return None
        _, relation = self._related(kept)
        excluded = excluded_pairs(relation, self._beginning(relation), self.budget)
        return None if excluded is None else _proof(relation, excluded)

    def _first_seen(self) -> frozenset[str]:
        return self.sight.first(self._asked())

    def _asked(self) -> tuple[Expression, ...]:
        return (*(goal.predicate for goal in self.task.goals), *self.task.circumstances.avoid)

    def _related(self, kept: frozenset[str]) -> tuple[Localised, Relation]:
        """What is seen through the variables `kept`, and its tick."""
        seen = localised(self.automaton, self.supervisor, kept)
        state = seen.state(self.state)
        order = self.orders.part(seen, self.task, self.budget)
        inputs = frozenset(seen.oracles)
        return seen, Relation(seen.automaton, seen.supervisor, order, self.task, state, self.budget, inputs)

    def _decided(self, relation: Relation, depth: float = inf) -> Decision | tuple[Step, State]:
        """A proof, or the first step of a way and the state that it begins in."""
        beginning = self._beginning(relation)
        excluded = excluded_pairs(relation, beginning, self.budget)
        if excluded is None:
            frames = Frames(relation, beginning, self.budget, depth)
            outcome = frames.decide()
            if isinstance(outcome, Step):
                model = frames.member(outcome.cube) if self.free else None
                return outcome, self.state if model is None else self._begin(relation, model)
            excluded = outcome
        return Decision(self.state, (), _proof(relation, excluded))

    def _beginning(self, relation: Relation) -> Cube:
        return relation.beginning(self.state, self.task.goals, open_to(self.automaton, self.free))

    def _begin(self, relation: Relation, model: list[int]) -> State:
        """The state of a model, as far as it is free."""
        values = {name: value for name, value in relation.values(model).items() if name in self.free}
        return synchronise(self.automaton, {**self.state, **values})


def _proof(relation: Relation, excluded: tuple[Cube, ...]) -> Proof:
    return Proof(NAME, tuple(map(relation.excluding, excluded)))


def _ticks(first: Step) -> tuple[PlanTick, ...]:
    """The ticks of a way. What is started in the last one is not needed."""
    run = first.run
    last = PlanTick(run[-1].effects, ())
    return (*(PlanTick(step.effects, step.starts) for step in run[:-1]), last)
