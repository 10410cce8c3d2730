"""Data retention: storage growth, archive folder, and the archiving or removal of old records."""

from __future__ import annotations

import contextlib
import os
import shutil
import time
from bisect import bisect_right
from contextlib import closing
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

from pydantic import JsonValue
from sqlalchemy import Column, Connection, Table, func, select, text

from sequence_planner.core.actor import Actor
from sequence_planner.db.database import Database
from sequence_planner.db.location import PostgresqlServer, SqliteFile, archive_folder
from sequence_planner.journal import audit, retention, run_journal
from sequence_planner.journal.archive import REMOVED, Archive, ArchiveError, Segment
from sequence_planner.journal.entry import Entry
from sequence_planner.journal.retention import MOST_IN_FILE
from sequence_planner.journal.run_journal import RUN
from sequence_planner.mes.retention import FILES_REMOVED, OrderFile, cut_orders, order_files
from sequence_planner.mes.tables import JOB_EVENTS, JOB_LEDGER, JOB_ORDERS, JOB_RESPONSES
from sequence_planner.retention.settings import DAY, GB, Retention

# Where the archive is. A folder that somebody has named must be there: one that is not may be a disk that is not
# mounted, and what is written in its place nobody would look for.


def place(named: Path | None, url: str, model: Path | None) -> Path:
    """The folder, there or not. Raises `StorageError` for a URL that names no database."""
    return (named or archive_folder(url, model or Path())).absolute()


def usable(named: Path | None, url: str, model: Path | None) -> Path:
    """The folder, which can be written to; one that nobody has named is made, for this user alone.

    Raises `StorageError`.
    """
    folder = place(named, url, model)
    try:
        if named is None:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise ArchiveError(f"the folder {folder} cannot be made ({error.strerror}): see to its disk") from error
    if not folder.is_dir():
        raise ArchiveError(f"there is no folder {folder}: make or mount it, or name another with --archive-folder")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise ArchiveError(f"nothing can be written to {folder}: let the user who runs the station do so")
    return folder


# How much there is of what, and how it grows, at a cost that does not grow with it.
#
# Records are numbered without gaps, so their number is known at once. How large they are is estimated from samples all
# over them, as neither database tells the size of a table without reading all of it.

BLOCKS: Final = 16  # samples
_IN_BLOCK: Final = 32  # records
_BESIDE: Final = 150  # bytes of a record beside its content: hash, time, kind, place in the index
_ORDER: Final = 500  # bytes of an order
DAYS: Final = 14  # of growth that are told


@dataclass(frozen=True)
class Day:
    """The growth in a day that begins at `since`, in seconds since the epoch."""

    since: float
    records: int
    size: int


@dataclass(frozen=True)
class Blocks:
    """The sizes of records in samples: the mean of each in bytes, by the number at which it begins."""

    begin: int
    end: int
    means: tuple[tuple[int, float], ...]

    @property
    def size(self) -> int:
        """Bytes of all records."""
        return self.behind(self.begin)

    def behind(self, number: int) -> int:
        """Bytes of the records behind a number."""
        edges = [*(max(number, start - 1) for start, _ in self.means), self.end]
        return round(
            sum(
                max(0, after - before) * mean
                for before, after, (_, mean) in zip(edges, edges[1:], self.means, strict=False)
            )
        )

    def last_fitting(self, most: float) -> int:
        """The lowest number behind which there are at most so many bytes."""
        low, high = self.begin, self.end
        while low < high:
            middle = (low + high) // 2
            if self.behind(middle) <= most:
                high = middle
            else:
                low = middle + 1
        return low


def run_blocks(connection: Connection) -> Blocks:
    """Samples of the run."""
    begin, end = run_journal.last_trimmed(connection).number, run_journal.end(connection)
    return _blocks(connection, RUN, RUN.c.content, begin, begin if end is None else end.number)


