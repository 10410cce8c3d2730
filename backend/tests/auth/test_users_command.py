"""`users` on the command line."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
import time
from pathlib import Path

import pytest

from auth.situations import PASSWORD, entries, everything_kept
from sequence_planner.auth import first_start
from sequence_planner.auth.users import find_password
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from support.commands import as_json, command
from support.places import CELL

TEMPORARY = "a fine temporary one"


@pytest.fixture
def url(tmp_path: Path) -> str:
    return f"sqlite:///{tmp_path}/state/station.sqlite"


def add(url: str, name: str, role: str = "operator") -> tuple[int, str, str]:
    return command("users", "add", name, "--role", role, "--database", url, given=f"{TEMPORARY}\n")


def test_people_are_added_and_listed(url: str) -> None:
    assert command("users", "list", "--database", url) == (0, "", "")
    assert add(url, "Eva Lind", "administrator")[:2] == (
        0,
        "Eva Lind can sign in as administrator, and has to set another password then\n",
    )
    add(url, "Adam")
    assert command("users", "list", "--database", url)[1].splitlines() == [
        "Adam      operator       has to set a password of their own",
        "Eva Lind  administrator  has to set a password of their own",
    ]
    _, told = as_json("users", "list", "--database", url)
    assert [(person["name"], person["role"]) for person in told["people"]] == [
        ("Adam", "operator"),
        ("Eva Lind", "administrator"),
    ]
    database = Database.open(url)
    (_, entry) = entries(database, "person-created")
    assert entry.actor.id == SYSTEM.id
    assert "command line of" in (entry.actor.address or "")
    assert TEMPORARY not in everything_kept(database)
    database.close()


def test_a_forgotten_password_is_set_anew(url: str) -> None:
    add(url, "Eva", "administrator")
    code, out, err = command("users", "reset", "eva", "--database", url, given=f"{PASSWORD}\n")
    assert (code, out, err) == (0, "Eva has to set another password at the next sign-in\n", "")
    database = Database.open(url)
    (entry,) = entries(database, "password-reset")
    assert (entry.actor.id, entry.subject) == (SYSTEM.id, "person Eva")
    with database.reading() as connection:
        found = find_password(connection, "Eva")
    assert found is not None
    assert found[1].startswith("$argon2id$v=19$m=12288,t=3,p=1$")
    database.close()


@pytest.mark.parametrize(
    ("arguments", "given", "told"),
    [
        (["add", "Adam", "--role", "viewer"], "short\n", "12 to 256 characters"),
        (["add", "Adam", "--role", "viewer"], "", "12 to 256 characters"),
        (["add", "\u202eAdam", "--role", "viewer"], TEMPORARY, "do not show"),
        (["add", "EVA", "--role", "viewer"], TEMPORARY, "`Eva` is there already"),
        (["add", "Adam", "--role", "king"], TEMPORARY, "king"),
        (["reset", "Adam"], TEMPORARY, "nobody of the name `Adam`"),
        (["reset", "Eva"], "short\n", "12 to 256 characters"),
        (["link"], "", "There is an administrator already"),
    ],
)
def test_what_is_refused_changes_nothing(url: str, arguments: list[str], given: str, told: str) -> None:
    add(url, "Eva", "administrator")
    before = as_json("users", "list", "--database", url)
    code, out, err = command("users", *arguments, "--database", url, given=given)
    assert (code, out) == (2, "")
    assert told in err
    assert as_json("users", "list", "--database", url) == before


def test_a_link_for_the_first_administrator(url: str) -> None:
    code, out, _ = command("users", "setup-link", "--database", url, "--url", "https://station.example/")
    address, token = out.strip().split("#")
    assert (code, address) == (0, "https://station.example/setup")
    database = Database.open(url)
    with database.reading() as connection:
        assert first_start.link_usable(connection, token, time.time())
        made = entries(database, "first-start-link")
    assert len(made) == 1
    assert token not in everything_kept(database)
    database.close()


def test_which_station(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    assert command("users", "list")[0] == 2
    assert "--database" in command("users", "list")[2]
    code, _, err = command("users", "list", tmp_path)
    assert code == 2
    assert "a station is a folder" in err
    code, _, _ = command("users", "add", "Eva", CELL, "--role", "viewer", given=TEMPORARY)
    assert code == 0
    assert "Eva" in command("users", "list", CELL)[1]
    assert command("users", "list", "--database", "nonsense")[0] == 2


@pytest.mark.parametrize(("again", "code"), [(TEMPORARY, 0), ("something else", 2)])
def test_at_a_terminal_it_asks_twice_and_shows_nothing(url: str, again: str, code: int) -> None:
    terminal, inside = pty.openpty()
    line = ["users", "add", "Eva", "--role", "viewer", "--database", url]
    with subprocess.Popen(
        [Path(sys.executable).parent / "sequence-planner", *line],
        stdin=inside,
        stdout=subprocess.PIPE,
        stderr=inside,
        start_new_session=True,
    ) as running:
        os.close(inside)
        shown = _until(terminal, b"Password for Eva: ")
        os.write(terminal, f"{TEMPORARY}\n".encode())
        shown += _until(terminal, b"The same again: ")
        os.write(terminal, f"{again}\n".encode())
        out, _ = running.communicate(timeout=30)
        assert running.returncode == code
    os.close(terminal)
    assert TEMPORARY.encode() not in shown
    assert (b"Eva can sign in" in out) is (code == 0)


def _until(terminal: int, prompt: bytes) -> bytes:
    shown = b""
    while not shown.endswith(prompt):
        shown += os.read(terminal, 1000)
    return shown


def test_the_words_of_before_are_understood_and_say_what_they_are_now(url: str) -> None:
    assert add(url, "Eva")[0] == 0
    code, out, err = command("people", "list", "--database", url)
    assert (code, out) == command("users", "list", "--database", url)[:2]
    assert (out.split()[0], err) == ("Eva", "`people` is called `users` now: the next version knows no other name\n")
    code, out, err = command("people", "link", "--database", url)
    assert (code, out.partition("#")[0]) == (0, "http://127.0.0.1:8000/setup")
    assert [line.split(" is called ")[1][:14] for line in err.splitlines()] == ["`users` now: t", "`setup-link` n"]
    shown = command("--help")[1] + command("users", "--help")[1]
    assert "setup-link" in shown
    assert "│ people " not in shown
    assert "│ link " not in shown
