"""Whole pipelines, as they come from documents: fields mapped by name and type, renamed, and read backwards."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.expressions.types import Value
from sequence_planner.pipelines.pipeline import IncomingPipeline, OutgoingPipeline
from sequence_planner.station import ReadyStation, prepare_station

CELL = Path(__file__).parents[1] / "stations" / "cell"
TRUCK = Path(__file__).parents[3] / "models" / "truck_engine_station"
STATION = prepare_station(CELL)
STATE, COMMAND = STATION.pipelines.incoming["/arm/state"], STATION.pipelines.outgoing["/arm/command"]
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


@pytest.fixture(scope="module")
def tank(tmp_path_factory: pytest.TempPathFactory) -> ReadyStation:
    station = Path(shutil.copytree(CELL, tmp_path_factory.mktemp("station") / "cell"))
    (station / "resources" / "tank.yaml").write_text(TANK, encoding="utf-8")
    text = (station / "station.yaml").read_text(encoding="utf-8")
    text = text.replace("enumerations:\n", "enumerations:\n  mode: [filling, draining]\n")
    (station / "station.yaml").write_text(text, encoding="utf-8")
    messages = station / "messages" / "tank_msgs" / "msg"
    messages.mkdir(parents=True)
    fields = "bool is_open\nstring mode\nuint8 level\nfloat64 temperature\nstring note\nbool full\nbool open_valve\n"
    (messages / "State.msg").write_text(fields, encoding="utf-8")
    (messages / "Command.msg").write_text(
        "bool opening\nstring wanted\nint32 serial 7\nstring fixed\n", encoding="utf-8"
    )
    return prepare_station(station)


def test_fields_are_mapped_by_name_and_the_rest_is_left_alone(tank: ReadyStation) -> None:
    state = tank.pipelines.incoming["/tank/state"]
    # Neither `full` (estimated) nor `open_valve` (an output) is what a device reports.
    assert set(state.variables) == {"tank.valve", "tank.mode", "tank.level"}
    record = {"is_open": True, "mode": "filling", "level": 4, "temperature": 20.5, "note": "", "full": True}
    reading = state.read(record, {})
    assert reading.values == {"tank.valve": True, "tank.mode": "filling", "tank.level": 4}
    assert reading.troubles == []
    assert (state.topic.quality, state.deadline) == ("sensor_data", None)


def test_an_undeclared_value_is_unknown_and_said_and_the_others_stay(tank: ReadyStation) -> None:
    state = tank.pipelines.incoming["/tank/state"]
    reading = state.read({"is_open": True, "mode": "cleaning", "level": 12}, {})
    assert reading.values == {"tank.valve": True, "tank.mode": None, "tank.level": None}
    assert reading.troubles == [
        "mode is 'cleaning', and tank.mode ranges over {filling, draining}",
        "level is 12, and tank.level ranges over 0..9",
    ]


def test_a_command_says_the_outputs_and_leaves_defaults(tank: ReadyStation) -> None:
    command = tank.pipelines.outgoing["/tank/command"]
    record = command.write(tank.automaton.initial_valuation)
    assert record == {"opening": False, "wanted": "draining", "fixed": "x"}
    assert set(command.variables) == {"tank.open_valve", "tank.wanted"}  # a field with a constant carries no variable
    data = tank.registry.encode(command.topic.type_name, record)
    assert tank.registry.decode(command.topic.type_name, data) == {**record, "serial": 7}


def test_a_position_and_what_is_remembered_of_it() -> None:
    memory: dict[str, Value | None] = {}
    reports = [([0.5, 0.2], True), ([1.0, 0.5], False), ([0.9, 0.2], True)]
    read = [STATE.read({"joints": joints, "moving": moving}, memory).values for joints, moving in reports]
    assert read == [
        {"arm.pose": "unknown", "arm.last": None, "arm.moving": True},
        {"arm.pose": "out", "arm.last": "out", "arm.moving": False},
        {"arm.pose": "unknown", "arm.last": "out", "arm.moving": True},
    ]
    assert dict(STATION.pipelines.feeds) == dict.fromkeys(("arm.moving", "arm.pose", "arm.last"), "/arm/state")


def test_a_message_without_sense_does_not_forget() -> None:
    memory: dict[str, Value | None] = {"arm.last": "home"}
    reading = STATE.read({"joints": [float("nan"), 0.0], "moving": False}, memory)
    assert reading.values == {"arm.pose": None, "arm.last": "home", "arm.moving": False}
    assert reading.troubles == ["joints is no position: [nan, 0.0]"]


@given(st.sampled_from(sorted(POINTS)), st.booleans())
def test_what_a_device_says_is_read_as_it_was_meant(pose: str, moving: bool) -> None:
    state: dict[str, Value | None] = {"arm.pose": pose, "arm.last": pose, "arm.moving": moving}
    record = STATE.device_record(state, {"arm.pose": POINTS[pose]})
    assert STATE.read(over_the_wire(STATION, STATE, record), {}).values == state


@given(st.sampled_from(sorted(POINTS)))
def test_a_device_hears_the_command_that_was_given(goto: str) -> None:
    record = COMMAND.write({"arm.goto": goto})
    assert record == {"joints": list(POINTS[goto]), "speed": 0.5}
    heard = COMMAND.device_reading(over_the_wire(STATION, COMMAND, record))
    assert (heard.values, heard.troubles) == ({"arm.goto": goto}, [])


@given(st.data())
def test_every_message_of_the_truck_engine_station_is_read_as_it_was_written(data: st.DataObject) -> None:
    state = {
        name: data.draw(st.sampled_from(variable.type.domain), name)
        for name, variable in TRUCK_STATION.automaton.variables.items()
    }
    for outgoing in TRUCK_STATION.pipelines.outgoing.values():
        heard = outgoing.device_reading(over_the_wire(TRUCK_STATION, outgoing, outgoing.write(state)))
        assert heard.values == {name: state[name] for name in outgoing.variables}
        assert not heard.troubles
    for incoming in TRUCK_STATION.pipelines.incoming.values():
        numbers = {
            stage.variable: stage.coordinates.points.get(str(state[stage.variable]), (9.0,) * 6)
            for stage in incoming.discretised
        }
        record = over_the_wire(TRUCK_STATION, incoming, incoming.device_record(state, numbers))
        reading = incoming.read(record, {stage.variable: state[stage.variable] for stage in incoming.remembered})
        for name in incoming.variables:
            if name not in {stage.variable for stage in incoming.remembered}:
                assert reading.values[name] == state[name]


TRUCK_STATION = prepare_station(TRUCK)


def over_the_wire(
    station: ReadyStation, pipeline: IncomingPipeline | OutgoingPipeline, record: dict[str, object]
) -> dict[str, object]:
    """The record as the other side decodes it."""
    type_name = pipeline.topic.type_name
    return station.registry.decode(type_name, station.registry.encode(type_name, record))
