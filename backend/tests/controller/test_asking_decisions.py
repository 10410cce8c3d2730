"""The laws of calls and goals, without a network: what is asked for each rise and fall of an output."""

from __future__ import annotations

from hypothesis import given

from core.choices import Choices, made_by
from sequence_planner.controller.io.clients import CallCourse, Do, GoalCourse
from sequence_planner.pipelines.graph import GoalState
from sequence_planner.ros.actions import GoalStatus
from support.examples import examples

Event = tuple[str, object]


def events(choices: Choices) -> list[Event]:
    """What can happen to an action, in any order that a server can bring about or not."""
    told = [GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED]
    made: list[Event] = [("output", choices.chance(2))]
    for _ in range(choices.number(0, 20)):
        match choices.number(0, 4):
            case 0 | 1:
                made.append(("output", choices.chance(2)))
            case 2:
                made.append(("heard", choices.pick(told)))
            case 3:
                made.append(("ended", choices.pick([GoalState.LOST, GoalState.REJECTED])))
            case 4:
                made.append(("others", [choices.pick(told)] if choices.chance(2) else []))
    return made


@examples(500)
@given(made_by(events))
def test_a_goal_is_sent_at_most_once_for_each_rise_and_never_beside_another(made: list[Event]) -> None:
    course = GoalCourse()
    output: bool | None = None
    rises = sent = 0
    at_work = False
    for kind, value in made:
        if kind in ("heard", "ended") and not at_work:
            continue  # nothing is heard of a goal that was not sent
        match kind, value:
            case "output", bool(now):
                rises += output is False and now
                was, output = output, now
                do = course.heed(now)
                assert (do is Do.CANCEL) == (bool(was) and not now and (at_work or course.others is not None))
            case "heard", GoalStatus() as status:
                at_work = not status.ended
                do = course.heard(status)
            case "ended", GoalState() as state:
                at_work = False
                do = course.ended(state)
            case _, list(statuses):
                do = course.heard_of_others(statuses)
        if do is Do.SEND:
            assert output and not at_work and course.others is None
            assert course.state is GoalState.IDLE  # what was said of the goal before is not taken for this one's
            sent, at_work = sent + 1, True
        assert sent <= rises
        if not output and not at_work and course.others is None:
            assert course.state in (GoalState.IDLE, GoalState.LOST)


def test_the_first_value_of_an_output_is_no_rise() -> None:
    assert GoalCourse().heed(True) is None
    assert not CallCourse(None).heed(True)


def test_a_goal_that_was_lost_while_it_was_cancelled_stays_lost_until_its_server_tells() -> None:
    course = GoalCourse()
    assert [course.heed(False), course.heed(True), course.heed(False)] == [None, Do.SEND, Do.CANCEL]
    states = [course.state]
    course.ended(GoalState.LOST)
    states.append(course.state)
    course.heard_of_others([])
    states.append(course.state)
    assert states == [GoalState.IDLE, GoalState.LOST, GoalState.IDLE]


def test_goals_of_others_whose_server_has_gone_are_lost() -> None:
    course = GoalCourse()
    course.heed(False)
    course.heard_of_others([GoalStatus.SUCCEEDED, GoalStatus.EXECUTING])
    states = [course.state]
    course.lose_others()
    states.append(course.state)
    assert states == [GoalState.EXECUTING, GoalState.LOST]


def calls(choices: Choices) -> list[tuple[str, float]]:
    return [
        (choices.pick(["rise", "fall", "look", "answer"]), choices.number(0, 10) / 10)
        for _ in range(choices.number(0, 30))
    ]


@examples(500)
@given(made_by(calls))
def test_calls_are_one_at_a_time_and_answers_to_what_was_asked_before_do_not_count(
    made: list[tuple[str, float]],
) -> None:
    course = CallCourse(None)
    course.heed(False)
    output, now, rises, begun = False, 0.0, 0, 0
    is_busy = is_outdated = False
    for what, seconds in made:
        now += seconds
        match what:
            case "rise" | "fall":
                wanted = what == "rise"
                changes = wanted != output
                assert course.heed(wanted) == changes
                rises += changes and wanted
                is_outdated = is_outdated or (changes and is_busy)
                output = wanted
            case "answer" if is_busy:
                assert course.end() == (not is_outdated)
                is_busy = is_outdated = False
        if course.is_due(now):
            assert not is_busy and output
            course.begin(now)
            is_busy, begun = True, begun + 1
        assert begun <= rises


def test_a_service_is_called_every_so_often_from_the_beginning_of_one_call_to_that_of_the_next() -> None:
    course = CallCourse(0.5)
    assert course.is_due(0.0)
    course.begin(0.0)
    assert not course.is_due(0.6)  # no answer yet
    assert course.end()
    assert course.is_due(0.6)
    course.begin(0.6)
    course.end()
    assert not course.is_due(1.0)
    assert course.is_due(1.1)
