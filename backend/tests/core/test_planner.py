"""The planner finds what a breadth-first search on the reference tick finds, and nothing else."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given

from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.heuristic import relaxation
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Goal, PlanRequest, Verdict
from sequence_planner.planning.validation.replay import Replay
from support.examples import examples

from .breadth_first import Shortest, shortest
from .choices import Choices, made_by
from .random_problems import Problem, problem
from .random_stations import state_of

LONGEST = 7


def expected(given_: Problem, goals: Goals) -> tuple[Goals, Shortest | None]:
    """The goals that can be reached together within `LONGEST` ticks, lowest priority left out first, and how soon.

    One that is impossible even by itself is left out before all others.
    """
    goals = tuple(sorted(goals, key=lambda goal: (-goal.priority, goal.name)))
    while goals:
        for number in range(len(goals), 0, -1):
            found = soonest(given_, goals[:number], LONGEST)
            if found is not None:
                return goals[:number], found
        if soonest(given_, goals[:1], 1000) is not None:
            break
        goals = goals[1:]
    return (), None


def soonest(given_: Problem, goals: Goals, longest: int) -> Shortest | None:
    """How soon `goals` can be reached together."""
    return shortest(given_.automaton, given_.supervisor, given_.state, goals, longest, given_.circumstances)


def reachable(given_: Problem, goal: Goal) -> bool:
    """Whether the goal can be reached at all."""
    station, supervisor, state = given_.automaton, given_.supervisor, given_.state
    return shortest(station, supervisor, state, (goal,), 1000, given_.circumstances) is not None


def check(given_: Problem, planner: Planner | None = None) -> None:
    """The answer of `planner`, or of a new one, for all operations is the expected one.

    Goals that are impossible by themselves are left out first, if that is proven: some of them always are.
    """
    station, supervisor, state = given_.automaton, given_.supervisor, given_.state
    planner = planner or Planner(station, supervisor)
    relaxed = relaxation.reachable(station, state, given_.circumstances)
    possible = tuple(goal for goal in given_.goals if relaxed.may(goal.predicate))
    some = expected(given_, possible)
    all_ = expected(given_, tuple(goal for goal in possible if reachable(given_, goal)))
    request = PlanRequest(state, given_.goals, deadline=60, longest=LONGEST, circumstances=given_.circumstances)
    answer = planner.answer(request)
    goals, best = all_ if answer.goals == tuple(goal.name for goal in all_[0]) else some
    assert answer.goals == tuple(goal.name for goal in goals)
    assert set(answer.left_out) == station.operations.keys() - set(answer.goals)
    if best is None:
        assert answer.plan is None
        assert answer.verdict in (Verdict.NONE_AT_ALL, Verdict.NONE_UP_TO)
        assert answer.verdict is Verdict.NONE_UP_TO or not any(reachable(given_, goal) for goal in given_.goals)
        return
    assert answer.verdict is Verdict.FOUND
    assert answer.plan is not None
    assert (answer.plan.minimal_ticks, answer.plan.minimal_starts) == (True, True)
    assert Shortest(len(answer.plan.ticks), len(answer.plan.starts)) == best
    # It replays: each start as it is written is allowed by its guards and leads from a safe state into a safe state.
    replay = Replay(station, supervisor, given_.circumstances)
    assert replay.exactly(state, state, goals, (), answer.plan.ticks)


@examples(60)
@given(made_by(problem))
def test_plans_are_as_short_as_breadth_first_search_finds_them(given_: Problem) -> None:
    check(given_)


@examples(60)
@given(made_by(lambda choices: problem(choices, unknown=True)))
def test_plans_from_states_with_unknown_values_are_too(given_: Problem) -> None:
    check(given_)


def several_questions(choices: Choices) -> list[Problem]:
    """A problem, and the same from further states."""
    first = problem(choices)
    states = [state_of(choices, first.automaton, unknown=choices.chance(4)) for _ in range(4)]
    return [first, *(replace(first, state=state) for state in states)]


@examples(15)
@given(made_by(several_questions))
def test_one_planner_answers_question_after_question_as_a_new_one_would(questions: list[Problem]) -> None:
    """The solver is kept warm: nothing of one question leaks into the next."""
    planner = Planner(questions[0].automaton, questions[0].supervisor)
    for each in questions:
        check(each, planner)


@examples(50)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(4), demanding=True)))
def test_plans_keep_to_formulas_and_circumstances(given_: Problem) -> None:
    check(given_)


@examples(150)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(2), demanding=choices.chance(2))))
def test_no_goal_that_can_be_reached_is_called_unreachable(given_: Problem) -> None:
    relaxed = relaxation.reachable(given_.automaton, given_.state, given_.circumstances, given_.supervisor)
    for goal in given_.goals:
        if relaxed.may(goal.predicate):
            continue
        alone = shortest(given_.automaton, given_.supervisor, given_.state, (goal,), 1000, given_.circumstances)
        assert alone is None
