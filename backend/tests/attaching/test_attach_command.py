"""Attaching on a real network: the command, the table of topics, and the same over REST."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.journal.audit import read
from sequence_planner.model.files import read_files
from sequence_planner.station import prepare_station
from support.commands import as_json, command
from support.server import serving, settings_in

from .pressing import DOMAIN, press, station


@pytest.fixture(scope="module", autouse=True)
def _device(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with press(tmp_path_factory.mktemp("press")):
        yield


def test_a_topic_becomes_variables_in_one_step(tmp_path: Path) -> None:
    cell = station(tmp_path)
    wanted = ("attach", cell, "/press/state", "--resource", "press", "--domain", DOMAIN)
    code, out, err = command(*wanted, "--dry-run")
    assert (code, err) == (0, "")
    assert "+  /press/state:" in out
    assert not (cell / "resources" / "press.yaml").exists()
    code, answer = as_json(*wanted)
    assert (code, answer["made"], answer["direction"]) == (0, True, "in")
    assert answer["difference"] in out
    assert {finding["severity"] for finding in answer["findings"]} == {"warning"}
    assert all(finding["file"].startswith(str(cell)) for finding in answer["findings"])
    assert prepare_station(cell).pipelines.incoming["/press/state"].variables == ("press.closed", "press.mode")
    assert (cell / "messages" / "press_msgs" / "msg" / "Tool.msg").read_text().endswith("string<=8 name\n")
    assert as_json(*wanted)[1]["refused"]["slug"] == "attached"


def test_a_topic_that_others_only_read_goes_out(tmp_path: Path) -> None:
    cell = station(tmp_path)
    code, answer = as_json("attach", cell, "/press/command", "--resource", "press", "--domain", DOMAIN)
    assert (code, answer["direction"]) == (0, "out")
    assert prepare_station(cell).pipelines.outgoing["/press/command"].variables == ("press.close",)


def test_what_is_not_there_is_refused_with_what_is(tmp_path: Path) -> None:
    wanted = ("attach", station(tmp_path), "/press/stat", "--resource", "press", "--domain", DOMAIN, "--seconds", 2)
    code, _, err = command(*wanted)
    assert (code, err) == (2, "nobody has a topic /press/stat on this network; did you mean `/press/state`?\n")
    assert as_json(*wanted)[1]["refused"]["slug"] == "no-topic"


def test_a_change_that_spoils_the_model_is_not_made(tmp_path: Path) -> None:
    cell = station(tmp_path)
    arm = cell / "resources" / "arm.yaml"
    arm.write_text(arm.read_text().replace("measured:\n", "measured:\n  closed: {type: pose}\n"))
    before = arm.read_text()
    code, out, err = command("attach", cell, "/press/state", "--resource", "arm", "--domain", DOMAIN)
    assert code == 2
    assert "+  /press/state:" in out
    assert f"{arm}:" in err
    assert err.endswith("the model could not be used after this change, so it was not made\n")
    assert arm.read_text() == before


def test_the_topics_of_the_network_are_a_table_and_a_document() -> None:
    code, out, _ = command("topics", "--domain", DOMAIN)
    assert code == 0
    assert "/press/state  press_msgs/msg/PressState\n  published by  /press  (best_effort, volatile, Eclipse" in out
    assert "/press/command  press_msgs/msg/PressCommand\n  read by       /press  (reliable, volatile," in out
    code, found = as_json("topics", "--domain", DOMAIN)
    assert found["nodes"]["/press"]["publishes"] == ["/press/force", "/press/state"]
    assert found["services"]["/press/get_type_description"]["servers"] == ["/press"]


def test_the_same_is_done_over_rest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    cell = station(tmp_path)
    before = read_files(cell)
    with serving(replace(settings_in(tmp_path), model=cell, transport="cyclonedds")) as server:
        with server.client(Role.ENGINEER) as client:
            client.timeout = httpx.Timeout(60)
            body = {"topic": "/press/state", "resource": "press"}
            answer = client.post("/api/v1/ros/attachments", json=body).json()
            assert (answer["made"], answer["direction"]) == (True, "in")
            assert "+  /press/state:" in answer["difference"]
            assert "+++ resources/press.yaml" in answer["difference"]
            assert {finding["severity"] for finding in answer["findings"]} == {"warning"}
            draft = client.get("/api/v1/model").json()
            assert (draft["number"], draft["undo"]) == (answer["number"], "/press/state belongs to press")
            assert draft["files"]["resources/press.yaml"]["state"] == "new"
            graph = client.get("/api/v1/model/pipelines").json()["pipelines"]["/press/state"]
            assert (graph["standing"], graph["message"]) == ("good", "press_msgs/msg/PressState")
            assert (graph["quality"]["reliable"], graph["resource"]) == (False, "press")
            again = client.post("/api/v1/ros/attachments", json=body | {"dry_run": True})
            assert (again.status_code, again.json()["type"]) == (409, "/problems/attached")
            assert client.post("/api/v1/model/undo", json={}).status_code == 200
            assert "resources/press.yaml" not in client.get("/api/v1/model").json()["files"]
        with server.identity.database.reading() as connection:
            done, asked = read(connection, action="attach-topic")
        assert (asked.entry.outcome, done.entry.outcome, done.entry.about) == ("requested", "done", asked.number)
    assert read_files(cell) == before  # the station itself is not touched
