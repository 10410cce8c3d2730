"""Retention of a running station: a pass now and then, each in a process of its own, and how much there is of what."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import structlog
from sqlalchemy import Connection

from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.location import SqliteFile, backups_folder
from sequence_planner.journal import run_journal
from sequence_planner.journal.archive import Archive, Index
from sequence_planner.journal.run_journal import RecordPlace
from sequence_planner.mes.retention import OrderFile, order_files
from sequence_planner.process.task import BackgroundTask, WorkerError
from sequence_planner.retention import retention as folder
from sequence_planner.retention.retention import (
    Day,
    Done,
    RetentionTask,
    are_on_one_disk,
    database_size,
    folder_size,
    free_on_disk,
    growth,
    orders_size,
    run_blocks,
)
from sequence_planner.retention.settings import Retention
from sequence_planner.server.services.identity import IdentityService

LOG = structlog.get_logger(__name__)
FIRST_AFTER: Final = 60.0  # seconds after the start: what is needed to produce comes first
EVERY: Final = 600.0  # seconds between two passes
SOON: Final = 5.0  # seconds where the last pass has left something to do
LONGEST: Final = 3600.0  # seconds after which a pass is given up
_NICENESS: Final = 10  # below the station and what people wait for


@dataclass(frozen=True)
class Sizes:
    """Bytes of each: of the database with what is `unused` in it, of what happened and of job orders, estimated, of the
    archive, of backups; and what is free on their disks, if that is known.
    """

    database: int
    unused: int
    journal: int
    orders: int
    archive: int
    backups: int
    free: int | None
    archive_free: int | None

    def told(self) -> Iterator[tuple[str, int]]:
        """Those that are known, each with its name."""
        for name, size in vars(self).items():
            if size is not None:
                yield name, size


@dataclass(frozen=True)
class RetentionState:
    """The state of retention now. `bounds` are of the database; `missing` are files of the archive that are not where
    they were.
    """

    sizes: Sizes
    days: tuple[Day, ...]
    bounds: tuple[RecordPlace, RecordPlace] | None
    index: Index
    orders: tuple[OrderFile, ...]
    missing: tuple[str, ...]


class RetentionService:
    """Has passes done on one event loop; by itself only unless it `stands_by` for another that does."""

    def __init__(
        self,
        office: IdentityService,
        url: str,
        model: Path,
        retention: Retention,
        stands_by: Callable[[], bool] = lambda: False,
    ) -> None:
        self.retention = retention
        self.folder = folder.place(retention.folder, url, model)
        self.busy: Actor | None = None
        self.last_done: float | None = None
        self.done: Done | None = None
        self.trouble: str | None = None
        self.sizes: Sizes | None = None
        self._office, self._url, self._model = office, url, model
        self._stands_by = stands_by
        self._archive = Archive(retention.folder)
        self._asked: Actor | None = None
        self._poked = asyncio.Event()

    async def run(self) -> None:
        """Do what is due until cancelled."""
        await self._rest(FIRST_AFTER)
        while True:
            by, self._asked = self._asked, None
            if by is not None or not self._stands_by():
                await self._pass(by)
            more = self.trouble is None and self.done is not None and self.done.more
            await self._rest(SOON if more else EVERY)

    def ask(self, by: Actor) -> None:
        """Have a pass done now, in which little is not left for later."""
        if self.busy is None:
            self._asked = self.busy = by
            self._poked.set()

    async def look(self) -> RetentionState:
        """Return how it is now. Raises `StorageError`."""
        looked = await self._office.read(self._looked)
        self.sizes = looked.sizes
        return looked

    async def _rest(self, seconds: float) -> None:
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                await self._poked.wait()
        self._poked.clear()

    async def _pass(self, by: Actor | None) -> None:
        self.busy = by or SYSTEM
        task = RetentionTask(self._url, self._model, self.retention, self.busy, everything=by is not None)
        work = BackgroundTask(folder.do, (task,), "retention", _NICENESS, errors=(StorageError,), leads=True)
        trouble: str | None = None
        try:
            async with asyncio.timeout(LONGEST):
                done = await work.found()
            self.done, self.last_done = done, self._office.now()
            if done.records or done.orders or done.removed:
                LOG.info("what is old was cut", records=done.records, orders=done.orders, files_removed=done.removed)
            await self.look()
        except StorageError as error:
            trouble = str(error)
        except (WorkerError, TimeoutError) as error:
            trouble = f"its process has ended too early ({type(error).__name__}): is memory short? It is tried again"
        except Exception as error:  # whatever it is, the next pass may be better
            LOG.exception("retention failed")
            trouble = repr(error)
        if trouble is not None and trouble != self.trouble:
            LOG.warning("what is old cannot be cut: the database grows", reason=trouble)
        self.trouble, self.busy = trouble, None

    def _looked(self, connection: Connection) -> RetentionState:
        place, blocks = self._office.database.place, run_blocks(connection)
        size, unused = database_size(connection, place)
        index, orders = self._archive.index(connection), order_files(connection)
        paths = [*(self._archive.path(each) for each in index.segments), *(each.path() for each in orders)]
        free = free_on_disk(place.path) if isinstance(place, SqliteFile) else None
        same_disk = isinstance(place, SqliteFile) and are_on_one_disk(place.path, self.folder)
        sizes = Sizes(
            database=size,
            unused=unused,
            journal=blocks.size,
            orders=orders_size(connection),
            archive=sum(each.size for each in index.segments) + sum(each.size for each in orders),
            backups=folder_size(backups_folder(self._url, self._model)),
            free=free,
            archive_free=free if same_disk else free_on_disk(self.folder),
        )
        missing = tuple(str(path) for path in paths if not path.is_file())
        days = growth(connection, self._office.now(), blocks)
        return RetentionState(sizes, days, run_journal.bounds(connection), index, orders, missing)
