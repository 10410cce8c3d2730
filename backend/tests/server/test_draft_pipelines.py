"""The pipelines of the draft over REST: seen, tried and run as they are edited, without touching what runs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from pydantic import JsonValue

from sequence_planner.controller.commands.command import CommandRefused, Query
from sequence_planner.controller.commands.queries import AskRecord
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.controller.views.part import View
from sequence_planner.controller.views.pipelines import RecordView
from sequence_planner.server.settings import Settings
from support.server import Controller, Loop
from support.waiting import until

from .test_acting import problem
from .test_model import change, eva, made, model, read, server

PIPELINES = "/api/v1/model/pipelines"
ROBOT = "resources/robot.yaml"
STATE, COMMAND = "/ur10/state", "/ur10/command"
__all__ = ["eva", "model", "server"]


def graph(client: httpx.Client) -> dict[str, Any]:
    return read(client, "/pipelines")


def asked(client: httpx.Client, what: str, **body: object) -> dict[str, Any]:
    answer = client.post(f"{PIPELINES}/{what}", json=body)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def stages(client: httpx.Client, name: str = STATE) -> list[str]:
    return [stage["kind"] for stage in graph(client)["pipelines"][name]["stages"]]


def test_the_graph_is_that_of_the_draft(eva: httpx.Client) -> None:
    found = graph(eva)
    assert {view["standing"] for view in found["pipelines"].values()} == {"good"}
    assert stages(eva) == ["discretise", "remember"]
    assert found["pipelines"][STATE]["ends"][0]["becomes"] == "robot.pose"
    assert found["types"]["real[6]"] == {
        "kind": "list",
        "values": None,
        "least": None,
        "most": None,
        "element": "real",
        "length": 6,
        "fields": None,
    }
    assert all(edge["live"]["same"] for view in found["pipelines"].values() for edge in view["edges"])


def test_a_stage_that_fits_is_put_there_and_taken_back(eva: httpx.Client, model: Path) -> None:
    before = (model / ROBOT).read_text(encoding="utf-8")
    fits = asked(eva, "suggestions", pipeline=STATE, edge=1)["stages"]
    (debounce,) = [each for each in fits if each["kind"] == "debounce"]
    preview = asked(eva, "preview", edits=debounce["edits"])
    assert (preview["refused"], preview["findings"], list(preview["pipelines"])) == (None, [], [STATE])
    assert stages(eva) == ["discretise", "remember"], "a preview changes nothing"
    changed = made(eva, *debounce["edits"], title="debounced")
    text = changed["files"][ROBOT]["text"]
    assert set(before.splitlines()) <= set(text.splitlines()), "comments and all others stay"
    assert stages(eva) == ["discretise", "debounce", "remember"]
    edges = graph(eva)["pipelines"][STATE]["edges"]
    assert [edge["live"] and (edge["live"]["edge"], edge["live"]["same"]) for edge in edges] == [
        (0, True),
        (1, True),
        None,
        (2, False),
    ]
    assert eva.post("/api/v1/model/undo", json={}).status_code == 200
    assert read(eva, "/files", path=ROBOT)["files"][ROBOT]["text"] == before


def test_a_stage_that_is_another_by_now_is_not_moved(eva: httpx.Client) -> None:
    remember = graph(eva)["pipelines"][STATE]["stages"][1]
    edit = {"kind": "move", "file": ROBOT, "path": remember["place"]["path"], "was": remember["written"], "before": 0}
    problem(change(eva, {**edit, "was": {"tick": {"every": 1}}}), 409, "part-changed")
    made(eva, edit)
    view = graph(eva)["pipelines"][STATE]
    assert view["stages"][0]["id"] == remember["id"]
    assert (view["standing"], view["stages"][0]["standing"]) == ("wrong", "wrong")
    assert "there is no field `pose` here" in view["stages"][0]["findings"][0]["message"]
    assert view["stages"][1]["standing"] == "unknown"
    problem(eva.post(f"{PIPELINES}/suggestions", json={"pipeline": STATE, "edge": 2}), 422, "edit-refused")


def test_an_example_is_written_run_and_tried(eva: httpx.Client) -> None:
    given = {"joint_positions": [0.0, -1.57, 1.57, -1.57, -1.57, 0.0], "moving": False}
    path = ["topics", STATE, "examples", 0]
    wrong = {"name": "at home", "given": given, "gives": {"pose": "bolt_pair_1"}}
    made(eva, {"kind": "add", "file": ROBOT, "path": path, "value": wrong})
    (run,) = asked(eva, "examples", pipeline=STATE)["runs"]
    assert (run["passed"], run["name"]) == (False, "at home")
    assert run["findings"][0]["message"] == "expected `pose` to be bolt_pair_1, and it is home"
    edit = {"kind": "set", "file": ROBOT, "path": [*path, "gives", "pose"], "was": "bolt_pair_1", "value": "home"}
    made(eva, edit)
    assert asked(eva, "examples", pipeline=STATE, name="at home")["runs"][0]["passed"]
    (trial,) = asked(eva, "test-runs", pipeline=STATE, steps=[{"given": given}])["runs"]
    assert [edge["last"].get("pose") for edge in trial["steps"][0]["edges"]] == [None, "home", "home"]
    problem(eva.post(f"{PIPELINES}/examples", json={"pipeline": "/none"}), 422, "edit-refused")
    problem(eva.post(f"{PIPELINES}/test-runs", json={"pipeline": STATE, "steps": []}), 422, "invalid-request")


def test_without_a_controller_nothing_is_recorded(eva: httpx.Client) -> None:
    body = {"pipeline": STATE, "name": "heard"}
    problem(eva.post(f"{PIPELINES}/recordings", json=body), 503, "controller-unavailable")


class Hearing(Controller):
    """A controller whose robot has been at home last."""

    async def answer(self, ask: Query[Any]) -> View:
        assert isinstance(ask, AskRecord)
        if ask.pipeline != STATE:
            raise CommandRefused("no-record", "Try again.", 409)
        first: dict[str, JsonValue] = {"joint_positions": [0.0, -1.57, 1.57, -1.57, -1.57, 0.0], "moving": False}
        return RecordView(first=first, last={**first, "pose": "home", "previous_pose": "bolt_pair_1"}, at=1000.0)


@pytest.fixture
def hearing(loop: Loop, settings: Settings) -> Iterator[Hearing]:
    controller = Hearing(loop, settings.controller_socket)
    controller.link = ControllerLink(settings.controller_socket, controller.handle, controller.answer)
    controller.start()
    yield controller
    controller.stop()


def test_what_the_station_has_heard_becomes_an_example(hearing: Hearing, eva: httpx.Client) -> None:
    def record(**body: str) -> httpx.Response:
        return eva.post(f"{PIPELINES}/recordings", json={"pipeline": STATE, "name": "heard", **body})

    until(lambda: record(pipeline=COMMAND).json()["type"] == "/problems/no-record")
    answer = record()
    assert answer.status_code == 201, answer.text
    made_of = answer.json()
    assert made_of["example"]["gives"] == {"pose": "home", "moving": False}
    assert made_of["left_out"] == [{"name": "previous_pose", "station": "bolt_pair_1", "draft": "home"}]
    assert (made_of["run"]["passed"], made_of["run"]["place"]["path"][-2:]) == (True, ["examples", 0])
    assert [each["name"] for each in graph(eva)["pipelines"][STATE]["examples"]] == ["heard"]
    assert read(eva)["undo"] == f"An example of {STATE}: heard"
    problem(record(), 422, "edit-refused")
