"""What a tick does on a live station in the corners: before production, with goals met early, when it fails."""

from __future__ import annotations

from dataclasses import replace
from typing import NoReturn

import pytest

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.diagnosis import Diagnosis
from sequence_planner.planning.problem import Plan, PlanAnswer, PlanTick, Verdict
from support.automata import Does, automaton
from support.simulated import PAIRS, Rig, never

EVERYTHING_IS_SAFE = Supervisor(StateSet((), ()), {})
NOW = Timestamp(1000.0, 10.0)

LAMP = automaton(
    {
        "shine": Does(
            start=("lamp := true",), executing="lamp and not lit", finish="lamp and lit", finally_=("lamp := false",)
        )
    },
    measured={"lit": (BOOLEAN, False)},
    output={"lamp": (BOOLEAN, False)},
    goals={"light": "lit"},
)

# The lamp shines twice; the second time may begin as soon as the first has ended.
BLINK = automaton(
    {
        "shine": Does(
            start=("lamp := true", "on := true"),
            enabled="not lamp",
            executing="lamp and not lit",
            finish="lamp and on",
            finally_=("lamp := false", "on := false", "twice := true if once", "once := true"),
        )
    },
    measured={"lit": (BOOLEAN, False)},
    output={"lamp": (BOOLEAN, False)},
    estimated=dict.fromkeys(("on", "once", "twice"), (BOOLEAN, False)),
    goals={"light": "twice"},
)


def told(outcome: TickOutcome) -> tuple[object, object, object]:
    return outcome.ended, outcome.started, outcome.outputs


def status(execution: Executor) -> PlanStatus:
    return execution.plan.status


def follow(execution: Executor, answer: PlanAnswer) -> None:
    """Adopt the answer."""
    request = execution.request(5)
    assert request is not None
    assert execution.adopt(request, answer)


def found(*starts: str, goals: tuple[str, ...] = ("light",)) -> PlanAnswer:
    plan = Plan((PlanTick((), starts), PlanTick((), ())), minimal_ticks=True, minimal_starts=True)
    return PlanAnswer(Verdict.FOUND, plan, goals, (), 2, 0.01)


def none(searched: int = 60) -> PlanAnswer:
    return PlanAnswer(Verdict.NONE_UP_TO, None, (), (), searched, 0.01)


def test_outputs_that_change_before_production_are_no_news_and_let_the_station_rest() -> None:
    """Else every tick is followed by another at once, for as long as nobody starts production."""
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.state = {**execution.state, "lamp": True}
    outcomes = [execution.tick({"lit": True}, NOW) for _ in range(4)]
    assert execution.state["lamp"] is False
    assert outcomes[0].finished == ("shine",)
    assert outcomes[0].ended == ()
    assert not any(outcome.outputs for outcome in outcomes)
    assert not outcomes[-1].changed


