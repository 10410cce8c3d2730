"""`journal`: the record of who did what, for people and for programs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from sqlalchemy import text

from journal.acts import EVA, filled
from sequence_planner.core.storage_error import DATABASE
from sequence_planner.db.database import Database
from sequence_planner.db.location import default_url
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry, Outcome
from support.commands import command
from support.postgresql import PASSWORD


def test_lines_for_people_the_newest_last(database: Database, database_url: str) -> None:
    filled(database, 5)
    code, out, err = command("journal", "--database", database_url, "--limit", 2)
    assert (code, err) == (0, "")
    assert out == (
        '4  1970-01-01 00:00:04.000 UTC  Eva Åkesson (127.0.0.1)  acknowledge  task 3  done  "Bolts placed"\n'
        '5  1970-01-01 00:00:05.000 UTC  Sequence Planner  set-mode  done  {"mode": "automatic", "share": 0.2}\n'
    )
    _, out, _ = command("journal", "--database", database_url, "--action", "acknowledge")
    assert [line.split()[0] for line in out.splitlines()] == ["2", "4"]


def test_outcomes_and_what_would_steer_a_terminal(database: Database, database_url: str) -> None:
    actor = EVA.model_copy(update={"name": "\x1b[2J\x9b31m\nEva\u202e"})
    with database.writing() as connection:
        audit.append(connection, Entry(actor=actor, action="sign-in", outcome=Outcome.REFUSED, about=7), 0.0)
    _, out, _ = command("journal", "--database", database_url)
    said = r"\x1b[2J\x9b31m\nEva\u202e (127.0.0.1)"
    assert out == f"1  1970-01-01 00:00:00.000 UTC  {said}  sign-in  refused (7)\n"


def test_a_station_is_named_by_its_folder(tmp_path: Path) -> None:
    url = default_url(tmp_path)
    code, out, err = command("journal", tmp_path)
    assert (code, out) == (2, "")
    assert "is not there: no station has kept its database there yet" in err
    database = Database.open(url)
    assert "has no tables yet" in command("journal", tmp_path)[2]
    database.upgrade()
    assert command("journal", tmp_path) == (0, "", "")
    assert command("journal", tmp_path, "--verify") == (0, "nobody did anything yet\nnothing happened yet\n", "")
    filled(database, 1)
    database.close()
    assert command("journal", tmp_path)[1].startswith("1  1970-01-01")


def test_verifying(database: Database, database_url: str) -> None:
    records = filled(database, 4)
    code, out, _ = command("journal", "--database", database_url, "--verify")
    said = f"who did what: 4 records, all as they were written; the hash of the last one is {records[3].hash}\n"
    assert (code, out) == (0, f"{said}nothing happened yet\n")
    with database.writing() as connection:
        sqlite = connection.dialect.name == "sqlite"
        off = "DROP TRIGGER audit_no_delete" if sqlite else "ALTER TABLE audit DISABLE TRIGGER ALL"
        connection.execute(text(off))
        connection.execute(text("DELETE FROM audit WHERE number = 2"))
    code, out, _ = command("journal", "--database", database_url, "--verify")
    assert (code, out) == (1, "record 2 of who did what is missing, or is not as it was written\n")


def test_all_of_it_as_json_lines(database: Database, database_url: str) -> None:
    for start in range(0, 2500, 500):
        with database.writing() as connection:
            for number in range(start, start + 500):
                audit.append(connection, Entry(actor=EVA, action="try", details={"number": number}), number / 7)
    code, out, err = command("journal", "--database", database_url, "--jsonl")
    assert (code, err) == (0, "")
    documents = [json.loads(line) for line in out.splitlines()]
    assert [document["number"] for document in documents] == list(range(1, 2501))
    assert [document["time"] for document in documents] == [number / 7 for number in range(2500)]
    assert {*documents[0]} == {"number", "time", "entry", "hash"}
    assert Entry.model_validate(documents[9]["entry"]).details == {"number": 9}


def test_the_url_may_come_from_the_environment(database: Database, database_url: str) -> None:
    filled(database, 1)
    done = subprocess.run(
        [sys.executable, "-m", "sequence_planner.cli", "journal"],
        env={**os.environ, DATABASE: database_url},
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert done.stdout.startswith("1  1970-01-01")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "say whose journal"),
        (["--database", "nothing"], "the database's URL cannot be read"),
        (["--database", f"postgresql://eva:{PASSWORD}@[::1]/station"], "has a sign in its user or password"),
        (["--database", "sqlite:////nowhere.sqlite", "--verify", "--jsonl"], "give one of them"),
        (["--database", "sqlite:////nowhere.sqlite", "--verify", "--limit", "3"], "give one of them"),
        (["--database", "sqlite:////nowhere.sqlite", "--jsonl", "--action", "sign-in"], "give one of them"),
        (["--database", "sqlite:////nowhere.sqlite", "--checkpoint", __file__], "give both"),
        (["trim", "--older-than", "3"], "say whose journal"),
    ],
)
def test_what_cannot_be_answered(arguments: list[str], said: str) -> None:
    code, out, err = command("journal", *arguments)
    assert (code, out) == (2, "")
    assert said in err
    assert PASSWORD not in err
