"""How much there is of what, and how it grows, at a cost that does not grow with it.

Records are numbered without gaps, so their number is known at once. How large they are is estimated from samples all
over them, as neither database tells the size of a table without reading all of it.
"""

from __future__ import annotations

import contextlib
import shutil
from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

from sqlalchemy import Column, Connection, Table, func, select, text

from sequence_planner.journal import run_journal
from sequence_planner.journal.run_tables import RUN
from sequence_planner.mes.tables import JOB_EVENTS, JOB_ORDERS, JOB_RESPONSES
from sequence_planner.retention.settings import DAY
from sequence_planner.storage.address import PostgresqlServer, SqliteFile

BLOCKS: Final = 16  # samples
_IN_BLOCK: Final = 32  # records
_BESIDE: Final = 150  # bytes of a record beside its content: hash, time, kind, place in the index
_ORDER: Final = 500  # bytes of an order
DAYS: Final = 14  # of growth that are told


@dataclass(frozen=True)
class Day:
    """What has come in a day that begins at `since`, in seconds since the epoch."""

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
    begin, end = run_journal.begin(connection).number, run_journal.end(connection)
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
    """What has come in each of the last days of which the database has all, the oldest first; the last one ends now."""
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
    """Whether what takes room from one takes it from the other."""
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
