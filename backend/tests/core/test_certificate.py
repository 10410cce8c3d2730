"""A proof is accepted if it is one, and not if it claims too much or too little."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given

from sequence_planner.planning.heuristic import relaxation
from sequence_planner.planning.heuristic.relaxation import reachable, unreached
from sequence_planner.planning.pdr.ic3 import Reachability
from sequence_planner.planning.pdr.invariants import check
from sequence_planner.planning.pdr.proof_clauses import asserted, is_met
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import CertificateError, Clause, Literal, Proof
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget
from support.examples import examples

from .choices import Choices, made_by
from .exhaustive import alike, can_reach
from .random_problems import Problem, problem


def accepted(given_: Problem, task: PlanningTask, proof: Proof) -> bool:
    """Whether the proof is accepted."""
    model = (given_.automaton, given_.supervisor)
    try:
        check(*model, task, proof, Budget.seconds(60))
    except CertificateError:
        return False
    check(*model, task, proof, Budget.seconds(60), whole=True)
    return True


def possible(given_: Problem, task: PlanningTask) -> bool:
    """Whether the goals can be reached."""
    return can_reach(given_.automaton, given_.supervisor, [task.state], task.goals, task.circumstances)


def some_problem(choices: Choices) -> Problem:
    """Any kind of problem."""
    return problem(choices, unknown=choices.chance(3), demanding=choices.chance(2))


@examples(80)
@given(made_by(some_problem))
def test_what_the_relaxation_excludes_is_a_proof(given_: Problem) -> None:
    excluded: list[set[str]] = []
    for supervisor in (None, given_.supervisor):
        relaxed = reachable(given_.automaton, given_.state, given_.circumstances, supervisor)
        goals = missing(given_.goals, given_.state)
        impossible = tuple(goal for goal in goals if not relaxed.may(goal.predicate))
        excluded.append({goal.name for goal in impossible})
        if impossible:
            task = PlanningTask(given_.state, impossible, given_.circumstances)
            assert accepted(given_, task, unreached(given_.automaton, relaxed))
    assert excluded[0] <= excluded[1]


@examples(20)
@given(made_by(some_problem))
def test_where_a_supervisor_is_too_large_to_be_looked_at_nothing_is_excluded_for_its_sake(given_: Problem) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(relaxation, "_MOST_NODES", -1)
        relaxed = reachable(given_.automaton, given_.state, given_.circumstances, given_.supervisor)
    assert relaxed.possible == reachable(given_.automaton, given_.state, given_.circumstances).possible


def with_claim(choices: Choices) -> tuple[Problem, Clause]:
    """A problem, and something to be claimed of all its states."""
    made = some_problem(choices)
    types = made.automaton.types
    literals = [
        Literal(name, choices.pick(types[name].domain), choices.chance(2))
        for name in choices.different(list(types), 1, 3)
    ]
    return made, tuple(literals)


@examples(70)
@given(made_by(with_claim))
def test_no_proof_of_what_is_wrong_is_accepted(case: tuple[Problem, Clause]) -> None:
    """Whatever is claimed, alone or besides a proof: if it is accepted, the goals cannot be reached."""
    made, claim = case
    task = PlanningTask(made.state, missing(made.goals, made.state), made.circumstances)
    if not task.goals:
        return
    if accepted(made, task, Proof("guess", (claim,))) or accepted(made, task, Proof("guess", ())):
        assert not possible(made, task)


@examples(60)
@given(made_by(with_claim))
def test_nor_one_that_is_wrong_of_some_states_in_question(case: tuple[Problem, Clause]) -> None:
    """Whatever is claimed of a state and all that are like it but for the variables of the claim."""
    made, claim = case
    free = frozenset(literal.name for literal in claim) & made.automaton.variables.keys()
    task = PlanningTask(made.state, made.goals, made.circumstances)
    states = list(alike(made.automaton, made.state, free))
    wrong = can_reach(made.automaton, made.supervisor, states, task.goals, task.circumstances)
    for proof in (Proof("guess", (claim,)), Proof("guess", ())):
        for whole in (False, True):
            try:
                check(made.automaton, made.supervisor, task, proof, Budget.seconds(60), whole=whole, free=free)
            except CertificateError:
                continue
            assert not wrong


@examples(80)
@given(made_by(with_claim))
def test_a_proof_that_is_tampered_with_is_not_accepted(case: tuple[Problem, Clause]) -> None:
    made, claim = case
    task = PlanningTask(made.state, missing(made.goals, made.state), made.circumstances)
    proof = Reachability(made.automaton, made.supervisor).decide(task, Budget.seconds(60)).proof if task.goals else None
    if proof is None:
        return
    assert accepted(made, task, proof)
    values = asserted(task.state, task.goals)
    if false := tuple(literal for literal in claim if not is_met(literal, values)):
        assert not accepted(made, task, replace(proof, invariant=(*proof.invariant, false)))
    assert not accepted(made, task, replace(proof, invariant=((Literal("nobody", True),),)))
