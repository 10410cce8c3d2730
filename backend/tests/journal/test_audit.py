"""The record of who did what: on SQLite and on PostgreSQL."""

from __future__ import annotations

import hashlib
import json
import signal
import subprocess
import sys

import pytest
from sqlalchemy import text
from sqlalchemy.exc import IntegrityError

from journal.acts import EVA, act, filled
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry, Outcome

APPEND = """
import sys
from sequence_planner.core.actor import SYSTEM
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry
from sequence_planner.db.database import Database

database = Database.open(sys.argv[1])
print("ready", flush=True)
sys.stdin.readline()
for number in range(100):
    with database.writing() as connection:
        audit.append(connection, Entry(actor=SYSTEM, action=sys.argv[2]), float(number))
"""

BE_KILLED = """
import os, signal, sys
from sequence_planner.core.actor import SYSTEM
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry
from sequence_planner.db.database import Database

database = Database.open(sys.argv[1])
for number in (1, 2):
    with database.writing() as connection:
        audit.append(connection, Entry(actor=SYSTEM, action="try"), float(number))
        if number == 2:
            os.kill(os.getpid(), signal.SIGKILL)
"""

BEHIND_OUR_BACK = {
    "changed": "UPDATE audit SET entry = replace(entry, 'task 3', 'task 4') WHERE number = 4",
    "another time": "UPDATE audit SET time = time + 0.001 WHERE number = 4",
    "another actor to search by": "UPDATE audit SET actor = 'somebody' WHERE number = 4",
    "another hash": "UPDATE audit SET hash = 'a' || hash WHERE number = 4",
    "taken out": "DELETE FROM audit WHERE number = 4",
    "taken off the end": "DELETE FROM audit WHERE number >= 4",
    "renumbered": "UPDATE audit SET number = 40 WHERE number = 4",
}


def test_what_was_appended_is_read_the_newest_first(database: Database) -> None:
    records = filled(database, 5)
    assert [record.number for record in records] == [1, 2, 3, 4, 5]
    with database.reading() as connection:
        assert audit.read(connection) == records[::-1]
        assert audit.read(connection, limit=2) == [records[4], records[3]]
        assert audit.read(connection, before=3) == [records[1], records[0]]
        assert audit.read(connection, action="nothing") == []
        assert [record.number for record in audit.read(connection, actor=EVA.id)] == [4, 2]
        assert [record.number for record in audit.read(connection, action="set-mode", before=5)] == [3, 1]
        assert audit.broken_at(connection) is None


def test_any_text_is_kept_as_it_is(database: Database) -> None:
    odd = 'NUL \x00, "quotes", \\ and \u2028, 机器人 🤖\n\x9b'
    entry = Entry(actor=EVA, action="try", subject=odd, details={odd: [odd, 0.1, 10**20, None]}, reason=odd)
    with database.writing() as connection:
        written = audit.append(connection, entry, 0.1 + 0.2)
    with database.reading() as connection:
        assert audit.read(connection) == [written]
        assert audit.broken_at(connection) is None
        assert written.entry == entry


def test_a_block_that_raises_leaves_nothing(database: Database) -> None:
    filled(database, 1)
    with pytest.raises(ZeroDivisionError), database.writing() as connection:
        audit.append(connection, act(2), 2.0)
        connection.execute(text("INSERT INTO first_start_links (token_hash, expires) VALUES ('a', 1)"))
        raise ZeroDivisionError
    with database.writing() as connection:
        assert connection.execute(text("SELECT count(*) FROM first_start_links")).scalar_one() == 0
        assert audit.append(connection, act(2), 2.0).number == 2
    with database.reading() as connection:
        assert audit.broken_at(connection) is None


def test_a_process_that_is_killed_leaves_what_was_done_and_nothing_else(database: Database, database_url: str) -> None:
    done = subprocess.run([sys.executable, "-c", BE_KILLED, database_url], check=False, timeout=60)
    assert done.returncode == -signal.SIGKILL
    with database.writing() as connection:
        assert audit.append(connection, act(2), 2.0).number == 2
    with database.reading() as connection:
        assert [record.entry.action for record in audit.read(connection)] == ["acknowledge", "try"]
        assert audit.broken_at(connection) is None


