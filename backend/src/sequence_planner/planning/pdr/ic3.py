"""Property-directed reachability (IC3): proof of unsolvability or a plan, with abstraction refinement."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Iterable
from itertools import count
from math import inf

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import synchronise
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.pdr.abstraction import (
    ConcretePlan,
    Localised,
    Orders,
    VariableSelection,
    localisable,
    localised,
)
from sequence_planner.planning.pdr.invariants import check, excluded_pairs
from sequence_planner.planning.pdr.proof_clauses import asserted, one_of, open_to, satisfies
from sequence_planner.planning.pdr.transition_relation import ChoiceStep, Cube, Relation, TickQueries
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Circumstances, Contract, Plan, PlanTick, Proof
from sequence_planner.planning.sat.start_order import Order
from sequence_planner.process.budget import Budget, SpentError

# The search for an invariant, in the form of Een, Mishchenko and Brayton (2011) of IC3 (Bradley 2011).
#
# Frame k is a set of states that holds all that k ticks can reach. A state in the last frame from which one tick
# reaches the goals is traced back; where nothing leads to it from the frame before, it is excluded, together with as
# many states like it as that argument covers. When a frame excludes no more than the next one, it is an invariant.

# Values of one variable that are tried in vain before the others are left as they are.
_PATIENCE = 3

# Cubes that may be excluded so that a literal can be left out of another one.
_HINDRANCES = 1


class DepthError(Exception):
    """More frames would have to be looked at."""


class Frames:
    """Decides whether the goals of `relation` can be reached from the states of `beginning`.

    It looks at no more than `depth` frames.
    """

    def __init__(self, relation: Relation, beginning: Cube, budget: Budget, depth: float = inf) -> None:
        self._relation = relation
        self._budget = budget
        self._depth = depth
        self._beginning = beginning
        self._outside = frozenset(-literal for literal in beginning)
        self._frames: list[set[Cube]] = []  # the cubes that each frame, and all before it, exclude
        self._levels: list[int] = []
        self._seen: Counter[str] = Counter()
        self._witnesses: dict[Cube, Cube] = {}  # for cubes, states from which a tick led there when last asked
        self._turn = count()
        self._renew()

    def decide(self) -> ChoiceStep | tuple[Cube, ...]:
        """A way to the goals, or the cubes that an invariant excludes. Raises `SpentError` and `DepthError`."""
        self._extend()
        if (step := self._last_step()) is not None:
            return step
        while True:
            if len(self._frames) > self._depth:
                raise DepthError
            self._extend()
            while (step := self._last_step()) is not None:
                if (first := self._traced_back(step)) is not None:
                    return first
            if (invariant := self._pushed()) is not None:
                return invariant

    def member(self, cube: Cube) -> list[int] | None:
        """A model with a state of `cube` to begin in."""
        return self._inquiry.model() if self._inquiry.solves([*self._beginning, *cube]) else None

    def _extend(self) -> None:
        self._frames.append(set())
        self._levels.append(self._inquiry.fresh())

    def _last_step(self) -> ChoiceStep | None:
        """A step from the last frame to the goals."""
        relation = self._relation
        if not self._inquiry.solves([relation.valid, relation.reached, *self._inside(len(self._frames) - 1)]):
            return None
        return self._lifted([relation.reached], None)

    def _traced_back(self, last: ChoiceStep) -> ChoiceStep | None:
        """Excludes the cube of `last` from the last frame; if that cannot be done, the first step of a way."""
        if self._begins(last.cube):
            return last
        top = len(self._frames) - 1
        pending = [(top, next(self._turn), last)]
        while pending:
            level, _, step = pending[0]
            if self._excluded(step.cube, level):
                heapq.heappop(pending)
                continue
            smaller = self._unreached(step.cube, level)
            if smaller is None:
                before = self._lifted([self._relation.after(literal) for literal in step.cube], step)
                if level == 1 or self._begins(before.cube):
                    return before
                heapq.heappush(pending, (level - 1, next(self._turn), before))
                continue
            heapq.heappop(pending)
            level = self._exclude(self._generalised(smaller, level), level)
            if level < top:
                heapq.heappush(pending, (level + 1, next(self._turn), step))
        return None

    def _exclude(self, cube: Cube, level: int) -> int:
        """Exclude `cube` from the latest frame possible, and all before it."""
        while level < len(self._frames) - 1 and self._unreached(cube, level + 1) is not None:
            level += 1
        literals = set(cube)
        for frame in self._frames[1 : level + 1]:
            frame.difference_update([other for other in frame if literals.issubset(other)])
        self._frames[level].add(cube)
        self._inquiry.demand([-self._levels[level], *(-literal for literal in cube)])
        self._seen.update({self._relation.meanings[abs(literal)].name for literal in cube})
        return level

    def _unreached(self, cube: Cube, level: int) -> Cube | None:
        """A part of `cube` none of whose states is reached from another state in the frame before, if there is one.

        With None, the solver has a model of a tick into `cube`.
        """
        relation = self._relation
        passing = self._passing([-literal for literal in cube])
        into = {literal: relation.after(literal) for literal in cube}
        assumptions = [relation.valid, passing, *self._inside(level - 1), *into.values()]
        if self._inquiry.solves(assumptions):
            return None
        core = self._inquiry.core()
        found: dict[int, int] = {}
        for literal, after in into.items():
            if after in core:
                found.setdefault(after, literal)
        smaller = tuple(found.values())
        if not self._begins(smaller):
            return smaller
        apart = next((literal for literal in cube if literal in self._outside), None)
        return cube if apart is None else (*smaller, apart)

    def _generalised(self, cube: Cube, level: int, hindrances: int = _HINDRANCES) -> Cube:
        """A part of `cube` from which nothing more can be left out; what others speak of is kept for longer."""
        subjects = {literal: self._relation.meanings[abs(literal)].name for literal in cube}
        several = Counter(subjects.values())
        for subject in sorted(several, key=lambda subject: self._seen[subject]):
            whole = {literal for literal in cube if subjects[literal] == subject}
            shorter = self._without(cube, whole, level, hindrances)
            if shorter is cube and several[subject] > 1:
                failures = 0
                for literal in sorted(whole, reverse=True):
                    before = len(cube)
                    cube = self._without(cube, {literal}, level, hindrances)
                    failures = failures + 1 if len(cube) == before else 0
                    if failures == _PATIENCE:
                        break
            cube = shorter if len(shorter) < len(cube) else cube
        return cube

    def _without(self, cube: Cube, literals: set[int], level: int, hindrances: int) -> Cube:
        """A part of `cube` without `literals`, or all of it.

        Up to so many `hindrances`, cubes from which the part is reached, are excluded first if nothing leads to them
        (Hassan, Bradley and Somenzi 2013).
        """
        shorter = tuple(other for other in cube if other not in literals)
        if len(shorter) == len(cube) or not shorter or self._begins(shorter):
            return cube
        while (smaller := self._unreached(shorter, level)) is None:
            if level == 1 or hindrances == 0:
                return cube
            hindrances -= 1
            hindrance = self._lifted([self._relation.after(literal) for literal in shorter], None).cube
            unreached = None if self._begins(hindrance) else self._unreached(hindrance, level - 1)
            if unreached is None:
                return cube
            self._exclude(self._generalised(unreached, level - 1, hindrances=0), level - 1)
        return smaller

    def _pushed(self) -> tuple[Cube, ...] | None:
        """Exclude from each frame what the one before it cannot reach; the invariant, if two have become equal."""
        relation = self._relation
        for level in range(1, len(self._frames) - 1):
            for cube in sorted(self._frames[level]):
                witness = self._witnesses.get(cube)
                if witness is not None and not self._excluded(witness, level):
                    continue
                after = [relation.after(literal) for literal in cube]
                if self._inquiry.solves([relation.valid, *self._inside(level), *after]):
                    self._witnesses[cube] = self._state()
                else:
                    self._frames[level].discard(cube)
                    self._frames[level + 1].add(cube)
                    self._inquiry.demand([-self._levels[level + 1], *(-literal for literal in cube)])
            if not self._frames[level]:
                return tuple(sorted(set().union(*self._frames[level + 1 :])))
        return None

    def _lifted(self, targets: list[int], following: ChoiceStep | None) -> ChoiceStep:
        """The step of the solver's model, from all states whose likeness to its first state is what it takes."""
        relation = self._relation
        model = self._inquiry.model()
        state = relation.state(model)
        oracles = {bit if model[bit - 1] > 0 else -bit: name for name, bit in relation.oracles}
        effects = [name for name, choice in relation.effects.items() if model[choice - 1] > 0]
        starts = [name for name, choice in relation.starts if model[choice - 1] > 0]
        choices = [choice if model[choice - 1] > 0 else -choice for choice in relation.choices]
        passing = self._passing([-relation.valid, *(-target for target in targets)])
        assert not self._inquiry.solves([passing, *choices, *state])
        core = self._inquiry.core()
        cube = tuple(literal for literal in state if literal in core)
        needed = frozenset(name for literal, name in oracles.items() if literal in core)
        return ChoiceStep(cube, tuple(effects), tuple(starts), needed, following)

    def _begins(self, cube: Cube) -> bool:
        """Return whether a run can begin in `cube`, which is not empty."""
        if not self._outside.isdisjoint(cube):
            return False
        return not self._relation.free_flags or self._inquiry.solves([*self._beginning, *cube])

    def _state(self) -> Cube:
        """The state before the tick in the solver's model."""
        return tuple(self._relation.state(self._inquiry.model()))

    def _excluded(self, cube: Cube, level: int) -> bool:
        literals = set(cube)
        return any(literals.issuperset(other) for frame in self._frames[level:] for other in frame)

    def _inside(self, level: int) -> Iterable[int]:
        return self._levels[level:] if level else self._beginning

    def _passing(self, clause: list[int]) -> int:
        if self._inquiry.worn:
            self._renew()
        return self._inquiry.passing(clause)

    def _renew(self) -> None:
        self._inquiry = TickQueries(self._relation, self._budget)
        self._levels = [self._inquiry.fresh() for _ in self._frames]
        for level, frame in zip(self._levels, self._frames, strict=True):
            for cube in frame:
                self._inquiry.demand([-level, *(-literal for literal in cube)])