def orders_size(connection: Connection) -> int:
    """About how many bytes orders, their events and responses have."""
    total = int(connection.execute(select(func.count()).select_from(JOB_ORDERS)).scalar_one()) * _ORDER
    for table in (JOB_EVENTS, JOB_RESPONSES):
        first, last = connection.execute(select(func.min(table.c.number), func.max(table.c.number))).one()
        if first is not None:
            total += _blocks(connection, table, table.c.content, first - 1, last).size
    return total


def growth(connection: Connection, now: float, blocks: Blocks) -> tuple[Day, ...]:
    """Return what has come in each of the last days of which the database has all, the oldest first; the last one ends
    now.
    """
    bounds = run_journal.bounds(connection)
    if bounds is None:
        return ()
    first, last = bounds
    edges = [now - DAY * each for each in range(DAYS, -1, -1)]
    edges = edges[max(0, bisect_right(edges, first.time) - 1) :]
    numbers = [run_journal.at(connection, edge, first, last) for edge in edges]
    return tuple(
        Day(since, after - before, max(0, blocks.behind(before) - blocks.behind(after)))
        for since, (before, after) in zip(edges, pairwise(numbers), strict=False)
    )


def database_size(connection: Connection, place: SqliteFile | PostgresqlServer) -> tuple[int, int]:
    """Bytes of the database on its disk, and how many of these are free for what comes (known of SQLite alone)."""
    if isinstance(place, PostgresqlServer):
        return int(connection.execute(text("SELECT pg_database_size(current_database())")).scalar_one()), 0
    free, page = (
        int(connection.exec_driver_sql(f"PRAGMA {each}").scalar_one()) for each in ("freelist_count", "page_size")
    )
    return sum(_size(place.path.with_name(place.path.name + each)) for each in ("", "-wal")), free * page


def folder_size(folder: Path) -> int:
    """Bytes of the files in a folder; 0 where it is not there."""
    total = 0
    with contextlib.suppress(OSError):
        for each in folder.iterdir():
            total += _size(each)
    return total


def free_on_disk(path: Path) -> int | None:
    """Bytes that are free on the disk of a path, or of the first folder above it that is there."""
    there = _there(path)
    return None if there is None else shutil.disk_usage(there).free


def are_on_one_disk(path: Path, other: Path) -> bool:
    """Return whether what takes room from one takes it from the other."""
    first, second = _there(path), _there(other)
    return first is not None and second is not None and first.stat().st_dev == second.stat().st_dev


def _there(path: Path) -> Path | None:
    return next((each for each in (path, *path.parents) if each.exists()), None)


def _size(file: Path) -> int:
    try:
        return file.stat().st_size
    except OSError:
        return 0