def test_two_processes_leave_no_gap(database: Database, database_url: str) -> None:
    started = [
        subprocess.Popen(
            [sys.executable, "-c", APPEND, database_url, name], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        for name in ("one", "other")
    ]
    for process in started:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    for process in started:
        assert process.stdin is not None
        process.stdin.write("go\n")
        process.stdin.flush()
    for process in started:
        process.communicate(timeout=60)
    assert [process.returncode for process in started] == [0, 0]
    with database.reading() as connection:
        assert audit.broken_at(connection) is None
        assert [record.number for record in audit.read(connection, limit=1000)] == list(range(200, 0, -1))
        assert len(audit.read(connection, limit=1000, action="one")) == 100


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE audit SET time = 0",
        "DELETE FROM audit",
        "DELETE FROM audit WHERE number = 3",
        "INSERT INTO audit SELECT * FROM audit WHERE number = 3 ON CONFLICT (number) DO UPDATE SET time = 0",
    ],
)
def test_the_database_refuses_to_change_a_record(database: Database, statement: str) -> None:
    records = filled(database, 3)
    with pytest.raises(IntegrityError, match="the journal is only ever added to"), database.writing() as connection:
        connection.execute(text(statement))
    with database.reading() as connection:
        assert audit.read(connection) == records[::-1]


def test_each_database_refuses_its_own_ways_to_change_a_record(database: Database) -> None:
    records = filled(database, 3)
    replacing = "INSERT OR REPLACE INTO audit SELECT number, 0, action, actor, entry, hash FROM audit"
    with pytest.raises(IntegrityError, match="the journal is only ever added to"), database.writing() as connection:
        connection.execute(text(replacing if connection.dialect.name == "sqlite" else "TRUNCATE audit"))
    with database.reading() as connection:
        assert audit.read(connection) == records[::-1]


@pytest.mark.parametrize("way", list(BEHIND_OUR_BACK))
def test_what_was_changed_behind_our_back_is_found(database: Database, way: str) -> None:
    filled(database, 6)
    with database.writing() as connection:
        for trigger in ("update", "delete") if connection.dialect.name == "sqlite" else ():
            connection.execute(text(f"DROP TRIGGER audit_no_{trigger}"))
        if connection.dialect.name == "postgresql":
            connection.execute(text("ALTER TABLE audit DISABLE TRIGGER ALL"))
            connection.execute(text("ALTER TABLE audit ALTER hash TYPE text"))
        assert connection.execute(text(BEHIND_OUR_BACK[way])).rowcount > 0
    with database.reading() as connection:
        assert audit.broken_at(connection) == 4
    with database.writing() as connection:
        audit.append(connection, act(7), 7.0)  # what is done now is recorded all the same
    with database.reading() as connection:
        assert audit.broken_at(connection) == 4


@pytest.mark.parametrize("number", [0, -1, 4])
def test_what_was_put_in_by_somebody_else_is_found(database: Database, number: int) -> None:
    filled(database, 3)
    with database.writing() as connection:
        columns = "time, action, actor, entry, hash"
        connection.execute(text(f"INSERT INTO audit SELECT {number}, {columns} FROM audit WHERE number = 3"))
    with database.reading() as connection:
        assert audit.broken_at(connection) == max(number, 1)


def test_a_chain_made_anew_from_a_change_on_does_not_fit_the_end(database: Database) -> None:
    filled(database, 3)
    with database.writing() as connection:
        connection.execute(text("UPDATE audit_end SET hash = 'another'"))
    with database.reading() as connection:
        assert audit.broken_at(connection) == 3


def test_a_record_that_was_made_unreadable_is_named(database: Database) -> None:
    filled(database, 2)
    with database.writing() as connection:
        sqlite = connection.dialect.name == "sqlite"
        off = "DROP TRIGGER audit_no_update" if sqlite else "ALTER TABLE audit DISABLE TRIGGER ALL"
        connection.execute(text(off))
        connection.execute(text("UPDATE audit SET entry = 'nothing' WHERE number = 2"))
    unreadable = pytest.raises(StorageError, match="record 2 of the journal cannot be read: it was changed")
    with unreadable, database.reading() as connection:
        audit.read(connection)


def test_anybody_can_verify_the_lines(database: Database) -> None:
    """As docs/database.md says it is done, with nothing of the program."""
    filled(database, 5)
    with database.reading() as connection:
        lines = [stored.line() for stored in audit.page_after(connection, 0)]
    before = ""
    for line in lines:
        content, _, rest = line.rpartition(',"hash":"')
        before = hashlib.sha256((before + content).encode()).hexdigest()
        assert rest == f'{before}"}}'
        assert json.loads(line)["hash"] == before


def test_an_outcome_says_of_what(database: Database) -> None:
    with database.writing() as connection:
        asked = audit.append(connection, Entry(actor=EVA, action="set-mode", outcome=Outcome.REQUESTED), 1.0)
    with database.writing() as connection:
        audit.append(connection, Entry(actor=SYSTEM, action="set-mode", about=asked.number), 2.0)
    with database.reading() as connection:
        assert [record.entry.about for record in audit.read(connection)] == [asked.number, None]
