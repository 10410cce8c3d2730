"""What-if from a recording of ROS 2 traffic, over REST."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.server.recordings.shelf import MOST_KEPT
from sequence_planner.server.settings import Settings
from sequence_planner.simulation.messages import spoken
from sequence_planner.station import ReadyStation, prepare_station
from support.network import free_port
from support.places import BOLT_TIGHTENING
from support.recordings import BEGAN, NS, write_recording, zipped
from support.server import Loop, Server
from support.waiting import PATIENCE

from .test_acting import problem

MODEL = "/api/v1/model"
RECORDINGS = f"{MODEL}/recordings"
OCTETS = {"Content-Type": "application/octet-stream"}
ROBOT, SCENE = "/ur10/state", "/ur10/planning_scene/state"
LARGEST = 1  # MB


@pytest.fixture
def server(loop: Loop, settings: Settings, tmp_path: Path) -> Iterator[Server]:
    model = shutil.copytree(BOLT_TIGHTENING, tmp_path / "model")
    told = {**vars(settings), "model": model, "port": free_port(), "largest_recording": LARGEST}
    server = Server(loop, Settings(**told))  # the controller is not there, and not needed
    server.start()
    yield server
    server.stop()


@pytest.fixture
def eva(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client


@pytest.fixture(scope="module")
def station() -> ReadyStation:
    return prepare_station(BOLT_TIGHTENING)


@pytest.fixture
def drive(station: ReadyStation, tmp_path: Path) -> Path:
    """The folder of a recording in which the robot comes to above the engine after 2 s."""
    type_name = station.pipelines.incoming[ROBOT].topic.type_name
    messages = []
    for tenth in range(40):
        state = {**station.automaton.initial_valuation, "robot.pose": "home" if tenth < 20 else "above_engine"}
        data = station.registry.encode(type_name, spoken(station.pipelines, ROBOT, state, {}))
        messages.append((ROBOT, type_name, BEGAN * NS + tenth * NS // 10, data))
    write_recording(tmp_path / "drive", station.registry, messages)
    return tmp_path / "drive"


def brought(client: httpx.Client, file: Path) -> httpx.Response:
    return client.post(RECORDINGS, params={"name": file.name}, content=file.read_bytes(), headers=OCTETS)


def taken(client: httpx.Client, file: Path) -> dict[str, Any]:
    answer = brought(client, file)
    assert answer.status_code == 201, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_what_if_begins_from_a_moment_of_a_recording(eva: httpx.Client, drive: Path, tmp_path: Path) -> None:
    found = taken(eva, zipped(drive, tmp_path / "drive.zip"))
    assert (found["name"], found["began"], found["seconds"], found["messages"]) == ("drive.zip", BEGAN, 3.9, 40)
    assert [each["name"] for each in found["topics"]] == [ROBOT]
    assert SCENE in [each["name"] for each in found["missing"]]
    assert [each["at"] for each in found["moments"]] == [0.0, 2.0]
    change = {each["name"]: each for each in found["moments"][1]["changes"]}["robot.pose"]
    assert (change["before"], change["after"]) == ("home", "above_engine")

    state = eva.get(f"{RECORDINGS}/{found['id']}/state", params={"at": 2.0}).json()
    standing = {each["name"]: each["standing"] for each in state["variables"]}
    assert (standing["robot.pose"], standing["robot.tool_is_attached"]) == ("recorded", "not-recorded")

    moment = {"recording": {"id": found["id"], "at": 2.0}}
    stepped = eva.post(f"{MODEL}/what-if/steps", json=moment).json()
    assert stepped["before"] == state["values"]
    assert stepped["before"]["robot.pose"] == "above_engine"
    # What somebody knows better takes the place of what the recording and the model say.
    placed = eva.post(f"{MODEL}/what-if/steps", json={**moment, "present": {"bolts[bolt_pair_1]": "placed"}}).json()
    assert placed["before"] == {**state["values"], "bolts[bolt_pair_1]": "placed"}
    simulation = eva.post(f"{MODEL}/simulations", json=moment)
    assert simulation.status_code == 201
    assert simulation.json()["model"]["before"] == state["values"]
    space = eva.post(f"{MODEL}/what-if/state-space", json={**moment, "question": {"variables": ["robot.pose"]}}).json()
    assert [node["values"] for node in space["nodes"] if node["present"]] == [["above_engine"]]
    simulated = eva.post(f"{MODEL}/what-if", json={**moment, "seconds": 1.0})
    assert simulated.status_code == 200
    assert simulated.json()["before"] == state["values"]


def test_only_moments_after_one_are_told_when_they_are_asked_for(eva: httpx.Client, drive: Path) -> None:
    found = taken(eva, next(drive.glob("*.mcap")))
    later = eva.get(f"{RECORDINGS}/{found['id']}", params={"since": 0.0}).json()
    assert (len(later["moments"]), later["earlier"], later["later"]) == (1, 1, 0)
    beyond = eva.get(f"{RECORDINGS}/{found['id']}/state", params={"at": 100})
    assert "3.9" in problem(beyond, 422, "recording-unread")["detail"]


def test_it_is_read_with_the_draft_as_it_is(eva: httpx.Client, drive: Path) -> None:
    found = taken(eva, next(drive.glob("*.mcap")))
    was = eva.get(f"{MODEL}/files", params={"path": "resources/robot.yaml"}).json()["files"]["resources/robot.yaml"][
        "text"
    ]
    text = was.replace("above_engine: [0.6, -1.2", "above_engine: [0.7, -1.2")
    edit = {"kind": "text", "file": "resources/robot.yaml", "was": was, "text": text}
    assert eva.post(f"{MODEL}/changes", json={"title": "another pose", "edits": [edit]}).status_code == 200
    again = eva.get(f"{RECORDINGS}/{found['id']}").json()
    assert again["number"] == found["number"] + 1
    change = {each["name"]: each for each in again["moments"][1]["changes"]}["robot.pose"]
    assert change["after"] == "unknown"
    broken = {"kind": "text", "file": "resources/robot.yaml", "was": text, "text": "topics: 1"}
    assert eva.post(f"{MODEL}/changes", json={"title": "nonsense", "edits": [broken]}).status_code == 200
    unusable = eva.get(f"{RECORDINGS}/{found['id']}").json()
    assert "robot.yaml" in json.dumps(unusable["obstacle"])


def test_what_cannot_be_used_is_refused_and_not_kept(
    server: Server, eva: httpx.Client, drive: Path, tmp_path: Path, settings: Settings
) -> None:
    file = next(drive.glob("*.mcap"))
    (tmp_path / "cut.mcap").write_bytes(file.read_bytes()[:1000])
    cut = problem(brought(eva, tmp_path / "cut.mcap"), 422, "recording-unread")
    assert "cut.mcap lacks its end" in cut["detail"]
    assert "mcap recover" in cut["detail"]
    (tmp_path / "large.mcap").write_bytes(bytes(LARGEST * 1_000_000 + 1))
    large = problem(brought(eva, tmp_path / "large.mcap"), 413, "recording-too-large")
    assert "--largest-recording" in large["detail"]

    def piece_by_piece() -> Iterator[bytes]:  # without a length
        for _ in range(11):
            yield bytes(100_000)

    many = eva.post(RECORDINGS, params={"name": "large.mcap"}, content=piece_by_piece(), headers=OCTETS)
    problem(many, 413, "recording-too-large")
    unmarked = eva.post(RECORDINGS, params={"name": "a.mcap"}, json={})
    problem(unmarked, 415, "not-octets")
    with server.client(Role.OPERATOR) as otto:
        problem(brought(otto, file), 403, "role-too-low")
    assert not list((settings.controller_socket.parent / "recordings").iterdir())


def test_a_few_are_kept_and_each_can_be_put_away(eva: httpx.Client, drive: Path, settings: Settings) -> None:
    file = next(drive.glob("*.mcap"))
    ids = [taken(eva, file)["id"] for _ in range(MOST_KEPT + 1)]
    gone = eva.get(f"{RECORDINGS}/{ids[0]}")
    assert "Choose the file again" in problem(gone, 404, "no-recording")["detail"]
    assert eva.get(f"{RECORDINGS}/{ids[1]}").status_code == 200
    assert eva.delete(f"{RECORDINGS}/{ids[1]}").status_code == 204
    problem(eva.post(f"{MODEL}/what-if/steps", json={"recording": {"id": ids[1], "at": 0}}), 404, "no-recording")
    folder = settings.controller_socket.parent / "recordings"
    assert sorted(each.name for each in folder.iterdir()) == sorted(ids[2:])
