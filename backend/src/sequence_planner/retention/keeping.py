"""One pass of retention: what is too old, or too much, goes to the archive, and from there where a limit is set.

It does a bounded amount of work, and others write in between. Whatever ends it, the next one goes on from there.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pydantic import JsonValue
from sqlalchemy import Connection, select

from sequence_planner.actor import Actor
from sequence_planner.journal import audit, retention, run_journal
from sequence_planner.journal.archive import REMOVED, Archive, Segment
from sequence_planner.journal.entry import Entry
from sequence_planner.journal.retention import MOST_IN_FILE
from sequence_planner.mes.retention import FILES_REMOVED, OrderFile, cut_orders, order_files
from sequence_planner.mes.tables import JOB_LEDGER
from sequence_planner.retention.folder import usable
from sequence_planner.retention.settings import DAY, GB, Retention
from sequence_planner.retention.sizes import run_blocks
from sequence_planner.storage.database import Database

MOST_FILES: Final = 10  # of each kind in one pass
_LEAST: Final = DAY  # seconds; so much goes to a file at once, or `MOST_IN_FILE` records


@dataclass(frozen=True)
class Task:
    """A pass for the station in the folder `model`; with `everything` little is not left for later."""

    url: str
    model: Path | None
    retention: Retention
    by: Actor
    everything: bool = False


@dataclass(frozen=True)
class Done:
    """How many records, and job orders, events or responses were cut; with `more` another pass finds more to do."""

    records: int = 0
    orders: int = 0
    removed: int = 0
    more: bool = False


def do(task: Task, tell: Callable[[object], None] = lambda _: None) -> Done:
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
                before = run_journal.begin(connection).number
            if not retention.cut(database, snapshot, task.by, folder):
                break
            retention.remove(database)
            with database.reading() as connection:
                records += run_journal.begin(connection).number - before
            files += 1
            tell(files)
        if files:
            retention.sign(database)
        limit = now - settings.order_days * DAY
        least = None if task.everything else limit - _LEAST
        while batches < MOST_FILES and (cut := cut_orders(database, limit, task.by, time.time(), folder, least)):
            orders, batches = orders + cut, batches + 1
            tell(files + batches)
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
    first = run_journal.get(connection, run_journal.begin(connection).number + 1)
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
