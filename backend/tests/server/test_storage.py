"""What is kept and archived, as an administrator sees it and has it done, and as others read what was cut."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest

from journal.happened import happened
from sequence_planner.auth.roles import Role
from sequence_planner.journal import audit
from sequence_planner.mes import events
from sequence_planner.mes.events import EventKind
from sequence_planner.retention.settings import Retention
from sequence_planner.server.settings import Settings
from support.places import CELL
from support.server import Server, settings_in
from support.waiting import until

from .test_acting import problem
from .test_backups import ada_at

STORAGE = "/api/v1/storage"
SECONDS = 60.0


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (folder := tmp_path / "archive").mkdir()
    return folder


@pytest.fixture
def settings(tmp_path: Path, folder: Path) -> Settings:
    shutil.copytree(CELL, tmp_path / "cell")
    return replace(settings_in(tmp_path), model=tmp_path / "cell", retention=Retention(folder=folder, order_days=8.0))


@pytest.fixture
def ada(lonely_server: Server) -> Iterator[httpx.Client]:
    happened(lonely_server.identity.database, range(1, 96))  # in 1970
    with lonely_server.identity.database.writing() as connection:
        for _ in range(3):
            events.append(connection, EventKind.MODE_CHANGED, None, 1.0, {})
    with ada_at(lonely_server) as client:
        yield client


def shown(client: httpx.Client) -> dict[str, Any]:
    answer = client.get(STORAGE)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def archive(client: httpx.Client) -> dict[str, Any]:
    """Have what is old archived; what is shown then."""
    answer = client.post(f"{STORAGE}/archive", json={})
    assert (answer.status_code, answer.json()) == (202, {"by": "Ada"})
    until(lambda: shown(client)["busy"] is None, seconds=SECONDS)
    return shown(client)


def test_what_is_old_is_archived_and_read_as_before(lonely_server: Server, ada: httpx.Client, folder: Path) -> None:
    before = shown(ada)
    assert (before["database"]["first"], before["archived"], before["files"]) == (1, None, [])
    assert before["settings"]["folder"] == str(folder)
    history = ada.get("/api/v1/history", params={"limit": 50}).json()
    exported = ada.get("/api/v1/history/export").text
    moments = [ada.get("/api/v1/history/at", params={"time": each}).json() for each in (0, 20, 88.5, 93)]

    after = archive(ada)
    assert (after["trouble"], after["last"]["records"], after["last"]["orders"]) == (None, 89, 3)
    assert (after["database"]["first"], after["archived"]["first"], after["archived"]["last"]) == (90, 1, 89)
    assert sorted(each["file"] for each in after["files"]) == sorted(each.name for each in folder.iterdir())
    assert after["sizes"]["archive"] == sum(each.stat().st_size for each in folder.iterdir())
    with lonely_server.identity.database.reading() as connection:
        acts = [each.entry for each in audit.read(connection) if each.entry.actor.name == "Ada"]
    assert {each.action for each in acts} >= {"journal-trimmed", "job-orders-cut"}

    assert ada.get("/api/v1/history", params={"limit": 50}).json() == history
    assert ada.get("/api/v1/history/export").text == exported
    assert [ada.get("/api/v1/history/at", params={"time": each}).json() for each in (0, 20, 88.5, 93)] == moments
    older = ada.get("/api/v1/history", params={"before": 11, "limit": 5, "kinds": "snapshot,ticked"}).json()
    assert [each["number"] for each in older["records"]] == [10, 9, 8, 7, 6]
    figures = ada.get("/metrics").text
    assert f'sequence_planner_storage_bytes{{of="archive"}} {float(after["sizes"]["archive"])}' in figures
    assert "sequence_planner_retention_in_trouble 0.0" in figures


def test_a_cursor_that_is_too_old_is_told_what_to_do(lonely_server: Server, ada: httpx.Client) -> None:
    archive(ada)
    found = problem(ada.get("/api/v1/events", params={"after": 2}), 410, "events-gone")
    assert found["detail"].endswith("Read the orders and their responses anew, and the events after 3.")
    assert ada.get("/api/v1/events", params={"after": 3}).json() == {"events": [], "next": 3}
    assert ada.get("/api/v1/events").json() == {"events": [], "next": 3}


def test_a_file_that_is_gone_is_said_wherever_it_is_needed(ada: httpx.Client, folder: Path) -> None:
    archive(ada)
    file = next(each for each in folder.iterdir() if each.name.startswith("run-"))
    file.unlink()
    after = shown(ada)
    assert after["missing"] == 1
    assert [each["file"] for each in after["files"] if each["missing"]] == [file.name]
    found = problem(ada.get("/api/v1/history", params={"before": 50}), 409, "archive-unreadable")
    assert str(file) in found["detail"]
    assert ada.get("/api/v1/history", params={"limit": 3}).status_code == 200, "what is in the database is told"


def test_what_is_in_the_way_is_told_and_nothing_is_cut(ada: httpx.Client, folder: Path) -> None:
    folder.rmdir()
    after = archive(ada)
    assert after["trouble"].startswith(f"there is no folder {folder}: make or mount it")
    assert after["database"]["first"] == 1
    folder.mkdir()
    assert archive(ada)["trouble"] is None


def test_only_administrators_see_it(lonely_server: Server, ada: httpx.Client) -> None:
    token = lonely_server.session(lonely_server.person(Role.ENGINEER, name="Erik"))[0]
    with lonely_server.client(token=token) as erik:
        assert erik.get(STORAGE).status_code == 403
        assert erik.post(f"{STORAGE}/archive", json={}).status_code == 403
