"""Cutting off what happened long ago. What is left begins with a snapshot, and can be verified and replayed from it.

What is cut goes to the archive first. Only when the file is on the disk, and was read again as a whole, the run begins
later; and only then records go, a few at a time. So whoever is killed at any moment has lost nothing: a file that was
not finished is made anew, and one that is not counted yet holds what the database has too.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pydantic import JsonValue
from sqlalchemy import ColumnElement, Connection, Table, delete, func, select

from sequence_planner.core.actor import Actor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import archive, audit, checkpoints, hash_chain, run_journal
from sequence_planner.journal.archive import TRIMMED, Archive, ArchiveError, Segment, broken_at, header
from sequence_planner.journal.entry import Entry
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.hash_chain import ChainPosition
from sequence_planner.journal.run_journal import RUN, RUN_BEGIN, RUN_CHECKPOINTS

SNAPSHOT: Final = "snapshot"  # the kind of the records that hold all that comes after needs
MOST_IN_FILE: Final = 50_000  # records, some 3 MB
_PAGE: Final = 500  # records read at once
_AT_ONCE: Final = 250  # records taken out in one transaction, as a station waits that writes meanwhile
_BREATH: Final = 0.01  # seconds for others to write, at least; and as long as it took


@dataclass(frozen=True)
class Trimmed:
    """The rest that is left: the run begins behind the record `begin`, and `removed` records before were taken out
    now.
    """

    begin: int
    removed: int


def trim(database: Database, older_than: float, by: Actor, folder: Path | None = None) -> Trimmed:
    """Take out what happened before the newest snapshot that is older than this time (seconds since the epoch).

    It goes to files in `folder` first, and is gone for good without one. What was cut off by an earlier call that did
    not come to its end goes too. Raises `StorageError`.
    """
    removed = 0
    while True:
        with database.reading() as connection:
            snapshot = due(connection, older_than)
        if snapshot is None or not cut(database, snapshot, by, folder):
            break
        removed += remove(database)
    removed += remove(database)
    sign(database)
    with database.reading() as connection:
        return Trimmed(run_journal.last_trimmed(connection).number, removed)


def due(connection: Connection, older_than: float, not_beyond: int | None = None) -> int | None:
    """The newest snapshot that is older than this time, and so all before it may be cut; None where nothing may."""
    begin = run_journal.last_trimmed(connection)
    chosen = select(func.max(RUN.c.number)).where(
        RUN.c.kind == SNAPSHOT, RUN.c.number > begin.number + 1, RUN.c.time < older_than
    )
    if not_beyond is not None:
        chosen = chosen.where(RUN.c.number <= not_beyond)
    found: int | None = connection.execute(chosen).scalar()
    return found


def due_up_to(connection: Connection, number: int) -> int | None:
    """The newest snapshot up to a number."""
    begin = run_journal.last_trimmed(connection)
    chosen = select(func.max(RUN.c.number)).where(
        RUN.c.kind == SNAPSHOT, RUN.c.number > begin.number + 1, RUN.c.number <= number
    )
    found: int | None = connection.execute(chosen).scalar()
    return found


def cut(database: Database, snapshot: int, by: Actor, folder: Path | None) -> Segment | bool:
    """Let the run begin with a snapshot up to this one, as far as one file holds; what was cut, in `folder` if that is
    given. False where there was nothing to cut. Raises `StorageError`; then nothing is cut.
    """
    with database.reading() as connection:
        begin = run_journal.last_trimmed(connection)
        first = select(func.min(RUN.c.number)).where(RUN.c.kind == SNAPSHOT, RUN.c.number > begin.number + 1)
        at_least = connection.execute(first).scalar()
        fitting = due_up_to(connection, min(snapshot, begin.number + 1 + MOST_IN_FILE))
        chosen = fitting if fitting is not None else at_least
        if chosen is None or chosen > snapshot:
            return False
        last = run_journal.get(connection, chosen - 1)
        if last is None:
            raise StorageError(f"record {chosen - 1} of the journal is missing: verify it before it is trimmed")
    end = ChainPosition(last.number, last.hash)
    segment = None if folder is None else _archived(database, folder, begin, end)
    details: dict[str, JsonValue] = {"number": end.number, "hash": end.hash}
    entry = Entry(
        actor=by,
        action=TRIMMED,
        subject=f"records up to {end.number}",
        details=details if segment is None else segment.details(),
    )
    with database.writing() as connection:
        if not hash_chain.move(connection, RUN_BEGIN, end, begin):
            raise StorageError("somebody else cuts the journal just now: try again")
        audit.append(connection, entry, time.time())
    return segment or True


def remove(database: Database) -> int:
    """Take out the records that are no part of the run any more, little by little; how many."""
    with database.reading() as connection:
        begin = run_journal.last_trimmed(connection).number
    return _remove(database, RUN, RUN.c.number, begin)


def clear(database: Database, folder: Path) -> None:
    """Take away what others have left in the folder that did not come to their end: parts of files, and files that
    nothing counts and whose records are all elsewhere. Raises `StorageError`.
    """
    archive.clear(folder)
    with database.reading() as connection:
        run = WholeRun(connection)
        counted = {each.file for each in run.index.segments}
        for file in sorted(folder.glob(f"run-*{archive.ENDING}")):
            if file.name not in counted and _is_double(run, file):
                file.unlink(missing_ok=True)


def _is_double(run: WholeRun, file: Path) -> bool:
    """Check whether all that a file has is in the database, or in files that count: the last hash is over all before
    it.
    """
    try:
        said = json.loads(next(archive.lines(file)))
        last = run.get(said["last"])
        return last is not None and last.hash == said["hash"] and run.last_trimmed.number < said["first"]
    except (ArchiveError, StopIteration, ValueError, LookupError, TypeError):
        return False  # whatever it is, it is nobody's to throw away


def sign(database: Database) -> None:
    """Sign how far the journal has come, which covers all that checkpoints of what was cut have covered; these go."""
    with database.reading() as connection:
        begin = run_journal.last_trimmed(connection).number
    checkpoints.make(database, time.time())
    _remove(database, RUN_CHECKPOINTS, RUN_CHECKPOINTS.c.run_number, begin)


def _archived(database: Database, folder: Path, begin: ChainPosition, end: ChainPosition) -> Segment:
    """The file of the records behind `begin` up to `end`, on the disk and read again as a whole."""
    with database.reading() as connection:
        first, last = (run_journal.get(connection, number) for number in (begin.number + 1, end.number))
    if first is None or last is None:
        raise _broken(begin.number + 1)
    name = f"run-{first.number:012}-{last.number:012}-{end.hash[:8]}{archive.ENDING}"

    def lines() -> Iterator[str]:
        yield header((begin, end), first.time, last.time)
        yield from _lines(database, begin, end)

    written = archive.write(folder / name, lines())
    segment = Segment(
        folder=str(folder),
        file=name,
        first=first.number,
        last=last.number,
        before=begin.hash,
        hash=end.hash,
        since=first.time,
        until=last.time,
        size=written.size,
        sha256=written.sha256,
    )
    if broken_at(Archive(), segment) is not None:
        raise ArchiveError(f"{folder / name} was written, and is not read as it was written: is the disk sound?")
    return segment


def _lines(database: Database, begin: ChainPosition, end: ChainPosition) -> Iterator[str]:
    """Page by page, as a reader who takes long must not keep SQLite from clearing its log."""
    at = begin
    while at.number < end.number:
        with database.reading() as connection:
            page = run_journal.after(connection, at.number, min(_PAGE, end.number - at.number))
        if not page:
            raise _broken(at.number + 1)
        for record in page:
            if record.number != at.number + 1 or not record.is_whole(at.hash):
                raise _broken(at.number + 1)
            at = ChainPosition(record.number, record.hash)
            yield record.line()


def _broken(number: int) -> StorageError:
    return StorageError(
        f"record {number} of the journal is missing, or is not as it was written: see what `sequence-planner journal "
        "--verify` finds. Nothing is cut before it is whole"
    )


def _remove(database: Database, table: Table, column: ColumnElement[int], begin: int) -> int:
    """Delete what lies at or before `begin`; the number of rows."""
    removed = 0
    oldest = select(table.c.number).where(column <= begin).order_by(table.c.number).limit(_AT_ONCE)
    while True:
        began = time.monotonic()
        with database.writing() as connection:
            found = connection.execute(delete(table).where(table.c.number.in_(oldest))).rowcount
        removed += found
        if found < _AT_ONCE:
            return removed
        time.sleep(max(_BREATH, time.monotonic() - began))