def _blocks(connection: Connection, table: Table, content: Column[str], begin: int, end: int) -> Blocks:
    count = end - begin
    if count <= 0:
        return Blocks(begin, end, ())
    starts = sorted({begin + 1 + count * each // BLOCKS for each in range(BLOCKS)})
    means = []
    for start in starts:
        some = select(func.length(content).label("size")).where(table.c.number >= start)
        sample = some.order_by(table.c.number).limit(_IN_BLOCK).subquery()
        mean = connection.execute(select(func.avg(sample.c.size))).scalar()
        means.append((start, _BESIDE + float(mean or 0)))
    return Blocks(begin, end, tuple(means))


# One pass of retention: what is too old, or too much, goes to the archive, and from there where a limit is set.
#
# It does a bounded amount of work, and others write in between. Whatever ends it, the next one goes on from there.

MOST_FILES: Final = 10  # of each kind in one pass
_LEAST: Final = DAY  # seconds; so much goes to a file at once, or `MOST_IN_FILE` records


@dataclass(frozen=True)
class RetentionTask:
    """A pass for the station in the folder `model`; with `everything` little is not left for later."""

    url: str
    model: Path | None
    retention: Retention
    by: Actor
    everything: bool = False


@dataclass(frozen=True)
class Done:
    """The numbers of records, and of job orders, events or responses cut; with `more` another pass finds more to do."""

    records: int = 0
    orders: int = 0
    removed: int = 0
    more: bool = False


def do(task: RetentionTask) -> Done:
    """One pass. Raises `StorageError`; what was done until then is whole."""
    settings, now = task.retention, time.time()
    with closing(Database.open(task.url, create=False)) as database:
        database.check()
        folder = usable(settings.folder, task.url, task.model) if settings.archived else None
        if folder is not None:
            retention.clear(database, folder)
        retention.remove(database)  # what a pass has left that did not come to its end
        records = files = orders = batches = 0
        while files < MOST_FILES and (snapshot := _due(database, settings, now, task.everything)) is not None:
            with database.reading() as connection:
                before = run_journal.last_trimmed(connection).number
            if not retention.cut(database, snapshot, task.by, folder):
                break
            retention.remove(database)
            with database.reading() as connection:
                records += run_journal.last_trimmed(connection).number - before
            files += 1
        if files:
            retention.sign(database)
        limit = now - settings.order_days * DAY
        least = None if task.everything else limit - _LEAST
        while batches < MOST_FILES and (cut := cut_orders(database, limit, task.by, time.time(), folder, least)):
            orders, batches = orders + cut, batches + 1
        removed = _remove_files(database, settings, task.by, now)
    return Done(records, orders, removed, MOST_FILES in (files, batches))


def _due(database: Database, settings: Retention, now: float, everything: bool) -> int | None:
    """The snapshot up to which may be cut, if it is worth while."""
    older_than = now - settings.journal_days * DAY
    with database.reading() as connection:
        ledger = connection.execute(select(JOB_LEDGER.c.number)).scalar_one_or_none()  # which reads on from there
        old = retention.due(connection, older_than, ledger)
        blocks = run_blocks(connection)
        fitting = blocks.last_fitting(settings.journal_gb * GB) + 1
        large = None
        if fitting > blocks.begin + 1:
            large = retention.due_up_to(connection, fitting if ledger is None else min(fitting, ledger))
        found = max((each for each in (old, large) if each is not None), default=None)
        if found is None or everything or found - blocks.begin > MOST_IN_FILE:
            return found
        return found if _is_overdue(connection, older_than - _LEAST) else None


def _is_overdue(connection: Connection, older_than: float) -> bool:
    first = run_journal.get(connection, run_journal.last_trimmed(connection).number + 1)
    return first is not None and first.time < older_than


def _remove_files(database: Database, settings: Retention, by: Actor, now: float) -> int:
    """Remove the oldest files of the archive that are too old, or with which there is too much; how many.

    It is recorded before a file goes, so that nobody looks for it in vain.
    """
    archive = Archive(settings.folder)
    with database.reading() as connection:
        files: list[Segment | OrderFile] = [*archive.index(connection).segments, *order_files(connection)]
    files.sort(key=lambda each: each.until)
    total, removed = sum(each.size for each in files), 0
    for each in files:
        too_old = settings.archive_days is not None and each.until < now - settings.archive_days * DAY
        too_much = settings.archive_gb is not None and total > settings.archive_gb * GB
        if not too_old and not too_much:
            break
        _remove_file(database, archive, each, by, now)
        total, removed = total - each.size, removed + 1
    return removed


def _remove_file(database: Database, archive: Archive, each: Segment | OrderFile, by: Actor, now: float) -> None:
    details: dict[str, JsonValue] = {"file": each.file, "until": each.until, "size": each.size}
    if isinstance(each, Segment):
        details |= {"number": each.last, "hash": each.hash}
        path, action = archive.path(each), REMOVED
    else:
        path, action = each.path(archive.folder), FILES_REMOVED
    with database.writing() as connection:
        audit.append(connection, Entry(actor=by, action=action, subject=each.file, details=details), now)
    with contextlib.suppress(FileNotFoundError):
        path.unlink()
