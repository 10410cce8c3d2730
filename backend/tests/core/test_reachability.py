"""Property-directed reachability proves that there is no plan exactly where an exhaustive search finds none."""

from __future__ import annotations

from hypothesis import given

from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.pdr.engine import Reachability
from sequence_planner.planning.plan import Circumstances, Contract, goals_of
from sequence_planner.planning.replaying.replay import Replay, missing

from .budget import examples
from .choices import Choices, made_by
from .exhaustive import alike, can_reach
from .random_problems import Problem, problem


def decides(given_: Problem) -> None:
    """The engine finds a plan that replays where there is one, and a proof where there is none."""
    goals = missing(given_.goals, given_.state)
    if not goals:
        return
    task = Task(given_.state, goals, given_.circumstances, Contract.FAST)
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
    task = Task(made.state, made.goals, made.circumstances)
    decision = Reachability(made.automaton, made.supervisor).decide(task, Budget.seconds(60), free)
    states = list(alike(made.automaton, made.state, free))
    possible = can_reach(made.automaton, made.supervisor, states, made.goals, made.circumstances)
    assert (decision.proof is None) == possible
    if possible:
        assert decision.state in states
        assert can_reach(made.automaton, made.supervisor, [decision.state], made.goals, made.circumstances)


@examples(1)
@given(made_by(problem))
def test_nothing_is_said_when_there_is_no_time(given_: Problem) -> None:
    goals = goals_of(given_.automaton, given_.automaton.operations)
    task = Task(given_.state, goals, Circumstances(), Contract.FAST)
    finding = Reachability(given_.automaton, given_.supervisor).solve(task, Budget.seconds(0))
    assert not finding.decided
