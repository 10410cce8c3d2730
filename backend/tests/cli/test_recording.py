"""`sequence-planner recording`: what a recording has for a station, and a state for other commands."""

from __future__ import annotations

import json
from pathlib import Path

from sequence_planner.simulation.messages import spoken
from sequence_planner.station import prepare_station
from support.commands import as_json, command
from support.places import BOLT_TIGHTENING
from support.recordings import BEGAN, NS, write_recording

ROBOT = "/ur10/state"


def drive(folder: Path) -> Path:
    """The robot is at home for 2 s, then above the engine."""
    station = prepare_station(BOLT_TIGHTENING)
    type_name = station.pipelines.incoming[ROBOT].topic.type_name
    messages = []
    for tenth in range(40):
        state = {**station.automaton.initial_valuation, "robot.pose": "home" if tenth < 20 else "above_engine"}
        data = station.registry.encode(type_name, spoken(station.pipelines, ROBOT, state, {}))
        messages.append((ROBOT, type_name, BEGAN * NS + tenth * NS // 10, data))
    write_recording(folder, station.registry, messages)
    return folder


def test_it_says_what_a_recording_has_and_lacks(tmp_path: Path) -> None:
    folder = drive(tmp_path / "drive")
    code, out, err = command("recording", BOLT_TIGHTENING, folder)
    assert (code, err) == (1, "")  # topics are missing
    assert f"{ROBOT}  40 messages" in out
    assert "/ur10/planning_scene/state  not recorded" in out
    assert "2.000  robot.pose := above_engine, robot.previous_pose := above_engine" in out
    _, told = as_json("recording", BOLT_TIGHTENING, folder)
    assert [each["at"] for each in told["moments"]] == [0.0, 2.0]


def test_the_state_at_a_moment_is_read_by_other_commands(tmp_path: Path) -> None:
    folder = drive(tmp_path / "drive")
    code, out, _ = command("recording", BOLT_TIGHTENING, folder, "--at", 2.5)
    assert code == 0
    assert "robot.pose == above_engine\n" in out
    assert "robot.tool_is_attached == false  (not recorded)" in out
    _, state = as_json("recording", BOLT_TIGHTENING, folder, "--at", 2.5)
    assert state["state"]["robot.pose"] == "above_engine"
    _, after = as_json("tick", BOLT_TIGHTENING, "--state", "-", given=json.dumps(state))
    assert after["state"]["robot.pose"] == "above_engine"


def test_what_cannot_be_read_is_refused_with_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "note.mcap").write_text("hello")
    code, _, err = command("recording", BOLT_TIGHTENING, tmp_path / "note.mcap")
    assert code == 2
    assert "note.mcap is no recording: choose" in err
    code, _, err = command("recording", BOLT_TIGHTENING, drive(tmp_path / "drive"), "--at", 9)
    assert code == 2
    assert "from 0 to 3.9 s" in err
