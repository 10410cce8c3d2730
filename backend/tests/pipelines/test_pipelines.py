"""Whole pipelines, as they come from documents: fields mapped by name and type, renamed, and read backwards."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.simulation.devices import CommandReader
from sequence_planner.simulation.messages import spoken
from sequence_planner.station import ReadyStation, prepare_station
from support.places import BOLT_TIGHTENING, CELL

from .station_writing import Heard, station_with

STATION = prepare_station(CELL)
TRUCK_STATION = prepare_station(BOLT_TIGHTENING)
COMMAND = STATION.pipelines.outgoing["/arm/command"]
POINTS = {"home": (0.0, 0.0), "out": (1.0, 0.5)}

TANK = """
topics:
  /tank/state: {type: tank_msgs/msg/State, direction: in, quality: sensor_data, pipeline: [rename: {is_open: valve}]}
  /tank/command:
    type: tank_msgs/msg/Command
    direction: out
    pipeline: [rename: {opening: open_valve}, constant: {fixed: x}]
measured:
  valve: {type: bool}
  mode: {type: mode}
  level: {type: 0..9}
output:
  open_valve: {type: bool}
  wanted: {type: mode, initial: draining}
  fixed: {type: mode}
estimated:
  full: {type: bool}
"""
STATE_FIELDS = "bool is_open\nstring mode\nuint8 level\nfloat64 temperature\nstring note\nbool full\nbool open_valve\n"
COMMAND_FIELDS = "bool opening\nstring wanted\nint32 serial 7\nstring fixed\n"


@pytest.fixture(scope="module")
def tank(tmp_path_factory: pytest.TempPathFactory) -> ReadyStation:
    messages = {"State": STATE_FIELDS, "Command": COMMAND_FIELDS}
    return station_with(tmp_path_factory.mktemp("station"), TANK, messages, "mode: [filling, draining]")


def test_fields_are_mapped_by_name_and_the_rest_is_left_alone(tank: ReadyStation) -> None:
    state = tank.pipelines.incoming["/tank/state"]
    # Neither `full` (estimated) nor `open_valve` (an output) is what a device reports.
    assert set(state.variables) == {"tank.valve", "tank.mode", "tank.level"}
    heard = Heard(tank)
    heard.take("/tank/state", is_open=True, mode="filling", level=4, temperature=20.5, full=True)
    known = {name: heard.known()[name] for name in state.variables}
    assert known == {"tank.valve": True, "tank.mode": "filling", "tank.level": 4}
    assert heard.running.trouble("/tank/state") is None
    assert (str(state.topic.quality), state.deadline) == ("sensor_data", None)


def test_an_undeclared_value_is_unknown_and_said_and_the_others_stay(tank: ReadyStation) -> None:
    heard = Heard(tank)
    known = heard.take("/tank/state", is_open=True, mode="cleaning", level=12)
    assert (known["tank.valve"], known["tank.mode"], known["tank.level"]) == (True, None, None)
    assert heard.running.trouble("/tank/state") == (
        "mode is 'cleaning', and tank.mode ranges over {filling, draining}; "
        "level is 12, and tank.level ranges over 0..9"
    )
    heard.take("/tank/state", mode="filling")
    assert heard.running.trouble("/tank/state") is None


def test_a_command_says_the_outputs_and_leaves_defaults(tank: ReadyStation) -> None:
    command = tank.pipelines.outgoing["/tank/command"]
    message = first_message(command, tank.automaton.initial_valuation)
    assert message == {"opening": False, "wanted": "draining", "fixed": "x"}
    assert set(command.variables) == {"tank.open_valve", "tank.wanted"}  # a field with a constant carries no variable
    data = tank.registry.encode(command.topic.type_name, message)
    assert tank.registry.decode(command.topic.type_name, data) == {**message, "serial": 7}


def test_an_unknown_variable_leaves_the_default(tank: ReadyStation) -> None:
    state = {**tank.automaton.initial_valuation, "tank.wanted": None}
    assert first_message(tank.pipelines.outgoing["/tank/command"], state) == {"opening": False, "fixed": "x"}


def test_a_position_and_what_is_remembered_of_it() -> None:
    heard = Heard(STATION)
    assert [
        heard.take("/arm/state", joints=joints, moving=moving)
        for joints, moving in (([0.5, 0.2], True), ([1.0, 0.5], False), ([0.9, 0.2], True))
    ] == [
        {"arm.pose": "unknown", "arm.last": None, "arm.moving": True},
        {"arm.pose": "out", "arm.last": "out", "arm.moving": False},
        {"arm.pose": "unknown", "arm.last": "out", "arm.moving": True},
    ]
    assert dict(STATION.pipelines.feeds) == dict.fromkeys(("arm.moving", "arm.pose", "arm.last"), "/arm/state")


def test_a_message_without_sense_does_not_forget() -> None:
    heard = Heard(STATION)
    heard.take("/arm/state", joints=[0.0, 0.0])
    known = heard.take("/arm/state", joints=[float("nan"), 0.0])
    assert known == {"arm.pose": None, "arm.last": "home", "arm.moving": False}
    assert heard.running.trouble("/arm/state") == "joints is no position: [nan, 0.0]"


@given(st.sampled_from(sorted(POINTS)), st.booleans())
def test_what_a_device_says_is_read_as_it_was_meant(pose: str, moving: bool) -> None:
    state: dict[str, Value | None] = {"arm.pose": pose, "arm.last": pose, "arm.moving": moving}
    message = spoken(STATION.pipelines, "/arm/state", state, {})
    assert message["joints"] == list(POINTS[pose])
    assert Heard(STATION).take("/arm/state", **message) == state


@given(st.sampled_from(sorted(POINTS)))
def test_a_device_hears_the_command_that_was_given(goto: str) -> None:
    message = first_message(COMMAND, {**STATION.automaton.initial_valuation, "arm.goto": goto})
    assert message == {"joints": list(POINTS[goto]), "speed": 0.5}
    type_name = COMMAND.topic.type_name
    heard = STATION.registry.decode(type_name, STATION.registry.encode(type_name, message))
    assert CommandReader(COMMAND, STATION.automaton).read(heard) == ({"arm.goto": goto}, [])


READERS = {n: CommandReader(p, TRUCK_STATION.automaton) for n, p in TRUCK_STATION.pipelines.outgoing.items()}


@given(st.data())
def test_every_message_of_the_bolt_tightening_is_read_as_it_was_written(data: st.DataObject) -> None:
    registry, pipelines = TRUCK_STATION.registry, TRUCK_STATION.pipelines
    state: dict[str, Value | None] = {
        name: data.draw(st.sampled_from(variable.type.domain), name)
        for name, variable in TRUCK_STATION.automaton.variables.items()
    }
    for name, outgoing in pipelines.outgoing.items():
        message = first_message(outgoing, state)
        assert message is not None
        type_name = outgoing.topic.type_name
        heard = registry.decode(type_name, registry.encode(type_name, message))
        assert READERS[name].read(heard) == ({variable: state[variable] for variable in outgoing.variables}, [])
    heard_back = Heard(TRUCK_STATION)
    for name in pipelines.incoming:
        heard_back.take(name, **spoken(pipelines, name, state, {}))
        assert heard_back.running.trouble(name) is None
    read = heard_back.known()
    read.pop("robot.previous_pose")  # no message says it
    assert read == {name: state[name] for name in read}
