"""The lines that `journal archive` prints."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

from sequence_planner.db.database import Database
from sequence_planner.journal.archive import Archive
from sequence_planner.mes.retention import order_files


def archived(database: Database, folder: Path | None) -> Iterator[str]:
    """A line for each file that there is to be, the oldest first; `folder` is where the archive is by now."""
    archive = Archive(folder)
    with database.reading() as connection:
        index, of_orders = archive.index(connection), order_files(connection)
    for each in index.segments:
        path = archive.path(each)
        what = f"records {each.first} to {each.last}, {_archive_moment(each.since)} to {_archive_moment(each.until)}"
        yield _archive_line(path, each.size, what)
    for file in of_orders:
        until = _archive_moment(file.until)
        what = f"{file.orders} job orders, {file.events} events, {file.responses} responses, to {until}"
        yield _archive_line(file.path(folder), file.size, what)
    if not index.segments and not of_orders:
        yield "there is nothing in the archive"


def _archive_line(path: Path, size: int, what: str) -> str:
    gone = "" if path.is_file() else "  IS NOT THERE"
    return f"{path}  {size / 1e6:.1f} MB  {what}{gone}"


def _archive_moment(epoch: float) -> str:
    return datetime.fromtimestamp(epoch, UTC).strftime("%Y-%m-%d %H:%M:%S UTC")
