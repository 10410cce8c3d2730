"""The example stations over REST: looked at as the draft is, never changed, and begun with."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.model.examples.library import example_files, station_name
from sequence_planner.server.settings import Settings
from support.network import free_port
from support.places import MODELS
from support.server import Loop, Server, listen
from support.waiting import PATIENCE, until

from .test_acting import problem
from .test_model import MODEL, TITLE, adam, change, eva, made, model, read, server

__all__ = ["adam", "eva", "model", "server"]

EXAMPLES = "/api/v1/examples"
SMALL = "single_bolt"
ROBOTS = "robots_with_buffer"


@pytest.fixture
def bare(loop: Loop, settings: Settings, tmp_path: Path) -> Iterator[httpx.Client]:
    """An engineer at a station with nothing but its name."""
    (tmp_path / "bare").mkdir()
    (tmp_path / "bare" / "station.yaml").write_text("name: north_gate\n", encoding="utf-8")
    of_bare = Server(loop, Settings(**{**vars(settings), "model": tmp_path / "bare", "port": free_port()}))
    of_bare.start()
    with of_bare.client(Role.ENGINEER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client
    of_bare.stop()


def begin(client: httpx.Client, example: str, number: int, title: str = "Begun with it") -> httpx.Response:
    return client.post(f"{MODEL}/begin", json={"example": example, "number": number, "title": title})


def texts(client: httpx.Client, **question: object) -> dict[str, str]:
    return {path: file["text"] for path, file in read(client, "/files", **question)["files"].items()}


def test_all_models_of_the_repository_are_listed_with_what_they_are(eva: httpx.Client) -> None:
    answer = eva.get(EXAMPLES)
    assert answer.status_code == 200, answer.text
    found: dict[str, dict[str, Any]] = {each["name"]: each for each in answer.json()["examples"]}
    assert list(found) == sorted(path.parent.name for path in MODELS.glob("*/station.yaml"))
    assert found["bolt_tightening"]["title"] == {"en": "Bolt tightening station", "sv": "Station för skruvdragning"}
    assert found[SMALL]["description"].startswith("An operator places a bolt")
    # As they are written: an ability with parameters is one. Both robots have those of their type.
    assert [found[ROBOTS][each] for each in ("resources", "abilities", "operations")] == [2, 8, 2]


def test_where_there_are_none_the_list_is_empty_and_no_name_is_known(
    loop: Loop, settings: Settings, model: Path, tmp_path: Path
) -> None:
    nowhere = Settings(**{**vars(settings), "model": model, "port": free_port(), "examples": tmp_path / "nowhere"})
    without = Server(loop, nowhere)
    without.start()
    try:
        with without.client(Role.ENGINEER) as client:
            client.timeout = httpx.Timeout(PATIENCE)
            assert client.get(EXAMPLES).json() == {"examples": []}
            problem(client.get(MODEL, params={"example": SMALL}), 404, "no-example")
            problem(begin(client, SMALL, read(client)["number"]), 404, "no-example")
    finally:
        without.stop()


def test_an_example_is_read_as_the_draft_is(eva: httpx.Client) -> None:
    own = read(eva)
    shown = read(eva, example=ROBOTS)
    assert (shown["number"], shown["changes"], shown["undo"]) == (1, [], None)
    assert {mark["state"] for mark in shown["files"].values()} == {"same"}
    assert texts(eva, example=ROBOTS) == example_files(MODELS / ROBOTS)
    assert [*texts(eva, example=ROBOTS, path="types/robot.yaml")] == ["types/robot.yaml"]
    usages = read(eva, "/usages", example=ROBOTS, part="variable:parts_on_buffer")["usages"]
    assert {each["file"] for each in usages} >= {"station.yaml", "operations.yaml"}
    assert {thing["id"] for thing in read(eva, "/graph", example=ROBOTS)["things"]} >= {"variable:parts_on_buffer"}
    assert len(read(eva, "/operations", example=ROBOTS)["operations"]) == 2
    assert read(eva, "/mimic", example=ROBOTS)["titles"] == {"robot_1": "Robot 1", "robot_2": "Robot 2"}
    assert set(read(eva, "/pipelines", example=ROBOTS)["pipelines"]) >= {"/robot_1/state", "/robot_2/state"}
    assert read(eva, "/folds", example=ROBOTS)["number"] == 1
    assert read(eva) == own  # nothing of it is in the draft


def test_what_is_asked_about_a_text_of_an_example_is_answered_with_its_names(eva: httpx.Client) -> None:
    text = {"file": "station.yaml", "path": ["rest"], "text": "robot_1.at == infeed"}
    for question, is_wrong in (({"example": ROBOTS}, False), ({}, True)):
        answer = eva.post(f"{MODEL}/language/check", params=question, json=text)
        assert answer.status_code == 200, answer.text
        assert bool(answer.json()["problems"]) == is_wrong


def test_examples_of_pipelines_are_run(eva: httpx.Client) -> None:
    answer = eva.post(f"{MODEL}/pipelines/examples", params={"example": SMALL}, json={"pipeline": "/robot/state"})
    assert answer.status_code == 200, answer.text
    assert answer.json()["obstacle"] is None


def test_an_example_is_checked_and_told_by_a_stream_of_its_own(server: Server, eva: httpx.Client) -> None:
    address = f"ws://127.0.0.1:{server.settings.port}{MODEL}/stream?example={SMALL}"
    with listen(server, address) as stream:
        while True:
            told = json.loads(stream.recv(PATIENCE))["workshop"]
            if told["check"]["state"] == "done":
                break
    assert (told["number"], told["changes"], told["last"]) == (1, 0, None)
    assert told["check"]["summary"]["title"] == "A single bolt"
    assert [each for each in told["check"]["findings"] if each["severity"] == "error"] == []
    assert read(eva, "/check", example=SMALL)["state"] == "done"


def test_an_unknown_example_is_refused(eva: httpx.Client) -> None:
    for address in ("", "/files", "/check", "/graph", "/operations", "/mimic", "/folds", "/pipelines"):
        problem(eva.get(f"{MODEL}{address}", params={"example": "nowhere"}), 404, "no-example")


@pytest.mark.parametrize("name", ["../models/single_bolt", "/etc", "single_bolt/../single_bolt", ".", "station.yaml"])
def test_a_path_is_no_name_of_an_example(eva: httpx.Client, name: str) -> None:
    problem(eva.get(f"{MODEL}/files", params={"example": name}), 422, "invalid-request")
    problem(begin(eva, name, read(eva)["number"]), 404, "no-example")


def test_nothing_is_changed_simulated_or_recorded_in_an_example(eva: httpx.Client) -> None:
    before = read(eva)
    edit = {"title": "an edit", "edits": [TITLE]}
    asked: list[tuple[str, str, dict[str, Any]]] = [
        ("POST", "/changes", edit),
        ("POST", "/undo", {}),
        ("POST", "/redo", {}),
        ("POST", "/rename", {"part": "variable:robot.pose", "name": "place"}),
        ("POST", "/begin", {"example": SMALL, "number": before["number"], "title": "x"}),
        ("POST", "/revisions", {"number": before["number"], "name": "one"}),
        ("POST", "/simulations", {}),
        ("POST", "/scenarios/run", {}),
        ("GET", "/scenarios", {}),
        ("POST", "/comments", {"text": "well"}),
        ("POST", "/pipelines/recordings", {"pipeline": "/robot/state", "name": "one"}),
    ]
    for method, address, body in asked:
        answer = eva.request(method, f"{MODEL}{address}", params={"example": SMALL}, json=body)
        assert answer.status_code == 409, (address, answer.text)
        problem(answer, 409, "example-unchanged")
    assert read(eva) == before


def test_a_draft_begins_with_an_example_under_its_own_name_and_undo_takes_it_back(bare: httpx.Client) -> None:
    before = texts(bare)
    answer = begin(bare, SMALL, read(bare)["number"], "Begun with “A single bolt”")
    assert answer.status_code == 200, answer.text
    after = texts(bare)
    example = example_files(MODELS / SMALL)
    assert after.keys() == example.keys()
    assert {path for path in after if after[path] != example[path]} == {"station.yaml"}
    assert station_name(after) == "north_gate"
    assert after["station.yaml"] == example["station.yaml"].replace("name: single_bolt", "name: north_gate")
    shown = read(bare)
    assert (shown["changes"][0]["title"], shown["undo"]) == ("Begun with “A single bolt”",) * 2
    assert bare.post(f"{MODEL}/undo", json={}).status_code == 200
    assert texts(bare) == before
    assert bare.post(f"{MODEL}/redo", json={}).status_code == 200
    assert texts(bare) == after


def test_what_was_in_the_draft_goes_and_comes_back(eva: httpx.Client) -> None:
    made(eva, TITLE)
    before = texts(eva)
    assert begin(eva, SMALL, read(eva)["number"]).status_code == 200
    after = texts(eva)
    assert "resources/engine.yaml" not in after
    assert station_name(after) == "bolt_tightening"
    until(lambda: read(eva, "/check")["state"] == "done")
    assert [each for each in read(eva, "/check")["findings"] if each["severity"] == "error"] == []
    assert eva.post(f"{MODEL}/undo", json={}).status_code == 200
    assert texts(eva) == before


def test_a_draft_that_cannot_be_read_takes_the_name_of_the_example(bare: httpx.Client) -> None:
    broken = {"kind": "text", "file": "station.yaml", "was": "name: north_gate\n", "text": "name: [\n"}
    made(bare, broken)
    assert begin(bare, SMALL, read(bare)["number"]).status_code == 200
    assert station_name(texts(bare)) == SMALL


def test_nothing_that_was_written_meanwhile_is_replaced_unseen(eva: httpx.Client, adam: httpx.Client) -> None:
    number = read(eva)["number"]
    assert change(adam, TITLE).status_code == 200
    before = texts(eva)
    problem(begin(eva, SMALL, number), 409, "stale-draft")
    assert texts(eva) == before


def test_who_only_looks_does_not_begin(server: Server) -> None:
    with server.client(Role.VIEWER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        assert client.get(EXAMPLES).status_code == 200
        assert read(client, example=SMALL)["number"] == 1
        problem(begin(client, SMALL, 1), 403, "role-too-low")
