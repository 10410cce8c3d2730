"""Outputs that came back from the journal: which of them would move a device, and what a person decides."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from controller.carrying_out import carry_out
from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.recovery import DecideOutputs
from sequence_planner.controller.recovery.consistency import RestoredOutputs
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import InitialState
from sequence_planner.language.types import Value
from support.people import EVA
from support.simulated import truck_engine

from .corrected import Station, corrections

NOW = Timestamp(1000.0, 10.0)
WHY = "it stays where it is"


def come_back(outputs: Mapping[str, Value], **measured: Value | None) -> Executor:
    """The bolt station as it is after a start of the controller, with what its devices say."""
    station, supervisor, _ = truck_engine()
    automaton = station.automaton
    initial = automaton.initial_valuation
    values = {name: initial[name] for kind in (Kind.OUTPUT, Kind.ESTIMATED) for name in automaton.names(kind)}
    known = {name: value for name, value in values.items() if value is not None} | dict(outputs)
    execution = Executor(automaton, supervisor, InitialState(known, 900.0, (), frozenset(), NOW))
    heard = {name: initial[name] for name in automaton.names(Kind.MEASURED)}
    heard |= {name.replace("__", "."): value for name, value in measured.items()}
    execution.tick(heard, NOW)
    return execution


def decide(execution: Executor, **values: Value) -> None:
    chosen = {name.replace("__", "."): value for name, value in values.items()}
    carry_out(corrections(execution), DecideOutputs(actor=EVA, reason=WHY, values=chosen), NOW)


def test_devices_that_are_as_they_were_told_leave_nothing_to_decide() -> None:
    assert RestoredOutputs(come_back({})).views() == {}


def test_a_robot_that_was_moved_meanwhile_would_go_back() -> None:
    execution = come_back({}, robot__pose="above_engine")
    [(name, view)] = RestoredOutputs(execution).views().items()
    assert name == "robot.target_pose"
    assert view.value == "home"
    assert view.reacts == ["robot reacts: robot.pose == unknown and robot.moving"]
    assert view.quiet == ["above_engine"]


def test_a_device_that_is_not_heard_may_react() -> None:
    view = RestoredOutputs(come_back({}, robot__pose=None)).views()["robot.target_pose"]
    assert view.reacts == ["robot may react: robot.pose unknown"]
    assert view.quiet == []


def test_nobody_is_called_before_a_device_can_have_been_heard() -> None:
    """Devices that begin with the station are heard a moment later, and then it is certain."""
    undecided = RestoredOutputs(come_back({}, robot__pose=None))
    assert undecided.views()
    assert undecided.told({"robot"}) == []
    assert undecided.told(()) == ["robot.target_pose"]
    assert RestoredOutputs(come_back({}, robot__pose="above_engine")).told({"robot"}) == ["robot.target_pose"]


def test_a_decision_is_one_and_so_is_the_value_that_came_back() -> None:
    for value in ("above_engine", "home"):
        execution = come_back({}, robot__pose="above_engine")
        undecided = RestoredOutputs(execution)
        assert undecided.views()
        decide(execution, robot__target_pose=value)
        assert undecided.views() == {}
        assert execution.state["robot.target_pose"] == value


def test_to_force_an_output_for_a_while_is_no_decision() -> None:
    """Else the robot would move when the force ends, and nobody has decided that it shall."""
    execution = come_back({}, robot__pose="above_engine")
    undecided = RestoredOutputs(execution)
    before = undecided.views()
    execution.force("robot.target_pose", "above_engine", Timestamp(1005.0, 15.0), "Eva", WHY)
    assert undecided.views() == before
    decide(execution, robot__target_pose="above_engine")
    assert undecided.views() == {}
    execution.start_production()
    execution.tick({name: execution.state[name] for name in execution.automaton.names(Kind.MEASURED)}, NOW)
    execution.release("robot.target_pose")
    assert execution.state["robot.target_pose"] == "above_engine"


def test_decisions_are_refused_where_there_is_nothing_to_decide() -> None:
    fresh = Station()
    for execution, values, slug in (
        (fresh.execution, {"robot__target_pose": "home"}, "nothing-to-confirm"),
        (come_back({}), {"robot__target_pose": "unknown"}, "not-in-domain"),
        (come_back({}), {"robot__pose": "home"}, "not-an-output"),
        (come_back({}), {"robot__speed": 1}, "unknown-variable"),
    ):
        before = execution.state
        with pytest.raises(CommandRefused) as refused:
            decide(execution, **values)
        assert refused.value.slug == slug
        assert execution.state == before


def test_no_decision_leads_out_of_the_safe_states() -> None:
    """A bolt is placed and the tool is idle: the robot must not be sent to it."""
    execution = come_back({"bolts[bolt_pair_1]": "placed"}, robot__pose="above_engine")
    assert execution.safe
    with pytest.raises(CommandRefused) as refused:
        decide(execution, robot__target_pose="bolt_pair_1")
    assert refused.value.slug == "output-unsafe"
    assert execution.state["robot.target_pose"] == "home"
    moved = come_back({"bolts[bolt_pair_1]": "placed"}, robot__pose="bolt_pair_2")
    assert "bolt_pair_1" in RestoredOutputs(moved).views()["robot.target_pose"].unsafe


def test_what_is_said_to_be_unsafe_is_refused_and_nothing_else() -> None:
    for pose in ("above_engine", "bolt_pair_1", "bolt_pair_2"):
        execution = come_back({"bolts[bolt_pair_1]": "placed"}, robot__pose=pose)
        view = RestoredOutputs(execution).views()["robot.target_pose"]
        assert not set(execution.automaton.types["robot.target_pose"].domain) <= set(view.unsafe)
        for value in execution.automaton.types["robot.target_pose"].domain:
            again = come_back({"bolts[bolt_pair_1]": "placed"}, robot__pose=pose)
            if value not in view.unsafe:
                decide(again, robot__target_pose=value)
                continue
            with pytest.raises(CommandRefused) as refused:
                decide(again, robot__target_pose=value)
            assert refused.value.slug == "output-unsafe"


def test_once_production_is_started_abilities_decide() -> None:
    execution = come_back({})
    execution.start_production()
    with pytest.raises(CommandRefused) as refused:
        decide(execution, robot__target_pose="home")
    assert refused.value.slug == "production-started"


def test_nobody_decides_blindly_on_what_is_unsafe_whatever_the_devices_say() -> None:
    """Found by killing controllers: before anything was heard, the tool was told neither to run nor to stand."""
    unheard = dict.fromkeys((n.replace(".", "__") for n in truck_engine()[0].pipelines.feeds), None)
    running: dict[str, Value] = {"nutrunner.set_tool_idle": False, "nutrunner.run_tool_forward": True}
    execution = come_back(running | {"robot.attach_tool": True}, **unheard)
    with pytest.raises(CommandRefused, match="outside its safe states") as refused:
        decide(execution, nutrunner__run_tool_forward=False)
    assert refused.value.slug == "output-unsafe"
    decide(execution, nutrunner__run_tool_forward=False, nutrunner__set_tool_idle=True)
