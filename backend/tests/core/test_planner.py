"""The planner finds what a breadth-first search on the reference tick finds, and nothing else."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given

from sequence_planner.planning.plan import PlanRequest, Verdict
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.relaxation import unreachable_goals
from sequence_planner.planning.replay import Replay

from .breadth_first import Shortest, shortest
from .budget import examples
from .choices import Choices, made_by
from .random_problems import Problem, problem
from .random_stations import state_of

LONGEST = 7


def expected(given_: Problem, goals: list[str]) -> tuple[list[str], Shortest | None]:
    """The goals that can be reached together within `LONGEST` ticks, lowest priority left out first, and how soon."""
    goals = sorted(goals, key=lambda goal: (-given_.automaton.operations[goal].priority, goal))
    while goals:
        found = shortest(given_.automaton, given_.supervisor, given_.state, frozenset(goals), LONGEST)
        if found is not None:
            return goals, found
        goals = goals[:-1]
    return [], None


def check(given_: Problem, planner: Planner | None = None) -> None:
    """The answer of `planner`, or of a new one, for all operations is the expected one."""
    station, supervisor, state = given_.automaton, given_.supervisor, given_.state
    planner = planner or Planner(station, supervisor)
    wanted = tuple(station.operations)
    impossible = unreachable_goals(station, state, wanted)
    goals, best = expected(given_, [goal for goal in wanted if goal not in impossible])
    answer = planner.answer(PlanRequest(state, wanted, deadline=60, longest=LONGEST))
    assert list(answer.goals) == goals
    assert set(answer.left_out) == set(wanted) - set(goals)
    if best is None:
        assert answer.plan is None
        assert answer.verdict is (Verdict.NONE_AT_ALL if len(impossible) == len(wanted) else Verdict.NONE_UP_TO)
        return
    assert answer.verdict is Verdict.FOUND
    assert answer.plan is not None
    assert (answer.plan.minimal_ticks, answer.plan.minimal_starts) == (True, True)
    assert Shortest(len(answer.plan.ticks), len(answer.plan.starts)) == best
    # It replays: each start as it is written is allowed by its guards and leads from a safe state into a safe state.
    assert Replay(station, supervisor).exactly(state, state, goals, (), answer.plan.ticks)


@examples(200)
@given(made_by(problem))
def test_plans_are_as_short_as_breadth_first_search_finds_them(given_: Problem) -> None:
    check(given_)


@examples(200)
@given(made_by(lambda choices: problem(choices, unknown=True)))
def test_plans_from_states_with_unknown_values_are_too(given_: Problem) -> None:
    check(given_)


def several_questions(choices: Choices) -> list[Problem]:
    """A problem, and the same from further states."""
    first = problem(choices)
    states = [state_of(choices, first.automaton, unknown=choices.chance(4)) for _ in range(4)]
    return [first, *(replace(first, state=state) for state in states)]


@examples(60)
@given(made_by(several_questions))
def test_one_planner_answers_question_after_question_as_a_new_one_would(questions: list[Problem]) -> None:
    """The solver is kept warm: nothing of one question leaks into the next."""
    planner = Planner(questions[0].automaton, questions[0].supervisor)
    for each in questions:
        check(each, planner)


@examples(150)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(2))))
def test_no_goal_that_can_be_reached_is_called_unreachable(given_: Problem) -> None:
    for goal in unreachable_goals(given_.automaton, given_.state, given_.automaton.operations):
        assert shortest(given_.automaton, given_.supervisor, given_.state, frozenset({goal}), longest=1000) is None
