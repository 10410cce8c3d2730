"""Why there are alarms: each is noticed in time, and says what comes of it."""

from __future__ import annotations

import dataclasses

import pytest

from controller.alarming.scene import Scene, acknowledge, alarms
from controller.carrying_out import carry_out
from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.commands.tasks import ProblemKind, TaskProblem
from sequence_planner.controller.recovery.manual import Moved, WentOn
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import AlarmState, Priority, QuestionView
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import LastOperatorPlan, OutOfService
from sequence_planner.execution.vocabulary import Mode, PlanStatus, ServiceKind
from sequence_planner.planning.problem import PlanAnswer, Verdict
from sequence_planner.texts.message import Message, Wording, as_it_was, message
from support.simulated import Rig, never


def outcome(
    finished: tuple[str, ...] = (), started: tuple[str, ...] = (), conflicts: tuple[tuple[str, str, str], ...] = ()
) -> TickOutcome:
    nothing: frozenset[str] = frozenset()
    return TickOutcome(finished, (), started, nothing, nothing, conflicts, nothing, changed=True)


def plan_status(execution: Executor) -> PlanStatus:
    """For a type checker another each time."""
    return execution.plan.status


def there(shown: Scene, now: Timestamp) -> set[str]:
    """The alarms whose causes are there."""
    return {key for key, alarm in shown.current(now).items() if alarm.ended is None}


def test_a_conflict_is_shown_until_one_of_the_two_goes_on() -> None:
    """It lasts one tick, and a tick is shorter than a look; what it left undone lasts."""
    shown = alarms(Rig())
    shown.note(outcome(conflicts=(("a", "b", "x"), ("a", "c", "x"))))
    shown.note(outcome())
    now = Timestamp(1000, 10)
    assert {"conflict:a:b:x", "conflict:a:c:x"} <= shown.current(now).keys()
    shown.note(outcome(started=("b",)))
    assert there(shown, now) == {"conflict:a:c:x"}
    shown.note(outcome(finished=("a",)))
    assert there(shown, now) == set()


def test_a_clock_that_is_set_makes_nothing_overdue() -> None:
    rig = Rig(acknowledges=never)
    rig.start_production()
    shown = alarms(rig)
    assert rig.run(10, until=lambda: rig.value("robot.attach_tool") is True)
    attach = "overdue:robot.attach_in_planning_scene"
    assert attach not in shown.current(Timestamp(rig.now + 86400, rig.now + 1))
    assert attach in shown.current(Timestamp(rig.now - 86400, rig.now + 11))


def test_an_alarm_keeps_the_time_at_which_it_came() -> None:
    shown = alarms(Rig())
    shown.trouble = "the planner has ended"
    first = shown.current(Timestamp(1000, 10))
    later = shown.current(Timestamp(1060, 70))
    assert first["planner"].since == later["planner"].since == 1000
    carry_out(shown.alarms, acknowledge("planner", 1000), Timestamp(1065, 75))
    shown.trouble = None
    assert "planner" not in shown.current(Timestamp(1070, 80))
    shown.trouble = "the planner has ended"
    assert shown.current(Timestamp(1080, 90))["planner"].since == 1080


def test_an_ability_that_does_not_begin_in_time_is_noticed() -> None:
    rig = Rig()
    rig.start_production()
    shown = alarms(rig)
    assert rig.run(60, until=lambda: "nutrunner.run_nut" in rig.started)
    late = "overdue:nutrunner.run_nut"
    assert late not in shown.current(Timestamp(rig.now + 4, rig.now + 4))
    told = shown.current(Timestamp(rig.now + 6, rig.now + 6))[late]
    assert told.text == "The nutrunner does not start. Nutrunner: “Run the nutrunner” has not begun within 5 s"
    assert told.consequence == "“Tighten bolt pair 3” waits for Nutrunner."

    assert rig.run(5, until=lambda: rig.value("nutrunner.run_nut.executing") is True)
    told = shown.current(Timestamp(rig.now + 6, rig.now + 6))[late]
    assert told.state is AlarmState.RETURNED
    both = shown.current(Timestamp(rig.now + 29.8, rig.now + 29.8))  # nor has the robot moved, for which the tool waits
    (robot,) = (alarm for key, alarm in both.items() if key.startswith("overdue:robot") and alarm.ended is None)
    assert robot.state is AlarmState.UNACKNOWLEDGED
    late_too = "No torque with the robot between its poses. Nutrunner: “Run the nutrunner” has not finished within "
    assert any(part.startswith(late_too) for part in robot.parts), robot.parts


