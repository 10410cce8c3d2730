"""Writing what happens: on SQLite and on PostgreSQL, and what becomes of it when the database is away."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager

import pytest
from sqlalchemy import Connection, event, text
from structlog.testing import capture_logs

from journal.happened import content, durable, happened, kind, troubled, with_writer
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db import postgresql as storage_postgresql
from sequence_planner.db import sqlite as storage_sqlite
from sequence_planner.db.database import Database
from sequence_planner.journal import run_journal
from sequence_planner.journal import writer as group_commit
from sequence_planner.journal.writer import RunWriter
from support.postgresql import Server


def _numbers(database: Database) -> list[int]:
    with database.reading() as connection:
        assert run_journal.broken_at(connection) is None
        return [record.number for record in run_journal.after(connection, 0, 10_000)]


def test_records_are_read_in_both_directions_and_by_their_kind(database: Database) -> None:
    happened(database, range(1, 31))
    with database.reading() as connection:
        first = run_journal.after(connection, 0, 2)
        assert [(each.number, each.time, each.kind, each.content) for each in first] == [
            (number, float(number), kind(number), content(number)) for number in (1, 2)
        ]
        assert [each.number for each in run_journal.after(connection, 28, 9)] == [29, 30]
        assert [each.number for each in run_journal.before(connection, None, 2)] == [30, 29]
        assert [each.number for each in run_journal.before(connection, 3, 9)] == [2, 1]
        both = {"snapshot", "alarm"}
        assert [each.number for each in run_journal.after(connection, 3, 4, both)] == [10, 17, 20, 24]
        assert [each.number for each in run_journal.before(connection, 24, 3, both)] == [20, 17, 10]
        assert run_journal.after(connection, 0, 9, {"nothing"}) == run_journal.after(connection, 0, 9, ()) == []
        assert run_journal.last(connection, "snapshot") == run_journal.get(connection, 30)
        assert run_journal.last(connection, "nothing") is run_journal.get(connection, 31) is None
        assert run_journal.last_trimmed(connection).number == 0


def test_any_text_is_kept_as_it_is(database: Database) -> None:
    odd = '{"NUL \\u0000, \\"quotes\\", \\\\ and \u2028":"机器人 🤖\x9b"}'

    async def write(writer: RunWriter) -> None:
        writer.write("odd", 0.1 + 0.2, odd)

    with_writer(database, write)
    with database.reading() as connection:
        (record,) = run_journal.after(connection, 0, 9)
        assert (record.time, record.content) == (0.1 + 0.2, odd)
        assert run_journal.broken_at(connection) is None


def test_it_tells_when_records_are_durable_and_writes_what_waits_together(database: Database) -> None:
    told: list[tuple[int, int]] = []

    async def run() -> None:
        writer = RunWriter(database, lambda: told.append((writer.durable, writer.waiting)))
        writer.start()
        for number in range(1, 2001):
            writer.write("ticked", float(number), content(number))
        assert (writer.durable, writer.waiting) == (0, 2000)
        await durable(writer, 2000)
        await writer.close()
        with pytest.raises(RuntimeError, match="the journal is closed"):
            writer.write("ticked", 0.0, "{}")

    asyncio.run(run())
    assert told[-1] == (2000, 0)
    assert len(told) <= 10  # transactions
    assert told == sorted(told)
    assert _numbers(database) == list(range(1, 2001))


def test_what_waits_at_the_end_is_written_and_the_next_station_goes_on_behind_it(database: Database) -> None:
    happened(database, range(1, 500))
    happened(database, range(500, 600))
    assert _numbers(database) == list(range(1, 600))


@pytest.mark.parametrize(("kind", "content"), [("", "{}"), ("x" * 41, "{}"), ("ticked", "{\n}")])
def test_what_could_not_be_read_again_is_not_taken(database: Database, kind: str, content: str) -> None:
    async def write(writer: RunWriter) -> None:
        with pytest.raises(ValueError, match="cannot be written"):
            writer.write(kind, 0.0, content)
        assert writer.waiting == 0

    with_writer(database, write)


def test_a_database_that_is_locked_is_said_and_nothing_is_lost(
    database: Database, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (storage_sqlite, storage_postgresql):
        monkeypatch.setattr(module, "PATIENCE", 0.2)  # seconds, instead of 5

    async def write(writer: RunWriter) -> None:
        writer.write("ticked", 1.0, content(1))
        await durable(writer, 1)
        with closing(Database.open(database_url)) as other, other.writing():
            began = time.perf_counter()
            for number in range(2, 100):
                writer.write("ticked", float(number), content(number))
            assert time.perf_counter() - began < 0.1  # nobody waits for the database
            assert "5 s" in await troubled(writer)
            assert (writer.durable, writer.waiting) == (1, 98)
        await durable(writer, 99)
        assert writer.trouble is None

    with_writer(database, write)
    assert _numbers(database) == list(range(1, 100))


@contextmanager
def _full(database: Database, pages: list[int]) -> Iterator[None]:
    """SQLite may use so many pages only, as on a disk that is full behind them."""

    def limit(connection: Connection) -> None:
        connection.exec_driver_sql(f"PRAGMA max_page_count = {pages[0]}")

    event.listen(database._engine, "begin", limit)
    yield
    event.remove(database._engine, "begin", limit)


def test_a_full_disk_is_said_and_nothing_is_lost(tmp_path_factory: pytest.TempPathFactory) -> None:
    pages = [2**30]
    folder = tmp_path_factory.mktemp("full")
    with closing(Database.open(f"sqlite:///{folder}/station.sqlite")) as database, _full(database, pages):
        database.upgrade()

        async def write(writer: RunWriter) -> None:
            writer.write("ticked", 1.0, content(1))
            await durable(writer, 1)
            pages[0] = 1  # SQLite takes the present size
            for number in range(2, 301):
                writer.write("ticked", float(number), "{" + " " * 5000 + "}")
            assert "as the disk is full: make room" in await troubled(writer)
            assert writer.durable < 300
            pages[0] = 2**30
            await durable(writer, 300)
            assert writer.trouble is None

        with_writer(database, write)
        assert _numbers(database) == list(range(1, 301))


def test_connections_that_are_cut_are_made_anew(postgresql: Server) -> None:
    database = Database.open(postgresql.new_database())
    database.upgrade()

    async def write(writer: RunWriter) -> None:
        for number in range(1, 301):
            writer.write("ticked", float(number), content(number))
            if number % 50 == 0:
                with database.reading() as connection:
                    cut = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE pid <> pg_backend_pid() "
                    connection.execute(text(cut + "AND datname = current_database()"))
            await asyncio.sleep(0.001)
        await durable(writer, 300)

    with_writer(database, write)
    assert _numbers(database) == list(range(1, 301))
    database.close()


class _LosesAnswers(Database):
    """Says every other time that something went wrong when all was written, as when a server vanishes then."""

    written = 0

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        with super().writing() as connection:
            yield connection
        self.written += 1
        if self.written % 2:
            raise StorageError("the server has gone")


def test_what_was_written_though_nobody_heard_is_not_written_twice(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(group_commit, "FIRST_PAUSE", 0.01)
    with closing(_LosesAnswers(database.place, database._engine)) as loses:

        async def write(writer: RunWriter) -> None:
            for number in range(1, 21):
                writer.write("ticked", float(number), content(number))
                await durable(writer, number)

        writer = with_writer(loses, write)
        assert loses.written >= 40
    assert (writer.durable, writer.trouble) == (20, None)
    assert _numbers(database) == list(range(1, 21))


def test_a_second_station_is_noticed_and_writes_nothing(database: Database, database_url: str) -> None:
    async def write(first: RunWriter) -> None:
        with closing(Database.open(database_url)) as other:
            second = RunWriter(other, lambda: None)
            second.start()
            first.write("ticked", 1.0, content(1))
            await durable(first, 1)
            second.write("ticked", 1.0, content(1))
            with capture_logs():
                assert "another station writes what happens to this database too" in await troubled(second)
            first.write("ticked", 2.0, content(2))
            await durable(first, 2)
            await asyncio.sleep(0.5)
            assert second.trouble is not None  # also later, when it could be tried again
            assert second.durable == 0
            began = time.perf_counter()
            await second.close()
            assert time.perf_counter() - began < 1

    writer = with_writer(database, write)
    assert writer.trouble is None
    assert _numbers(database) == [1, 2]


def test_an_end_does_not_wait_for_a_database_that_is_away(
    database: Database, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (storage_sqlite, storage_postgresql):
        monkeypatch.setattr(module, "PATIENCE", 0.2)

    async def run() -> None:
        writer = RunWriter(database, lambda: None)
        writer.start()
        with closing(Database.open(database_url)) as other, other.writing():
            writer.write("ticked", 1.0, content(1))
            began = time.perf_counter()
            with capture_logs() as logs:
                await writer.close()
            assert time.perf_counter() - began < 7
        assert logs[-1]["event"] == "what happened last is not journalled"
        assert logs[-1]["records"] == 1

    asyncio.run(run())
    assert _numbers(database) in ([], [1])  # it may still be on its way to the database


def test_a_journal_without_its_end_is_not_written_to(database: Database) -> None:
    with database.writing() as connection:
        connection.execute(text("DELETE FROM run_end"))

    async def run() -> None:
        with pytest.raises(StorageError, match="the journal's end was taken out of"):
            RunWriter(database, lambda: None)

    asyncio.run(run())
