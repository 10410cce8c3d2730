"""Pipelines from documents: nested fields, constants of messages, quality of service, and what does not fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.language.types import EnumerationType, IntegerRange
from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.chain_runtime import RunningOutgoing, first_message
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.simulation.devices import CommandReader
from sequence_planner.simulation.messages import spoken

from .station_writing import Heard, station_with

FIELDS = {
    "Status": "uint8 IDLE=0\nuint8 RUNNING=3\nuint8 UNUSED=4\nuint8 mode\nTool tool\nbool[3] doors\nfloat64 force\n",
    "Tool": "bool locked\nuint8 slot\nint64 serial\n",
    "Order": "uint8 IDLE=0\nuint8 RUNNING=3\nuint8 mode\ngeometry_msgs/Pose pose\nfloat64[2] joints\n",
}
STATUS = """
topics:
  /status:
    type: tank_msgs/msg/Status
    direction: in
    pipeline: [rename: {tool.locked: locked, "doors[1]": door}]
"""


def test_fields_in_other_messages_are_variables_where_rename_says_so(tmp_path: Path) -> None:
    station = station_with(
        tmp_path, STATUS.replace("tool.locked: locked", "tool.locked: locked, tool.slot: slot"), FIELDS
    )
    variables = station.automaton.variables
    assert variables["tank.slot"].type == IntegerRange(0, 255)
    assert "tank.serial" not in variables
    known = Heard(station).take("/status", tool={"locked": True, "slot": 7}, doors=[False, True, False])
    assert (known["tank.locked"], known["tank.slot"], known["tank.door"]) == (True, 7, True)


def test_an_enumeration_of_the_names_of_constants_is_mapped_by_itself(tmp_path: Path) -> None:
    resource = STATUS + "  /order: {type: tank_msgs/msg/Order, direction: out, ignore: [pose]}\n"
    resource += "measured: {mode: {type: modes}}\n"
    station = station_with(tmp_path / "in", resource, FIELDS, "modes: [running, idle]")
    assert station.automaton.variables["tank.mode"].type == EnumerationType(("running", "idle"))
    heard = Heard(station)
    assert heard.take("/status", mode=3)["tank.mode"] == "running"
    assert heard.take("/status", mode=0)["tank.mode"] == "idle"
    assert heard.take("/status", mode=4)["tank.mode"] is None
    assert "mode is 4" in (heard.running.trouble("/status") or "")
    state = station.automaton.initial_valuation
    assert spoken(station.pipelines, "/status", {**state, "tank.mode": "running"}, {})["mode"] == 3
    order = station.pipelines.outgoing["/order"]
    assert first_message(order, {**state, "tank.mode": "running"}) == {"mode": 3}


def test_names_that_are_no_constants_do_not_correspond_to_numbers(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"field `mode` is 0\.\.255, and `tank.mode` is \{idle, busy\}: they do not"):
        station_with(tmp_path, STATUS + "measured: {mode: {type: modes}}\n", FIELDS, "modes: [idle, busy]")


ORDER = """
topics:
  /order:
    type: tank_msgs/msg/Order
    direction: out
    ignore: [mode]
    pipeline:
      - map: {variable: up, field: pose.position.x, values: {"true": 0.5, "false": 1.5}}
      - expression: {ready: up and not stopped}
      - filter: ready
      - undiscretise: {variable: place, field: joints, values: {left: [0, 1], right: [1, 0.3]}}
      - constant: {pose.orientation.w: 0.25}
