"""Property-directed reachability proves that there is no plan exactly where an exhaustive search finds none."""

from __future__ import annotations

from hypothesis import given

from sequence_planner.automaton.automaton import State
from sequence_planner.planning.pdr.ic3 import Reachability
from sequence_planner.planning.pdr.invariants import check
from sequence_planner.planning.pdr.quick_proof import QuickProof
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances, Contract, goals_of
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget
from support.examples import examples

from .choices import Choices, made_by
from .exhaustive import alike, can_reach
from .random_problems import Problem, problem
from .random_stations import state_of


def decides(given_: Problem) -> None:
    """The engine finds a plan that replays where there is one, and a proof where there is none."""
    goals = missing(given_.goals, given_.state)
    if not goals:
        return
    task = PlanningTask(given_.state, goals, given_.circumstances, Contract.FAST)
    finding = Reachability(given_.automaton, given_.supervisor).solve(task, Budget.seconds(60))
    possible = can_reach(given_.automaton, given_.supervisor, [given_.state], goals, given_.circumstances)
    assert (finding.plan is None, finding.proof is None) == (not possible, possible)
    if finding.plan is not None:
        replay = Replay(given_.automaton, given_.supervisor, given_.circumstances)
        assert replay.exactly(given_.state, given_.state, goals, (), finding.plan.ticks)


@examples(150)
@given(made_by(problem))
def test_there_is_a_proof_exactly_where_no_run_reaches_the_goals(given_: Problem) -> None:
    decides(given_)


@examples(100)
@given(made_by(lambda choices: problem(choices, unknown=True, demanding=True)))
def test_so_it_is_with_unknown_values_and_demands_on_the_way(given_: Problem) -> None:
    decides(given_)


def several_beginnings(choices: Choices) -> tuple[Problem, frozenset[str]]:
    """A problem, and variables that may have any values."""
    made = problem(choices, demanding=choices.chance(2))
    return made, frozenset(choices.different(list(made.automaton.variables), 1, 3))


@examples(100)
@given(made_by(several_beginnings))
def test_a_proof_can_be_about_many_states(case: tuple[Problem, frozenset[str]]) -> None:
    made, free = case
    task = PlanningTask(made.state, made.goals, made.circumstances)
    decision = Reachability(made.automaton, made.supervisor).decide(task, Budget.seconds(60), free)
    states = list(alike(made.automaton, made.state, free))
    possible = can_reach(made.automaton, made.supervisor, states, made.goals, made.circumstances)
    assert (decision.proof is None) == possible
    if decision.proof is not None:
        for whole in (False, True):
            check(made.automaton, made.supervisor, task, decision.proof, Budget.seconds(60), whole=whole, free=free)
    else:
        assert decision.state in states
        assert can_reach(made.automaton, made.supervisor, [decision.state], made.goals, made.circumstances)


def one_after_the_other(choices: Choices) -> tuple[Problem, list[State]]:
    """A problem, and the states to plan from one after the other."""
    made = problem(choices, unknown=choices.chance(3), demanding=choices.chance(2))
    unknown = choices.chance(3)
    return made, [made.state, *(state_of(choices, made.automaton, unknown) for _ in range(4)), made.state]


@examples(60)
@given(made_by(one_after_the_other))
def test_what_is_kept_from_other_questions_makes_no_difference(case: tuple[Problem, list[State]]) -> None:
    made, states = case
    engine = Reachability(made.automaton, made.supervisor)
    for state in states:
        task = PlanningTask(state, made.goals, made.circumstances, Contract.FAST)
        finding = engine.solve(task, Budget.seconds(60))
        possible = can_reach(made.automaton, made.supervisor, [state], made.goals, made.circumstances)
        assert (finding.plan is None, finding.proof is None) == (not possible, possible)
        if finding.proof is not None:
            check(made.automaton, made.supervisor, task, finding.proof, Budget.seconds(60))


@examples(80)
@given(made_by(one_after_the_other))
def test_at_first_sight_there_are_proofs_only_where_there_is_no_plan(case: tuple[Problem, list[State]]) -> None:
    made, states = case
    engine = QuickProof(made.automaton, made.supervisor)
    for state in states:
        task = PlanningTask(state, made.goals, made.circumstances, Contract.FAST)
        if (proof := engine.solve(task, Budget.seconds(60)).proof) is not None:
            check(made.automaton, made.supervisor, task, proof, Budget.seconds(60), whole=True)
            assert not can_reach(made.automaton, made.supervisor, [state], made.goals, made.circumstances)


@examples(1)
@given(made_by(problem))
def test_nothing_is_said_when_there_is_no_time(given_: Problem) -> None:
    goals = goals_of(given_.automaton, given_.automaton.operations)
    task = PlanningTask(given_.state, goals, Circumstances(), Contract.FAST)
    finding = Reachability(given_.automaton, given_.supervisor).solve(task, Budget.seconds(0))
    assert not finding.decided