def test_an_output_that_a_finish_has_set_is_published_before_a_start_takes_it_back() -> None:
    """Else the device never sees that it was told to stop and to go again."""
    execution = Executor(BLINK, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    follow(execution, found("shine", "shine"))
    first = execution.tick({"lit": False}, NOW)
    assert told(first) == ((), ("shine",), {"lamp"})
    second = execution.tick({"lit": True}, NOW)
    assert told(second) == (("shine",), (), {"lamp"})
    assert execution.state["lamp"] is False
    third = execution.tick({"lit": True}, NOW)
    assert told(third) == ((), ("shine",), {"lamp"})


@pytest.mark.parametrize("failing", ["_start", "_update_operations"])
def test_a_tick_that_raises_has_not_happened(failing: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def breaks(*_: object, **__: object) -> NoReturn:
        raise RuntimeError("a rare case")

    rig = Rig()
    rig.start_production()
    assert rig.run(60, until=lambda: rig.value("nutrunner.run_nut.executing") is True)
    execution = rig.execution
    before = (execution.state, execution.published, execution.active, execution.ticks, execution.plan.status)
    past, ahead = [*execution.plan.order.past], execution.plan.order.names
    running = [step.ended for step in execution.plan.order.past]
    measured = {**rig.measured(), **rig.desk.measured(), "nutrunner.programmed_torque_reached": True}
    with monkeypatch.context() as broken:
        broken.setattr(execution, failing, breaks)
        with pytest.raises(RuntimeError):
            execution.tick(measured, NOW)
    assert before == (execution.state, execution.published, execution.active, execution.ticks, execution.plan.status)
    assert [step.ended for step in execution.plan.order.past] == running
    assert (len(execution.plan.order.past), execution.plan.order.names) == (len(past), ahead)
    assert "nutrunner.run_nut" in execution.tick(measured, NOW).ended


def test_what_is_left_of_a_plan_is_not_started_once_its_goals_are_met() -> None:
    rig = Rig(acknowledges=never)
    rig.start_production()
    rig.run(1)
    placed = dict.fromkeys([f"bolts[{pair}]" for pair in PAIRS], "placed")
    rig.execution.state = {**rig.execution.state, **placed}
    assert rig.run(5, until=lambda: len(rig.execution.plan.order.ahead) > 1)
    tightened = dict.fromkeys(placed, "tightened")
    rig.execution.state = {**rig.execution.state, **tightened}
    outcome = rig.execution.tick({**rig.measured(), **rig.desk.measured()}, Timestamp(rig.now, rig.now))
    assert outcome.completed
    assert outcome.started == ()
    assert rig.execution.plan.order.names == ()


def test_that_there_is_no_plan_stays_said_while_another_state_is_asked_about() -> None:
    """Else the alarm goes and comes with every message."""
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    request = execution.request(5)
    assert request is not None
    assert status(execution) is PlanStatus.PLANNING
    assert execution.adopt(request, none())
    assert status(execution) is PlanStatus.NONE
    assert execution.request(5) is None, "the same state has the same answer"
    execution.state = {**execution.state, "lamp": True}
    assert execution.request(5) is not None
    assert status(execution) is PlanStatus.NONE


@pytest.mark.parametrize(
    ("verdict", "said"),
    [
        (Verdict.NONE_AT_ALL, "no plan at all, proven: nothing the station can do from here reaches any of the goals"),
        (Verdict.NONE_UP_TO, "no plan of up to 60 ticks: there may be a longer one"),
        (Verdict.LATE, "no answer in time: no plan of up to 60 ticks, and longer ones may exist"),
    ],
)
def test_it_is_said_what_is_known_when_there_is_no_plan(verdict: Verdict, said: str) -> None:
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    follow(execution, replace(none(), verdict=verdict))
    assert execution.plan.reason == said


def test_why_there_is_no_plan_at_all_is_asked_until_it_is_answered() -> None:
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    follow(execution, none())
    assert execution.plan.unexplained(20) is None, "there may be a longer plan"
    execution.state = {**execution.state, "lamp": True}
    follow(execution, replace(none(), verdict=Verdict.NONE_AT_ALL))
    question = execution.plan.unexplained(20)
    assert question is not None
    assert question == execution.plan.unexplained(20), "it may have been called off"
    assert (question.state, [goal.name for goal in question.goals]) == (execution.state, ["light"])
    diagnosis = Diagnosis(None, ())
    execution.explained(diagnosis)
    assert execution.plan.diagnosis is diagnosis
    assert execution.plan.unexplained(20) is None
    execution.state = {**execution.state, "lamp": False}
    follow(execution, none())
    assert execution.plan.diagnosis is None, "there may be a plan now"


def test_no_plan_for_want_of_knowledge_is_forgotten_with_the_knowledge() -> None:
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    execution.tick({"lit": None}, NOW)
    request = execution.request(5)
    assert request is not None
    assert execution.adopt(request, none())
    assert execution.plan.reason == "no plan while measured values are unknown"
    execution.tick({"lit": False}, NOW)
    assert execution.request(5) is not None
    assert status(execution) is PlanStatus.PLANNING


def test_no_plan_for_a_state_long_gone_is_said_and_asked_again() -> None:
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    request = execution.request(5)
    assert request is not None
    execution.state = {**execution.state, "lamp": True}
    assert not execution.adopt(request, none())
    assert status(execution) is PlanStatus.NONE
    assert execution.request(5) is not None


def test_a_plan_for_a_state_long_gone_is_not_followed() -> None:
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    request = execution.request(5)
    assert request is not None
    assert not execution.adopt(request, found("shine")), "no effect ever lights the lamp, so it does not reach the goal"
    assert execution.plan.order.names == ()
    assert execution.request(5) is not None


@pytest.mark.parametrize("again", [True, False])
def test_a_question_without_an_answer_is_asked_again_only_if_that_may_help(again: bool) -> None:
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick({"lit": False}, NOW)
    assert execution.request(5) is not None
    execution.unanswered("the planner has ended", again)
    assert status(execution) is PlanStatus.NONE
    assert execution.plan.reason == "no plan: the planner has ended"
    assert (execution.request(5) is not None) == again


def test_what_is_active_before_production_is_shown_with_the_reason_for_no_plan() -> None:
    execution = Executor(LAMP, EVERYTHING_IS_SAFE)
    execution.tick({"lit": False}, NOW)
    assert execution.active == {"light"}
    assert execution.plan.reason == "production has not been started"
    assert execution.request(5) is None


def test_what_is_active_is_known_to_the_flags_and_starts_of_the_same_tick() -> None:
    active = "operation.light.active"
    station = automaton(
        {"shine": Does(start=("lamp := true",), when=active, finished=active)},
        measured={"lit": (BOOLEAN, False)},
        output={"lamp": (BOOLEAN, False)},
        estimated={active: (BOOLEAN, False)},
        goals={"light": "lit"},
    )
    execution = Executor(station, EVERYTHING_IS_SAFE)
    assert execution.startable("shine") is None

    assert execution.tick({"lit": False}, NOW).activated == {"light"}
    assert (execution.state[active], execution.state["shine.finished"]) == (True, True)
    after = execution.startable("shine")
    assert after is not None
    assert (after.values["lamp"], after.values["shine.finished"]) == (True, True)
    assert execution.state["lamp"] is False  # looked at, and not taken

    assert execution.tick({"lit": True}, NOW).completed == {"light"}
    assert (execution.state[active], execution.state["shine.finished"]) == (False, False)
    assert execution.startable("shine") is None
