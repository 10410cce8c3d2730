"""Answers that the planner has given, as far as they answer further questions.

The rest of a plan is a plan from the state at the end of each of its ticks: it was replayed when the whole was. If the
whole has the fewest ticks, and of these the fewest starts, so has the rest, or a better one would make the whole better
(Bellman 1957). A proof that there is no plan holds in every state that its invariant includes.
"""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Sequence

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.pdr.proof_clauses import asserted, satisfies
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Circumstances, Plan, Proof
from sequence_planner.planning.validation.replay import missing

NAME = "recollection"  # as an engine

_MOST_STATES = 1000
_MOST_PROOFS = 10

_Key = tuple[tuple[Value | None, ...], Goals, Circumstances]


class _Proven(Immutable):
    """A proof, and of whom it holds: `goals` whatever the states of their formulas' automata."""

    goals: Goals
    circumstances: Circumstances
    unknown: frozenset[str]
    proof: Proof


class PlanCache:
    """Accepted plans and proofs for one automaton under one supervisor."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._names = tuple(automaton.types)
        self._plans: OrderedDict[_Key, Plan] = OrderedDict()
        self._proofs: deque[_Proven] = deque(maxlen=_MOST_PROOFS)

    def finding(self, task: PlanningTask) -> Finding | None:
        """Return what is known of `task`; None if that is nothing."""
        plan = self.plan(task)
        if plan is not None:
            return Finding(plan, searched=len(plan.ticks) if plan.minimal_ticks else 0)
        proof = self._proof(task)
        return None if proof is None else Finding(proof=proof)

    def plan(self, task: PlanningTask) -> Plan | None:
        """An accepted plan for `task`, one with proofs if possible."""
        plan = self._plans.get(self._key(task.state, task.goals, task.circumstances))
        return None if plan is None or len(plan.ticks) > task.longest else plan

    def keep_plan(self, task: PlanningTask, plan: Plan, ends: Sequence[tuple[State, Goals]]) -> None:
        """Note an accepted plan; `ends` are the states at the ends of its ticks, each with the goals missing there."""
        moments = ((task.state, task.goals), *ends)
        for number, (state, goals) in enumerate(moments[: len(plan.ticks)]):
            # A goal that a start has brought about is asked for no more, and the rest without it may be shorter.
            if missing(goals, state) == goals:
                self._keep(self._key(state, goals, task.circumstances), replace(plan, ticks=plan.ticks[number:]))

    def keep_proof(self, task: PlanningTask, proof: Proof) -> None:
        """Note a proof that there is no plan for `task`."""
        if self._proof(task) is None and self._synchronised(task.state):
            self._proofs.append(
                _Proven(_without_progress(task.goals), task.circumstances, self._unknown(task.state), proof)
            )

    def _keep(self, key: _Key, plan: Plan) -> None:
        known = self._plans.get(key)
        if known is None or _rank(plan) <= _rank(known):
            self._plans[key] = plan
        self._plans.move_to_end(key)
        if len(self._plans) > _MOST_STATES:
            self._plans.popitem(last=False)

    def _proof(self, task: PlanningTask) -> Proof | None:
        """A proof is checked for states with as many unknown values, whose flags are as synchronisation leaves them."""
        asked = (_without_progress(task.goals), task.circumstances)
        candidates = [each for each in self._proofs if (each.goals, each.circumstances) == asked]
        if not candidates or not self._synchronised(task.state):
            return None
        unknown, values = self._unknown(task.state), asserted(task.state, task.goals)
        for each in candidates:
            if each.unknown == unknown and satisfies(values, each.proof):
                return each.proof
        return None

    def _key(self, state: State, goals: Goals, circumstances: Circumstances) -> _Key:
        return tuple(map(state.__getitem__, self._names)), goals, circumstances

    def _synchronised(self, state: State) -> bool:
        return synchronise(self._automaton, state) == dict(state)

    def _unknown(self, state: State) -> frozenset[str]:
        return frozenset(name for name in self._names if state[name] is None)


def _without_progress(goals: Goals) -> Goals:
    return tuple(replace(goal, at=0) for goal in goals)


def _rank(plan: Plan) -> tuple[bool, bool, int, int]:
    return not plan.minimal_ticks, not plan.minimal_starts, len(plan.ticks), len(plan.starts)