# One question to property-directed reachability: seen through more and more, until there is an answer.

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


class ReachabilityQuestion(Immutable):
    """The question whether the goals of `task` can be reached from `state`, or one like it with any values of
    `free`.
    """

    automaton: Automaton
    supervisor: Supervisor
    orders: Orders
    sight: VariableSelection
    task: PlanningTask
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
        rehearsal = ConcretePlan(self.automaton, self.supervisor, self.task, kept, seen.oracles)
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
        """Return what is seen through the variables `kept`, and its tick."""
        seen = localised(self.automaton, self.supervisor, kept)
        state = seen.state(self.state)
        order = self.orders.part(seen, self.task, self.budget)
        inputs = frozenset(seen.oracles)
        return seen, Relation(seen.automaton, seen.supervisor, order, self.task, state, self.budget, inputs)

    def _decided(self, relation: Relation, depth: float = inf) -> Decision | tuple[ChoiceStep, State]:
        """A proof, or the first step of a way and the state that it begins in."""
        beginning = self._beginning(relation)
        excluded = excluded_pairs(relation, beginning, self.budget)
        if excluded is None:
            frames = Frames(relation, beginning, self.budget, depth)
            outcome = frames.decide()
            if isinstance(outcome, ChoiceStep):
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


def _ticks(first: ChoiceStep) -> tuple[PlanTick, ...]:
    """The ticks of a way. What is started in the last one is not needed."""
    run = first.run
    last = PlanTick(run[-1].effects, ())
    return (*(PlanTick(step.effects, step.starts) for step in run[:-1]), last)