def test_the_model_says_first_what_it_means_that_an_ability_is_late() -> None:
    """With what values are called in each language; where one is not known, it is told as of every ability."""
    rig = Rig()
    rig.start_production()
    shown = alarms(rig)
    assert rig.run(60, until=lambda: rig.value("nutrunner.run_nut.executing") is True)
    key, late = "overdue:nutrunner.run_nut", Timestamp(rig.now + 31, rig.now + 31)
    run = "Nutrunner: “Run the nutrunner” has not finished within 30 s"
    (told,) = (each for each in shown.abilities.causes(late) if each.key == key)
    assert str(told.text) == f"No torque with the robot between its poses. {run}"
    assert str(told.past) == "Nutrunner: “Run the nutrunner” did not finish within 30 s"
    named = told.text.arguments["what"]
    assert isinstance(named, Message)
    words = named.arguments["words"]
    assert isinstance(words, Wording)
    assert words.words == {
        "en": "No torque with the robot between its poses",
        "sv": "Inget moment med roboten mellan sina lägen",
    }

    rig.execution.state = {**rig.execution.state, "robot.pose": None}
    (told,) = (each for each in shown.abilities.causes(late) if each.key == key)
    assert str(told.text) == run


def test_a_specification_that_is_broken_for_certain_is_an_alarm_whatever_else_is_unknown() -> None:
    rig = Rig()
    shown = alarms(rig)
    assert rig.execution.blind
    now = Timestamp(1000, 10)
    assert "unsafe-state" not in shown.current(now)  # for all that is known it may be safe
    rig.execution.state = {
        **rig.execution.state,
        "bolts[bolt_pair_1]": "placed",
        "robot.target_pose": "bolt_pair_1",
        "nutrunner.run_nut.executing": False,
    }
    assert "The nutrunner must turn before it meets placed bolts" in shown.current(now)["unsafe-state"].text


def test_what_cannot_be_recorded_is_one_alarm_whoever_notices() -> None:
    rig = Rig()
    rig.start_production()
    rig.run(3)
    shown = alarms(rig)
    shown.unjournalled = shown.unrecorded = "database or disk is full"
    told = shown.current(Timestamp(1000, 10))
    assert "unrecorded" not in told
    assert told["unjournalled"].parts == ["Commands cannot be recorded: database or disk is full"]
    assert told["unjournalled"].consequence.startswith("Nothing is started. “")


def test_before_production_nothing_waits() -> None:
    shown = alarms(Rig())
    shown.unjournalled = "database or disk is full"
    told = shown.current(Timestamp(1000, 10))["unjournalled"]
    assert told.consequence == "Nothing is started. Production is not started, so nothing waits for it."


