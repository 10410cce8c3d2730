"""What an engineer does is done in another process than what stops the station."""

from __future__ import annotations

import os
import shutil
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.execution import SetMode
from sequence_planner.editor import draft, merging, revisions
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.forking.starting import children
from sequence_planner.model.yaml import reader
from sequence_planner.server.settings import Settings
from support.places import BOLT_TIGHTENING
from support.server import Controller, Loop, Server
from support.waiting import PATIENCE, until

from .test_acting import problem
from .test_model import MODEL, TITLE, change, checked, made, read, save

MANY = "resources/many.yaml"
VARIABLES = "estimated:\n" + "".join(f"  v{number}: {{type: bool, initial: false}}\n" for number in range(20_000))
BOMB = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 10)}]\n" for before, name in zip("abcdef", "bcdefg", strict=True)
)


@pytest.fixture
def server(controller: Controller, loop: Loop, settings: Settings, tmp_path: Path) -> Iterator[Server]:
    model = shutil.copytree(BOLT_TIGHTENING, tmp_path / "model")
    server = Server(loop, Settings(**{**vars(settings), "model": model}))
    server.start()
    server.hear_controller()
    yield server
    server.stop()


@pytest.fixture
def eva(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.timeout = httpx.Timeout(PATIENCE)
        yield client


def written(text: str, file: str = MANY) -> dict[str, Any]:
    return {"kind": "text", "file": file, "was": None, "text": text}


def called(name: str) -> list[int]:
    """The ids of the processes with names that end so."""
    return [each.pid for each in children() if each.name.endswith(name) and each.pid]


@contextmanager
def standing_still(name: str) -> Iterator[None]:
    """While the process of the workshop that is called so does nothing; those of servers before take time to end."""
    until(lambda: len(called(name)) == 1)
    [pid] = called(name)
    os.kill(pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(pid, signal.SIGCONT)


@pytest.mark.parametrize(
    "edit",
    [
        written(VARIABLES),
        written(BOMB),
        {"kind": "add", "file": MANY, "path": ["estimated"], "value": {f"v{number}": 1 for number in range(2000)}},
    ],
    ids=["20 000 variables", "an alias bomb", "a large value"],
)
def test_the_station_is_held_while_an_edit_takes_as_long_as_it_likes(
    server: Server, controller: Controller, client: httpx.Client, eva: httpx.Client, edit: dict[str, Any]
) -> None:
    made(eva, TITLE)  # its process has begun
    answers: list[httpx.Response] = []
    with standing_still("editing_worker"):
        editing = threading.Thread(target=lambda: answers.append(change(eva, edit)))
        editing.start()
        editing.join(1)
        for mode in ("hold", "paused", "hold"):
            assert client.put("/api/v1/mode", json={"mode": mode}).status_code == 204
        assert [each.mode for each in controller.commands if isinstance(each, SetMode)] == [
            Mode.HOLD,
            Mode.PAUSED,
            Mode.HOLD,
        ]
        assert not answers
    editing.join(PATIENCE)
    [answer] = answers
    assert answer.status_code == 200, answer.text


def test_the_servers_process_reads_no_model(server: Server, eva: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever an engineer does: the functions that cost time are there in other processes only."""

    def never(*_: object) -> None:
        raise AssertionError("this is for another process")

    eva.get(MODEL)
    for module, name in (
        (reader, "compose"),
        (draft, "applied"),
        (draft, "merged"),
        (merging, "merged"),
        (revisions, "tree_of"),
        (revisions.Revisions, "all"),
    ):
        monkeypatch.setattr(module, name, never)
    made(eva, TITLE)
    number = made(eva, written("title: Many\n"))["number"]
    assert eva.post(f"{MODEL}/undo", json={}).status_code == 200
    assert eva.post(f"{MODEL}/redo", json={}).status_code == 200
    assert eva.post(f"{MODEL}/rename", json={"part": "variable:bolts", "name": "pairs"}).status_code == 200
    assert eva.post(f"{MODEL}/undo", json={}).status_code == 200
    for address in ("", "/files", "/check", "/graph", "/pipelines", "/revisions", "/comparison?old=running"):
        assert eva.get(f"{MODEL}{address}").status_code == 200
    assert read(eva, "/usages", part="variable:bolts")["usages"]
    checked(eva)
    saved = save(eva, "One", read(eva)["number"])
    assert saved.status_code == 201
    restored = eva.post(f"{MODEL}/revisions/{saved.json()['id']}/restore", json={"number": read(eva)["number"]})
    assert restored.status_code == 200
    assert number < read(eva)["number"]
    place = {"file": "specifications.yaml", "path": ["x", "always"], "text": "tr", "offset": 2}
    assert eva.post(f"{MODEL}/language/completion", json=place).status_code == 200
    preview = eva.post(
        f"{MODEL}/pipelines/preview", json={"edits": [written("title: Other\n", "resources/other.yaml")]}
    )
    assert preview.status_code == 200


@pytest.mark.parametrize("address", ["/changes", "/pipelines/preview"])
@pytest.mark.parametrize(
    ("body", "status", "type_"),
    [
        (b"", 422, "invalid-request"),
        (b"{", 400, "malformed-json"),
        (b'{"edits": ["\xff"]}', 400, "malformed-json"),
        (b"[" * 100_000, 400, "malformed-json"),
        (b"[]", 422, "invalid-request"),
        (b'{"title": "x", "edits": [], "more": 1}', 422, "invalid-request"),
    ],
)
def test_a_body_that_is_not_as_expected_is_refused_where_it_is_read(
    eva: httpx.Client, address: str, body: bytes, status: int, type_: str
) -> None:
    answer = eva.post(f"{MODEL}{address}", content=body, headers={"Content-Type": "application/json"})
    problem(answer, status, type_)
    if status == 422:
        assert all(each["field"].split(".")[0] == "body" for each in answer.json()["errors"])


def test_of_very_many_findings_the_first_are_shown(eva: httpx.Client) -> None:
    wrong = "".join(f"  v{number}: {{type: nothing}}\n" for number in range(700))
    made(eva, written(f"title: Many\nmeasured:\n{wrong}"))
    found = checked(eva)["findings"]
    assert len(found) == 501
    assert found[-1]["kind"] == "more"
    assert found[-1]["severity"] == "error"
    assert "more findings are not shown" in found[-1]["message"]
