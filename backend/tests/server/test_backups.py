"""Backups, as an administrator makes and checks them on the page, and what the page is told of them."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest

from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.backup import archive
from sequence_planner.backup.settings import Keeping
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.db.location import mark_of
from sequence_planner.forking.starting import children
from sequence_planner.journal import audit
from sequence_planner.server.services import backups
from sequence_planner.server.settings import Settings
from support.places import CELL
from support.server import Loop, Server, settings_in
from support.waiting import until

from .test_acting import problem

BACKUPS = "/api/v1/backups"
SECONDS = 60.0  # a process begins, copies and reads again


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Where backups are kept, as somebody has said."""
    (folder := tmp_path / "kept").mkdir()
    return folder


@pytest.fixture
def settings(tmp_path: Path, folder: Path) -> Settings:
    shutil.copytree(CELL, tmp_path / "cell")
    return replace(settings_in(tmp_path), model=tmp_path / "cell", backups=Keeping(folder, kept=2))


@contextlib.contextmanager
def ada_at(server: Server) -> Iterator[httpx.Client]:
    """The browser of the administrator Ada."""
    token = server.session(server.person(Role.ADMINISTRATOR, name="Ada"))[0]
    with server.client(token=token) as client:
        client.timeout = httpx.Timeout(20)
        yield client


@pytest.fixture
def ada(lonely_server: Server) -> Iterator[httpx.Client]:
    with ada_at(lonely_server) as client:
        yield client


def there(folder: Path) -> list[str]:
    return [each.name for each in folder.iterdir()]


def shown(client: httpx.Client) -> dict[str, Any]:
    answer = client.get(BACKUPS)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def ended(client: httpx.Client) -> dict[str, Any]:
    """What is shown when nothing is done any more and the journal tells how it ended."""
    until(lambda: (now := shown(client))["busy"] is None and now["last"]["outcome"] != "requested", seconds=SECONDS)
    return shown(client)


def make(client: httpx.Client) -> dict[str, Any]:
    """Make a backup; what is shown of it."""
    answer = client.post(BACKUPS, json={})
    assert answer.status_code == 202, answer.text
    found: dict[str, Any] = next(each for each in ended(client)["backups"] if each["file"] == answer.json()["file"])
    return found


