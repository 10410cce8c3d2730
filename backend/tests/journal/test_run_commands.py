"""`journal export`, `checkpoint`, `trim` and `--verify`: what has happened, on the command line."""

from __future__ import annotations

import getpass
import json
import time
from pathlib import Path

from sqlalchemy import text

from journal.acts import filled
from journal.happened import happened
from sequence_planner.db.database import Database
from sequence_planner.journal import audit, run_journal
from support.commands import command


def test_all_that_happened_as_json_lines(database: Database, database_url: str) -> None:
    happened(database, range(1, 2501))
    code, out, err = command("journal", "export", "--database", database_url)
    assert (code, err) == (0, "")
    documents = [json.loads(line) for line in out.splitlines()]
    assert [document["number"] for document in documents] == list(range(1, 2501))
    assert {*documents[0]} == {"number", "time", "kind", "content", "hash"}
    assert documents[6]["content"] == {"number": 7, "robot.pose": "bolt_pair", "torque": 1.0}
    _, later, _ = command("journal", "export", "--database", database_url, "--after", 2400)
    assert later.splitlines() == out.splitlines()[2400:]


def test_a_checkpoint_is_printed_to_be_kept_and_compared_with_later(
    database: Database, database_url: str, tmp_path: Path
) -> None:
    filled(database, 2)
    happened(database, range(1, 21))
    code, out, err = command("journal", "checkpoint", "--database", database_url)
    assert (code, err, out.count("\n")) == (0, "", 1)
    kept = tmp_path / "kept.json"
    kept.write_text(out)
    happened(database, range(21, 31))
    code, out, _ = command("journal", "--database", database_url, "--verify", "--checkpoint", kept)
    assert code == 0
    lines = out.splitlines()
    assert lines[1].startswith("what happened: records 1 to 30, all as they were written; the hash of the last one is ")
    assert lines[2].startswith("checkpoint 1 of ")
    assert lines[2].endswith(json.loads(kept.read_text())["public_key"])
    assert lines[3].endswith("UTC that was kept fits")
    with database.writing() as connection:
        sqlite = connection.dialect.name == "sqlite"
        off = "DROP TRIGGER run_no_update" if sqlite else "ALTER TABLE run DISABLE TRIGGER ALL"
        connection.execute(text(off))
        connection.execute(text("UPDATE run SET hash = 'another' WHERE number = 20"))
    code, out, _ = command("journal", "--database", database_url, "--verify", "--checkpoint", kept)
    fits_not = "does not fit: record 20 of what happened is missing, or is another one"
    assert (code, out.splitlines()) == (
        1,
        [
            "record 20 of what happened is missing, or is not as it was written",
            f"checkpoint 1 of those in the database {fits_not}",
            f"the checkpoint that was kept {fits_not}",
        ],
    )


def test_what_is_no_checkpoint_is_refused(database: Database, database_url: str, tmp_path: Path) -> None:
    kept = tmp_path / "kept.json"
    nothing = {"content": "{}", "public_key": "a" * 64, "signature": "b" * 128}
    for written in ("", "{}", json.dumps(nothing)):
        kept.write_text(written)
        code, _, err = command("journal", "--database", database_url, "--verify", "--checkpoint", kept)
        assert code == 2
        assert "kept.json holds no checkpoint as `journal checkpoint` prints it" in err


def test_what_happened_long_ago_is_taken_out(database: Database, database_url: str) -> None:
    happened(database, range(1, 36))  # in the first minute of 1970
    days = time.time() / 86400 - 28 / 86400
    trim = ("journal", "trim", "--database", database_url, "--older-than", days, "--archive-folder", "none")
    code, out, _ = command(*trim)
    assert (code, out) == (0, "19 records were taken out; the database begins with record 20\n")
    with database.reading() as connection:
        (act,) = audit.read(connection)
        begin = run_journal.last_trimmed(connection)
    assert act.entry.actor.address == f"the command line of {getpass.getuser()}"
    code, out, _ = command("journal", "--database", database_url, "--verify")
    said = f"what happened: records 20 to 35 behind the hash {begin.hash}, all as they were written; "
    assert (code, out.splitlines()[1].startswith(said)) == (0, True)
    _, out, _ = command("journal", "export", "--database", database_url)
    assert [json.loads(line)["number"] for line in out.splitlines()] == list(range(20, 36))
