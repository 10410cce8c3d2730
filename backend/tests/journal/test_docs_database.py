"""What the page about the database shows is tried."""

from __future__ import annotations

import re
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import make_url, text
from sqlalchemy.exc import IntegrityError

from journal.acts import EVA, act, filled
from sequence_planner.db.database import Database
from sequence_planner.db.location import SqliteFile
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry, Outcome
from support.commands import command
from support.places import DOCS
from support.postgresql import PASSWORD, USER, Server, binaries

TEXT = (DOCS / "database.md").read_text(encoding="utf-8")
SHIFT_BEGINS = 1772431092.25  # 2026-03-02 05:58:12.25 UTC


def _shown(label: str) -> str:
    [block] = re.findall(rf"^```{label}\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
    return str(block)


@pytest.fixture
def sqlite(tmp_path: Path) -> Iterator[Database]:
    database = Database.open(f"sqlite:///{tmp_path}/press/station.sqlite")
    database.upgrade()
    yield database
    database.close()


def test_the_lines(sqlite: Database) -> None:
    eva = EVA.model_copy(update={"address": "10.0.0.21"})
    mode = Entry(
        actor=eva,
        action="set-mode",
        subject="station",
        details={"mode": "automatic"},
        reason="Early shift",
        outcome=Outcome.REQUESTED,
    )
    with sqlite.writing() as connection:
        audit.append(connection, Entry(actor=eva, action="sign-in", subject=f"person {eva.name}"), SHIFT_BEGINS)
        asked = audit.append(connection, mode, SHIFT_BEGINS + 28.25)
        done = mode.model_copy(update={"outcome": Outcome.DONE, "about": asked.number})
        audit.append(connection, done, SHIFT_BEGINS + 28.5)
    assert command("journal", "--database", f"sqlite:///{sqlite.place}")[1] == _shown("text")


def test_the_program_that_verifies_an_export(sqlite: Database) -> None:
    records = filled(sqlite, 5)
    lines = command("journal", "--database", f"sqlite:///{sqlite.place}", "--jsonl")[1]
    assert _verify(lines) == (0, f"{records[4].hash}\n", "")
    assert _verify(lines.replace("task 3", "task 4")) == (1, "", "line 4 is not as it was written\n")
    assert _verify("".join(lines.splitlines(keepends=True)[1:])) == (1, "", "line 1 is not as it was written\n")
    assert _verify("".join(lines.splitlines(keepends=True)[::2])) == (1, "", "line 2 is not as it was written\n")


def _verify(lines: str) -> tuple[int, str, str]:
    program = [sys.executable, "-c", _shown("python verify.py")]
    done = subprocess.run(program, input=lines, capture_output=True, encoding="utf-8", check=False, timeout=60)
    return done.returncode, done.stdout, done.stderr


def test_a_copy_of_sqlite_while_it_is_written_to(sqlite: Database, tmp_path: Path) -> None:
    filled(sqlite, 5)
    assert isinstance(sqlite.place, SqliteFile)
    [statement] = re.findall(r'^sqlite3 \S+ "(.*)"$', TEXT, re.MULTILINE)
    copy = tmp_path / "copy.sqlite"
    with sqlite.writing() as connection, closing(sqlite3.connect(sqlite.place.path)) as other:
        audit.append(connection, act(6), 6.0)
        other.execute(statement.replace("copy.sqlite", str(copy)))
    code, out, err = command("journal", "--database", f"sqlite:///{copy}", "--verify")
    assert (code, err) == (0, "")
    assert out.startswith("who did what: 5 records, all as they were written; ")
    _is_guarded(f"sqlite:///{copy}")


def test_a_copy_of_postgresql(postgresql: Server, tmp_path: Path) -> None:
    programs = binaries()
    assert programs is not None
    url, place = postgresql.new_database(), postgresql.new_database()
    database = Database.open(url)
    database.upgrade()
    filled(database, 5)
    database.close()
    copy = tmp_path / "press.dump"
    environment = {"PGHOST": str(postgresql.folder), "PGUSER": USER, "PGPASSWORD": PASSWORD}
    dump = ["pg_dump", "--format=custom", f"--file={copy}", _name(url)]
    restore = ["pg_restore", f"--dbname={_name(place)}", str(copy)]
    for name, *arguments in (dump, restore):
        subprocess.run([programs / name, *arguments], env=environment, check=True, timeout=60)
    assert command("journal", "--database", place, "--verify")[1].startswith(
        "who did what: 5 records, all as they were written; "
    )
    _is_guarded(place)


def _name(url: str) -> str:
    name = make_url(url).database
    assert name is not None
    return name


def _is_guarded(url: str) -> None:
    with closing(Database.open(url)) as database:
        database.upgrade()
        with database.writing() as connection, pytest.raises(IntegrityError, match="only ever added to"):
            connection.execute(text("DELETE FROM audit"))