# Proofs that there is no plan at all, or plans that are not the shortest.
#
# First the automaton is seen through few variables. A way to the goals found there is tried on the reference tick; if
# it fails, variables that it needed and that are not seen come into sight (Clarke et al. 2000). A proof found through
# few variables is one for the whole automaton. Invariants of pairs come first, as they take few questions.

# Proofs that are kept.
_MOST_KEPT = 16

# What proofs are kept by: goals, circumstances, what has no value, and whether flags are as they should be.
_Kind = tuple[Goals, Circumstances, frozenset[str], bool]


class Reachability:
    """Decides for one automaton under one supervisor whether goals can be reached at all."""

    name = NAME

    def __init__(self, automaton: Automaton, supervisor: Supervisor, order: Order | None = None) -> None:
        """Starts are taken in `order`, if every order that can make a difference is a part of it."""
        self._automaton = automaton
        self._supervisor = supervisor
        self._orders = Orders(automaton, supervisor, order)
        self._sight = VariableSelection(automaton, supervisor)
        self._proofs: dict[_Kind, Proof] = {}

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A proof, which has been checked, or, where the contract allows it, a plan; or nothing.

        A proof from another state is looked at first: what no tick leads out of may hold the new state too.
        """
        kind = self._kind(task)
        proof = self._proofs.get(kind)
        if proof is not None and satisfies(asserted(task.state, task.goals), proof):
            return Finding(proof=proof)
        try:
            decision = self.decide(task, budget)
            if decision.proof is None:
                plan = Plan(decision.ticks, minimal_ticks=False, minimal_starts=False)
                return Finding(plan) if task.contract is Contract.FAST else Finding()
            check(self._automaton, self._supervisor, task, decision.proof, budget, self._orders)
        except SpentError:
            return Finding()
        if len(self._proofs) == _MOST_KEPT:
            self._proofs.clear()
        self._proofs[kind] = decision.proof
        return Finding(proof=decision.proof)

    def at_first_sight(self, task: PlanningTask, budget: Budget) -> Finding:
        """A proof, which has been checked, if a first look at pairs brings one. Raises `SpentError`."""
        if not localisable(self._automaton, task.state, task.goals):
            return Finding()
        proof = self._question(task, budget).by_pairs()
        return Finding() if proof is None else Finding(proof=self.checked(task, budget, frozenset(), proof))

    def checked(self, task: PlanningTask, budget: Budget, free: frozenset[str], proof: Proof) -> Proof:
        """The proof, if it holds for `task` with any values of `free`. Raises `CertificateError` and `SpentError`."""
        check(self._automaton, self._supervisor, task, proof, budget, self._orders, free=free)
        return proof

    def decide(self, task: PlanningTask, budget: Budget, free: frozenset[str] = frozenset()) -> Decision:
        """Decide whether the goals can be reached from a state like that of `task`, with any values of the variables
        `free`.

        A plan has a tick at least: the goals count after step 3. Flags are synchronised with values that are free.
        Raises `SpentError`.
        """
        question = self._question(task, budget, free)
        return question.through_few() or question.through_all()

    def _question(self, task: PlanningTask, budget: Budget, free: frozenset[str] = frozenset()) -> ReachabilityQuestion:
        state = one_of(self._automaton, task.state, free)
        return ReachabilityQuestion(
            self._automaton, self._supervisor, self._orders, self._sight, task, state, free, budget
        )

    def _kind(self, task: PlanningTask) -> _Kind:
        unknown = frozenset(name for name, value in task.state.items() if value is None)
        followed = synchronise(self._automaton, task.state) == dict(task.state)
        return task.goals, task.circumstances, unknown, followed