def test_one_is_made_and_checked_and_nobody_waits_for_it(
    lonely_server: Server, ada: httpx.Client, folder: Path
) -> None:
    before = shown(ada)
    assert (before["backups"], before["busy"], before["last"], before["trouble"]) == ([], None, None, None)
    assert (before["folder"], before["kept"], before["every"], before["same_disk"]) == (str(folder), 2, None, True)
    asked = [ada.post(BACKUPS, json={}) for _ in range(2)]
    longest = 0.0
    while shown(ada)["busy"] is not None:
        begun = time.monotonic()
        httpx.get(ada.base_url.join("/healthz"))
        longest = max(longest, time.monotonic() - begun)
    assert longest < 2.0
    (made,) = ended(ada)["backups"]
    assert [(each.status_code, each.json()["file"]) for each in asked] == [(202, made["file"])] * 2
    content = made["content"]
    assert (content["how"], content["by"], content["station"], content["database"]) == (
        "asked",
        "Ada",
        "cell",
        "sqlite",
    )
    assert content["model_files"] > 1
    assert (made["checked"]["whole"], made["checked"]["by"]) == (True, "Ada")
    file = folder / made["file"]
    assert (file.stat().st_size, file.stat().st_mode & 0o777) == (made["size"], 0o600)
    assert there(folder) == [file.name]  # nothing is left of what it was put together in

    answer = ada.post(f"{BACKUPS}/{file.name}/check", json={})
    assert (answer.status_code, answer.json()["doing"]) == (202, "check-backup")
    after = ended(ada)
    assert (after["last"]["doing"], after["last"]["outcome"]) == ("check-backup", "done")
    assert after["backups"][0]["checked"]["time"] > made["checked"]["time"]
    with file.open("r+b") as opened:
        opened.seek(file.stat().st_size // 2)
        opened.write(b"changed")
    ada.post(f"{BACKUPS}/{file.name}/check", json={})
    after = ended(ada)
    assert after["last"]["trouble"]["kind"] == "not-whole"
    assert after["backups"][0]["checked"]["whole"] is False
    assert "not as it was written" in after["backups"][0]["checked"]["detail"]

    with lonely_server.identity.database.reading() as connection:
        acts = [each.entry for each in audit.read(connection) if each.entry.action.endswith("-backup")]
    assert {(each.actor.name, each.subject) for each in acts} == {("Ada", file.name)}
    assert [(each.action, each.outcome) for each in reversed(acts)] == [
        ("make-backup", "requested"),
        ("make-backup", "done"),
        ("check-backup", "requested"),
        ("check-backup", "done"),
        ("check-backup", "requested"),
        ("check-backup", "failed"),
    ]


def test_what_is_asked_for_wrongly_is_refused(ada: httpx.Client, folder: Path) -> None:
    (folder / "broken.tar").write_bytes(b"no backup")
    (listed,) = shown(ada)["backups"]
    assert "is no backup" in listed["wrong"]
    assert (listed["restoring"], listed["content"]) == (None, None)
    problem(ada.post(f"{BACKUPS}/none.tar/check", json={}), 404, "no-backup")
    problem(ada.post(f"{BACKUPS}/..%2Fstation.sqlite/check", json={}), 404, "not-found")
    problem(ada.post(BACKUPS, json={"folder": "/tmp"}), 422, "invalid-request")


def test_what_is_in_the_way_is_said_with_what_to_do(ada: httpx.Client, folder: Path) -> None:
    folder.rmdir()
    assert shown(ada)["trouble"]["kind"] == "no-folder"
    answer = problem(ada.post(BACKUPS, json={}), 409, "backup-no-folder")
    assert f"There is no folder {folder}: make or mount it" in answer["detail"]
    folder.write_text("a file")
    assert "it is no folder" in shown(ada)["trouble"]["detail"]
    assert shown(ada)["backups"] == []


def test_one_is_made_without_anybody_asking_and_its_commands_restore_it_and_keep_the_keys(
    loop: Loop, settings: Settings, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(backups, "LOOK_EVERY", 0.2)
    object.__setattr__(settings, "backups", Keeping(folder, every=24))
    with contextlib.closing(Database.open(settings.database)) as database:
        database.upgrade()
    key = tmp_path / "station.sqlite-webhook-key.key"
    key.write_bytes(b"k" * 32)
    server = Server(loop, settings)
    server.start()
    with ada_at(server) as ada:
        until(lambda: len(shown(ada)["backups"]) == 1, seconds=SECONDS)
        (made,) = ended(ada)["backups"]
        assert (made["content"]["how"], made["content"]["by"]) == ("schedule", SYSTEM.name)
        server.person(name="Later")
        time.sleep(1)  # five looks
        assert [each["file"] for each in shown(ada)["backups"]] == [made["file"]]
        assert "sequence_planner_backup_time_seconds 1." in httpx.get(f"{server.address}/metrics").text
    server.stop()
    for command in (made["restoring"]["away"], made["restoring"]["restore"]):
        done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False, timeout=60)
        assert done.returncode == 0, done.stderr
    assert len([*tmp_path.glob("station.sqlite.before_*")]) == 1
    assert key.exists()
    with contextlib.closing(Database.open(settings.database, create=False)) as database, database.reading() as restored:
        assert "Later" not in [person.name for person in users.everybody(restored)]


def test_a_server_that_ends_leaves_no_process_and_no_part_of_a_backup(
    loop: Loop, settings: Settings, folder: Path
) -> None:
    server = Server(loop, settings)
    server.start()
    with ada_at(server) as ada:
        ada.post(BACKUPS, json={})
        until(lambda: any(each.name == "backup" for each in children()))
        (process,) = [each for each in children() if each.name == "backup"]
        assert process.pid is not None
        os.kill(process.pid, signal.SIGSTOP)  # so that it cannot come to its end
    server.stop()
    assert process.poll() is not None
    assert settings.model is not None
    (folder / f".{mark_of(settings.model)}-20261123T000000Z-left").mkdir()
    again = Server(loop, settings)
    again.start()
    try:
        with again.client(Role.ADMINISTRATOR) as somebody:
            assert shown(somebody)["last"]["outcome"] == "requested"
        until(lambda: there(folder) == [])
    finally:
        again.stop()


def test_without_the_program_that_copies_postgresql_the_page_says_so(
    loop: Loop, settings: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    url = request.getfixturevalue("postgresql").new_database()
    object.__setattr__(settings, "database", url)
    server = Server(loop, settings)
    server.start()
    try:
        with ada_at(server) as ada:
            made = make(ada)
            assert (made["content"]["database"], made["checked"]["whole"]) == ("postgresql", True)
            assert "not@so" not in str(shown(ada))
            assert "not%40so" not in str(shown(ada))
            monkeypatch.setattr(archive, "_INSTALLED", tmp_path)
            monkeypatch.setenv("PATH", str(tmp_path))
            assert shown(ada)["trouble"]["kind"] == "no-program"
            answer = problem(ada.post(BACKUPS, json={}), 409, "backup-no-program")
            assert "sudo apt-get install postgresql-client" in answer["detail"]
    finally:
        server.stop()
