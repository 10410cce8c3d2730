"""Proofs that there is no plan at all, or plans that are not the shortest.

First the automaton is seen through few variables. A way to the goals found there is tried on the reference tick; if it
fails, variables that it needed and that are not seen come into sight (Clarke et al. 2000). A proof found through few
variables is one for the whole automaton. Invariants of pairs come first, as they take few questions.
"""

from __future__ import annotations

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.tick import synchronise
from sequence_planner.planning.budget import Budget, SpentError
from sequence_planner.planning.engine import Finding, Task
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.pdr.certificate import check
from sequence_planner.planning.pdr.invariants import asserted, one_of, satisfies
from sequence_planner.planning.pdr.localisation import localisable
from sequence_planner.planning.pdr.ordering import Orders
from sequence_planner.planning.pdr.question import NAME, Decision, Question
from sequence_planner.planning.pdr.sight import Sight
from sequence_planner.planning.plan import Circumstances, Contract, Plan, Proof
from sequence_planner.planning.sat.sweep import Order

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
        self._sight = Sight(automaton, supervisor)
        self._proofs: dict[_Kind, Proof] = {}

    def solve(self, task: Task, budget: Budget) -> Finding:
        """A proof, which has been checked, or, where the contract allows it, a plan; or nothing.

        A proof from another state is looked at first: what no tick leads out of may hold the new state too.
        """
        kind = self._kind(task)
        proof = self._proofs.get(kind)
        if proof is not None and satisfies(asserted(task.state, task.goals), proof.invariant):
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

    def at_first_sight(self, task: Task, budget: Budget) -> Finding:
        """A proof, which has been checked, if a first look at pairs brings one. Raises `SpentError`."""
        if not localisable(self._automaton, task.state, task.goals):
            return Finding()
        proof = self._question(task, budget).by_pairs()
        return Finding() if proof is None else Finding(proof=self.checked(task, budget, frozenset(), proof))

    def checked(self, task: Task, budget: Budget, free: frozenset[str], proof: Proof) -> Proof:
        """The proof, if it holds for `task` with any values of `free`. Raises `CertificateError` and `SpentError`."""
        check(self._automaton, self._supervisor, task, proof, budget, self._orders, free=free)
        return proof

    def decide(self, task: Task, budget: Budget, free: frozenset[str] = frozenset()) -> Decision:
        """Whether the goals can be reached from a state like that of `task`, with any values of the variables `free`.

        A plan has a tick at least: the goals count after step 3. Flags are synchronised with values that are free.
        Raises `SpentError`.
        """
        question = self._question(task, budget, free)
        return question.through_few() or question.through_all()

    def _question(self, task: Task, budget: Budget, free: frozenset[str] = frozenset()) -> Question:
        state = one_of(self._automaton, task.state, free)
        return Question(self._automaton, self._supervisor, self._orders, self._sight, task, state, free, budget)

    def _kind(self, task: Task) -> _Kind:
        unknown = frozenset(name for name, value in task.state.items() if value is None)
        followed = synchronise(self._automaton, task.state) == dict(task.state)
        return task.goals, task.circumstances, unknown, followed