measured: {stopped: {type: bool}}
output: {place: {type: places}, up: {type: bool, initial: true}}
estimated: {mode: {type: 0..3}}
"""


def test_an_outgoing_message_is_made_of_all_variables_field_by_field(tmp_path: Path) -> None:
    station = station_with(tmp_path, ORDER, FIELDS, "places: [left, right]")
    order = station.pipelines.outgoing["/order"]
    assert set(order.variables) == {"tank.place", "tank.up", "tank.stopped"}, "the filter depends on it"
    state = {**station.automaton.initial_valuation, "tank.place": "right"}
    message = {"pose": {"position": {"x": 0.5}, "orientation": {"w": 0.25}}, "joints": [1.0, 0.3]}
    assert first_message(order, state) == message
    assert first_message(order, {**state, "tank.stopped": True}) is None
    running = RunningOutgoing(order)
    assert [running.take({**state, "tank.stopped": s}, 0.0) is None for s in (False, True, False)] == [
        False,
        True,
        False,
    ]


def test_a_device_knows_what_its_commands_mean_by_trying(tmp_path: Path) -> None:
    resource = "".join(line for line in ORDER.splitlines(True) if "ready" not in line)
    station = station_with(tmp_path, resource, FIELDS, "places: [left, right]")
    order = station.pipelines.outgoing["/order"]
    reader = CommandReader(order, station.automaton)
    type_name = order.topic.type_name
    for place in ("left", "right"):
        for up in (False, True):
            state = {**station.automaton.initial_valuation, "tank.place": place, "tank.up": up}
            message = first_message(order, state)
            assert message is not None
            heard = station.registry.decode(type_name, station.registry.encode(type_name, message))
            assert reader.read(heard) == ({"tank.place": place, "tank.up": up}, [])
    heard["joints"] = [float("inf"), 0.0]
    assert reader.read(heard) == (
        {"tank.place": None, "tank.up": True},
        ["joints is [inf, 0.0]: no command makes it so"],
    )


def test_quality_of_service_by_name_or_in_full(tmp_path: Path) -> None:
    resource = STATUS.replace("direction: in", "direction: in\n    quality: {reliability: best_effort, depth: 3}")
    station = station_with(tmp_path, resource, FIELDS)
    quality = station.pipelines.incoming["/status"].topic.quality
    assert quality == QualityOfService(reliable=False, depth=3)


@pytest.mark.parametrize(
    ("pipeline", "said"),
    [
        ("rename: {tool.lockd: locked}", "`tool` has no field `lockd`; did you mean `locked`?"),
        ("rename: {doors.x: locked}", "`doors` is bool[3], which has no fields"),
        ("rename: {'doors[3]': locked}", "`doors` has only 3 items, the first of which is [0]"),
        ("rename: {'force[0]': locked}", "`force` is real, and no list"),
        ("filter: force > 'a'", "`/status` → stage 1 `filter`: "),
        ("expression: {locked: force + 1}", "field `locked` is real, and `tank.locked` is bool: they do not"),
        ("expression: {lock: force > 1}", "`tank` has no measured variable `lock`, and no later stage reads it;"),
        ("limit: {every: 0}", "expected a number"),
    ],
)  # fmt: skip
def test_stages_that_do_not_fit_are_said_with_their_place(tmp_path: Path, pipeline: str, said: str) -> None:
    resource = f"""
topics:
  /status:
    type: tank_msgs/msg/Status
    direction: in
    pipeline: [{pipeline}]
  /other: {{type: tank_msgs/msg/Tool, direction: in}}
measured: {{locked: {{type: bool}}}}
"""
    with pytest.raises(ModelError) as refused:
        station_with(tmp_path, resource, FIELDS)
    about = [finding for finding in refused.value.findings if finding.place.line == 6]
    assert any(said in finding.message for finding in about), refused.value.findings


def test_all_findings_of_all_topics_are_said_at_once(tmp_path: Path) -> None:
    resource = """
topics:
  /status: {type: tank_msgs/msg/Status, direction: in, pipeline: [filter: forc > 1.5], ignore: [doorss]}
  /tool: {type: tank_msgs/msg/Tool, direction: in, pipeline: [rename: {lockd: is_locked}]}
  /order: {type: tank_msgs/msg/Order, direction: out, ignore: [mode], pipeline: [constant: {jointss: [0, 0]}]}
"""
    with pytest.raises(ModelError) as refused:
        station_with(tmp_path, resource, FIELDS)
    assert {finding.place.line for finding in refused.value.findings} == {3, 4, 5}
    assert len(refused.value.findings) == 4