def test_outputs_that_nobody_has_decided_on_are_an_alarm(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = alarms(Rig())
    undecided = ["robot.target_pose", "nutrunner.run_tool_forward"]
    monkeypatch.setattr(shown.consistency, "told", lambda untold: undecided)
    told = shown.current(Timestamp(1000, 10))["undecided-outputs"]
    assert told.text.endswith("nutrunner.run_tool_forward and robot.target_pose")
    undecided.clear()
    assert there(shown, Timestamp(1001, 11)) == set()


def test_what_did_not_come_back_is_an_alarm_until_production_is_started() -> None:
    rig = Rig()
    left_out = (
        message("restored.range", name="speed", value="3", range="0..2"),
        message("restored.repeats", name="polish"),
    )
    shown = alarms(rig, RestoredState(left_out=left_out))
    told = shown.current(Timestamp(1000, 10))["not-restored"]
    assert told.text.endswith("could not be fully restored: speed was 3, and ranges over 0..2 now, and 1 more")
    assert tuple(told.parts) == (
        "speed was 3, and ranges over 0..2 now",
        "operation polish was completed, and is none that does not repeat",
    )
    rig.start_production()
    assert there(shown, Timestamp(1001, 11)) == set()


def test_a_question_names_the_operations_that_it_decides() -> None:
    rig = Rig()
    rig.start_production()
    rig.run(3)
    shown = alarms(rig)
    shown.consistency.questions = [
        QuestionView(
            variable="bolts[bolt_pair_1]",
            believed="placed",
            so=as_it_was("pair 1 is placed"),
            possible=["empty"],
            because=["a does not go with b"],
            because_messages=[],
        )
    ]
    told = shown.current(Timestamp(1000, 10))["contradiction"]
    assert "It is believed that bolts[bolt_pair_1] == placed" in told.text
    assert told.consequence == "Plans may be wrong, and so may be whether “Tighten bolt pair 1” is reached."


def test_a_forced_variable_is_told_as_long_as_it_lasts() -> None:
    rig = Rig()
    shown = alarms(rig)
    now = Timestamp(1000, 10)
    rig.execution.force("robot.pose", "home", Timestamp(1060, 70), "Eva", "its camera is dirty")
    told = shown.current(now)["forced:robot.pose"]
    assert told.text == "Forced: robot.pose == home. By Eva: its camera is dirty"
    assert (told.priority, told.state) == (Priority.LOW, AlarmState.ACKNOWLEDGED)
    rig.execution.release("robot.pose")
    assert "forced:robot.pose" not in shown.current(now)


def test_abilities_of_one_resource_that_are_given_up_are_one_alarm() -> None:
    rig = Rig()
    for name in ("nutrunner.run_nut", "robot.attach_in_planning_scene"):
        service = {**rig.execution.conduct.service}
        of = (ServiceKind.ABILITY, name)
        service[of] = OutOfService(*of, Timestamp(1000, 10), None, "has not begun within 5 s, tried 2 times")
        rig.execution.conduct = replace(rig.execution.conduct, service=service)
    rig.execution.set_service(ServiceKind.ABILITY, "robot.detach_from_planning_scene", False, "Eva", "", rig_now(rig))
    told = alarms(rig).current(Timestamp(1000, 10))
    assert {key for key in told if key.startswith("given-up")} == {"given-up:nutrunner", "given-up:robot"}
    assert told["given-up:nutrunner"].text == (
        "“Run the nutrunner” has not begun within 5 s, tried 2 times: it is given up"
    )
    assert "put Run the nutrunner back in service" in told["given-up:nutrunner"].action


def test_where_there_is_no_plan_what_is_out_of_service_is_to_be_put_back() -> None:
    rig = Rig()
    rig.start_production()
    rig.run(1)
    shown = alarms(rig)

    def serve(of: ServiceKind, name: str, in_service: bool) -> None:
        rig.execution.set_service(of, name, in_service, "Eva", "it squeaks", rig_now(rig))

    serve(ServiceKind.RESOURCE, "robot", False)
    assert rig.run(3, until=lambda: len(rig.completed) > 0)
    assert "no-plan" not in there(shown, rig_now(rig)), "bolts are placed without it"
    assert rig.run(30, until=lambda: rig.execution.plan.status is PlanStatus.NONE)
    told = shown.current(rig_now(rig))["no-plan"]
    assert told.consequence == "“Tighten bolt pairs 1 to 3” waits."
    assert told.action == "Put Robot UR10 back in service, or see what the active operations need."
    serve(ServiceKind.ABILITY, "nutrunner.run_nut", False)
    told = shown.current(rig_now(rig))["no-plan"]
    assert told.action.startswith("Put Robot UR10 and Run the nutrunner back in service, or ")
    serve(ServiceKind.RESOURCE, "robot", True)
    serve(ServiceKind.ABILITY, "nutrunner.run_nut", True)
    assert rig.run(30, until=lambda: "new_engine" in rig.completed)
    assert "no-plan" not in there(shown, rig_now(rig))


def test_that_there_was_no_plan_while_nothing_was_known_is_no_alarm_once_it_is_known() -> None:
    """An answer that comes just after the first messages is about the moment before them."""
    rig = Rig()
    execution, shown, now = rig.execution, alarms(rig), rig_now(rig)
    measured = rig.station.automaton.names(Kind.MEASURED)
    first = {name: rig.station.automaton.variables[name].initial for name in measured}
    answer = PlanAnswer(Verdict.NONE_AT_ALL, None, (), tuple(sorted(execution.active)), 0, 0.01)
    execution.start_production()
    execution.tick(first, now)
    execution.tick(dict.fromkeys(measured), now)
    request = execution.request(5)
    assert request is not None
    execution.tick(first, now)
    assert not execution.adopt(request, answer), "it is asked again"
    assert plan_status(execution) is PlanStatus.NONE
    assert there(shown, now).isdisjoint({"no-plan", "left-out"})
    again = execution.request(5)
    assert again is not None
    assert plan_status(execution) is PlanStatus.PLANNING
    assert there(shown, now).isdisjoint({"no-plan", "left-out"})
    assert execution.adopt(again, answer)
    assert "no-plan" in there(shown, now), "of what is known by now"


def test_an_errand_that_the_station_has_stopped_is_an_alarm_until_it_works_again() -> None:
    rig = Rig()
    shown = alarms(rig)
    now = rig_now(rig)
    rig.execution.change_mode(Mode.RESTART, "Eva", now)
    for by, expected in (("Eva", set[str]()), (None, {f"errand:{now.epoch}"})):
        last = LastOperatorPlan("Bring the robot home", False, "the station departed from it", now, by)
        rig.execution.conduct = replace(rig.execution.conduct, last_operator_plan=last)
        assert there(shown, now) == expected
    rig.execution.change_mode(Mode.AUTOMATIC, "Eva", now)
    assert there(shown, now) == set()


def rig_now(rig: Rig) -> Timestamp:
    return Timestamp(rig.now, rig.now)


def test_a_problem_with_a_task_is_told_with_who_has_it_and_what_waits_for_it() -> None:
    rig = Rig(acknowledges=never)
    rig.start_production()
    assert rig.run(10, until=lambda: bool(rig.desk.open))
    (task,) = rig.desk.open.values()
    shown, now = alarms(rig), Timestamp(rig.now, rig.now)
    rig.desk.problems = {task.id: TaskProblem("Eva", rig.now, "no bolts")}
    alarm = shown.current(now)[f"problem:{task.id}"]
    assert (alarm.priority, alarm.state) == (Priority.MEDIUM, AlarmState.UNACKNOWLEDGED)
    assert alarm.text == f"Eva has a problem with “{task.title}”: no bolts"
    assert alarm.consequence.endswith("wait for Operator.") or alarm.consequence.endswith("waits for Operator.")
    rig.desk.problems = {task.id: TaskProblem("Eva", rig.now, "", ProblemKind.MISSING)}
    assert shown.current(now)[f"problem:{task.id}"].text.endswith("”: a part is missing")
    rig.desk.problems = {task.id: TaskProblem("Eva", rig.now, "the left one", ProblemKind.DAMAGED)}
    assert shown.current(now)[f"problem:{task.id}"].text.endswith("”: something is damaged, the left one")
    rig.desk.problems = {}
    assert f"problem:{task.id}" not in there(shown, now)


def test_what_was_moved_by_hand_is_a_notice_that_nobody_has_to_acknowledge(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig()
    shown, now = alarms(rig), rig_now(rig)
    moved = Moved("robot", {"robot.pose": ("bolt_pair_1", "home")}, now)
    notices = [moved]
    monkeypatch.setattr(shown.by_hand, "notices", lambda monotonic: notices)
    told = shown.current(now)["by-hand:robot"]
    assert (told.priority, told.state) == (Priority.LOW, AlarmState.ACKNOWLEDGED)
    assert (
        told.text == "Robot UR10 has changed without a command. Measured then: robot.pose == home (before: bolt_pair_1)"
    )
    assert told.consequence == "Nothing has been started because of it yet."
    notices[:] = [dataclasses.replace(moved, by="robot.move_to_position(home)", how=WentOn.STARTED, on=now)]
    assert shown.current(now)["by-hand:robot"].consequence == "“Move to home” was started after it."
    notices.clear()
    assert "by-hand:robot" not in shown.current(now)
