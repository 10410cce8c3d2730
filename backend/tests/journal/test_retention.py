"""Cutting off what happened long ago."""

from __future__ import annotations

import threading

import pytest
from sqlalchemy import text
from sqlalchemy.exc import IntegrityError

from journal.acts import EVA, filled
from journal.happened import content, durable, happened, with_writer
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import audit, checkpoints, retention, run_journal
from sequence_planner.journal.retention import Trimmed, trim
from sequence_planner.journal.verify import verify
from sequence_planner.journal.writer import RunWriter


def _left(database: Database) -> list[int]:
    with database.reading() as connection:
        assert verify(connection).wrong == ()
        return [record.number for record in run_journal.after(connection, 0, 10_000)]


def test_what_is_left_begins_with_the_newest_snapshot_that_is_old_enough(database: Database) -> None:
    happened(database, range(1, 36))  # a snapshot each ten; the times are the numbers
    assert trim(database, 28.0, EVA) == Trimmed(begin=19, removed=19)
    assert _left(database) == list(range(20, 36))
    with database.reading() as connection:
        (act,) = audit.read(connection)
        begin = run_journal.last_trimmed(connection)
    assert (act.entry.action, act.entry.subject, act.entry.actor) == ("journal-trimmed", "records up to 19", EVA)
    assert act.entry.details == {"number": 19, "hash": begin.hash}
    happened(database, range(36, 51))
    assert trim(database, 45.0, EVA) == Trimmed(begin=39, removed=20)
    assert _left(database) == list(range(40, 51))


def test_without_a_snapshot_that_is_old_enough_all_stays(database: Database) -> None:
    assert trim(database, 1e12, EVA) == Trimmed(begin=0, removed=0)
    happened(database, range(1, 25))
    assert trim(database, 10.0, EVA) == Trimmed(begin=0, removed=0)
    assert trim(database, 20.0, EVA) == Trimmed(begin=9, removed=9)
    assert trim(database, 20.0, EVA) == Trimmed(begin=9, removed=0)
    assert _left(database) == list(range(10, 25))
    with database.reading() as connection:
        assert len(audit.read(connection)) == 1


def test_checkpoints_of_what_was_cut_off_go_and_a_new_one_covers_all(database: Database) -> None:
    filled(database, 3)
    for end in (5, 15, 25):
        with database.reading() as connection:
            begun = run_journal.end(connection)
        assert begun is not None
        happened(database, range(begun.number + 1, end + 1))
        checkpoints.make(database, float(end))
    trim(database, 21.0, EVA)
    with database.reading() as connection:
        left = [each.statement() for each in checkpoints.everything(connection)]
    assert [(each.checkpoint, each.run.number, each.audit.number) for each in left] == [(3, 25, 3), (4, 25, 4)]
    assert _left(database) == list(range(20, 26))


def test_one_that_was_interrupted_is_whole_and_the_next_one_ends_it(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    happened(database, range(1, 36))
    with monkeypatch.context() as patch:
        patch.setattr(retention, "_remove", lambda *_: 1 // 0)
        with pytest.raises(ZeroDivisionError):
            trim(database, 28.0, EVA)
    with database.reading() as connection:
        assert verify(connection).wrong == ()
        assert run_journal.last_trimmed(connection).number == 19
    assert trim(database, 5.0, EVA) == Trimmed(begin=19, removed=19)
    assert _left(database) == list(range(20, 36))


def test_a_station_writes_meanwhile(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retention, "_AT_ONCE", 50)
    happened(database, range(1, 2001))
    done: list[Trimmed] = []

    async def write(writer: RunWriter) -> None:
        thread = threading.Thread(target=lambda: done.append(trim(database, 1990.5, EVA)))
        thread.start()
        number = 2000
        while thread.is_alive():
            number += 1
            writer.write("ticked", float(number), content(number))
            await durable(writer, number)
        thread.join()

    writer = with_writer(database, write)
    assert done == [Trimmed(begin=1989, removed=1989)]
    assert writer.durable > 2010
    assert _left(database) == list(range(1990, writer.durable + 1))


@pytest.mark.parametrize(
    "statement",
    [
        "DELETE FROM run",
        "DELETE FROM run WHERE number = 20",
        "UPDATE run SET time = 0 WHERE number = 20",
        "UPDATE run_begin SET number = 8",
        "INSERT INTO run SELECT * FROM run WHERE number = 20 ON CONFLICT (number) DO UPDATE SET time = 0",
        "DELETE FROM run_checkpoints WHERE run_number > 19",
        "UPDATE run_checkpoints SET content = ''",
    ],
)
def test_the_database_refuses_to_change_what_was_not_cut_off(database: Database, statement: str) -> None:
    happened(database, range(1, 26))
    trim(database, 21.0, EVA)
    with pytest.raises(IntegrityError, match="the journal is only ever added to"), database.writing() as connection:
        connection.execute(text(statement))
    assert _left(database) == list(range(20, 26))


def test_what_was_cut_off_by_nobody_is_found(database: Database) -> None:
    happened(database, range(1, 26))
    with database.writing() as connection:
        cut = "UPDATE run_begin SET number = 12, hash = (SELECT hash FROM run WHERE number = 12)"
        connection.execute(text(cut))
        connection.execute(text("DELETE FROM run WHERE number <= 12"))
    with database.reading() as connection:
        said = "what happened up to record 12 was cut off, and it is not recorded who did that"
        assert verify(connection).wrong == (said,)
    trim(database, 21.0, EVA)
    with database.writing() as connection:
        connection.execute(text("UPDATE run_begin SET hash = 'another'"))
    with database.reading() as connection:
        assert len(verify(connection).wrong) >= 2


def test_a_gap_before_the_snapshot_is_not_cut_off_unseen(database: Database) -> None:
    happened(database, range(1, 26))
    with database.writing() as connection:
        sqlite = connection.dialect.name == "sqlite"
        connection.execute(text("DROP TRIGGER run_no_delete" + ("" if sqlite else " ON run")))
        connection.execute(text("DELETE FROM run WHERE number = 19"))
    with pytest.raises(StorageError, match="record 19 of the journal is missing: verify it before it is trimmed"):
        trim(database, 21.0, EVA)
