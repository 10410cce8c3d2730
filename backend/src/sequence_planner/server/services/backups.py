"""Backups of a running station: one is made or checked at a time, by a process of its own; the journal says by whom.

Whoever asks while one is being made gets that one. The folder may be on a disk of the network that does not answer:
looking there has threads of its own, so that nobody else waits for it.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import structlog
from anyio import CapacityLimiter, to_thread
from pydantic import JsonValue

from sequence_planner.backup import service
from sequence_planner.backup.archive import How, Maker
from sequence_planner.backup.errors import trouble_in
from sequence_planner.backup.service import (
    BackupFolderState,
    BackupTask,
    Doing,
    Recorded,
    Shelf,
    Step,
    carried_out,
)
from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.journal.entry import Outcome
from sequence_planner.server.services.identity import IdentityService

LOG = structlog.get_logger(__name__)
T = TypeVar("T")
LOOK_EVERY = 60.0  # seconds between looks whether one is due
PATIENCE = 4.0  # seconds in which the folder must answer
AGAIN_AFTER = 0.25  # of the hours between two, after which what failed is tried again


@dataclass(frozen=True)
class Busy:
    """The work being done now, since when, for whom, and how far it has come."""

    doing: Doing
    file: str
    begun: float
    by: Actor
    step: Step | None = None


class OtherBusyError(Exception):
    """Something else is done just now."""

    def __init__(self, busy: Busy) -> None:
        super().__init__(busy.file)
        self.busy = busy


class CannotBeginError(Exception):
    """Something is in the way of a backup."""

    def __init__(self, trouble: StorageError) -> None:
        super().__init__(str(trouble))
        self.trouble = trouble


class FolderSilentError(Exception):
    """The folder does not answer."""


class BackupService:
    """Makes and checks backups on one event loop; by itself only unless it `stands_by` for another that does."""

    def __init__(self, office: IdentityService, shelf: Shelf, stands_by: Callable[[], bool] = lambda: False) -> None:
        self.shelf = shelf
        self.busy: Busy | None = None
        self.newest: float | None = None  # when it was made, as far as was seen; seconds since the epoch
        self._office = office
        self._stands_by = stands_by
        self._working: asyncio.Task[None] | None = None
        self._beginning = asyncio.Lock()
        self._threads = CapacityLimiter(2)
        self._in_trouble = False

    async def run(self) -> None:
        """Make a backup whenever one is due, until cancelled; then end what is being done."""
        try:
            with contextlib.suppress(FolderSilentError, OSError):
                await self._in_thread(self.shelf.clear)
            while True:
                try:
                    await self._make_if_due()
                    self._in_trouble = False
                except Exception as error:  # whatever it is, the next look may be better
                    if not self._in_trouble:
                        LOG.warning("it cannot be seen whether a backup is due", reason=repr(error))
                    self._in_trouble = True
                await asyncio.sleep(LOOK_EVERY)
        finally:
            if self._working is not None:
                self._working.cancel()
                await asyncio.gather(self._working, return_exceptions=True)

    async def look(self) -> BackupFolderState:
        """The folder as it is now. Raises `FolderSilentError`."""
        looked = await self._in_thread(self.shelf.folder_state)
        times = [each.manifest.time for each in looked.backups if each.manifest is not None]
        self.newest = max(times, default=None)
        return looked

    async def recorded(self) -> Recorded:
        """Return what the journal tells of the latest. Raises `StorageError`."""
        return await self._office.read(service.recorded)

    async def make(self, by: Actor, how: How = How.ASKED) -> Busy:
        """Begin to make one, or join who has.

        Raises `CannotBeginError` where something is in the way, and otherwise as `check` does.
        """
        async with self._beginning:
            if self.busy is not None and self.busy.doing is Doing.MAKING:
                return self.busy
            if self.busy is None and (trouble := (await self.look()).trouble) is not None:
                raise CannotBeginError(trouble)
            now = self._office.now()
            file = await self._in_thread(lambda: self.shelf.new(now))
            return await self._begin(Doing.MAKING, file, by, Maker(how=how, name=by.name))

    async def check(self, name: str, by: Actor) -> Busy | None:
        """Begin to read a backup as a whole; None where there is none of this name.

        Raises `OtherBusyError`, `FolderSilentError` and `StorageError`.
        """
        async with self._beginning:
            if self.busy is not None and (self.busy.doing, self.busy.file) == (Doing.CHECKING, name):
                return self.busy
            file = await self._in_thread(lambda: self.shelf.find(name))
            return None if file is None else await self._begin(Doing.CHECKING, file, by, None)

    async def _begin(self, doing: Doing, file: Path, by: Actor, maker: Maker | None) -> Busy:
        if self.busy is not None:
            raise OtherBusyError(self.busy)
        now = self._office.now()
        person = by if by.session is not None else None
        number = await self._office.write(
            lambda connection: service.begun(connection, doing, by, file.name, now), by=person
        )
        shelf = self.shelf
        self.busy = busy = Busy(doing, file.name, now, by)
        task = BackupTask(shelf.url, shelf.model, shelf.keeping, file, maker)
        self._working = asyncio.create_task(self._work(busy, task, number))
        return busy

    async def _work(self, busy: Busy, task: BackupTask, number: int) -> None:
        outcome, details = Outcome.DONE, dict[str, JsonValue]()
        try:
            finished = await carried_out(task, self._step)
            if finished.removed:
                details = {"removed": list(finished.removed)}
        except StorageError as error:
            outcome, details = Outcome.FAILED, {"trouble": trouble_in(error), "why": str(error)}
            LOG.warning("a backup is not there or not whole", doing=busy.doing, file=busy.file, why=str(error))
        except Exception as error:
            outcome, details = Outcome.FAILED, {"trouble": trouble_in(StorageError()), "why": repr(error)}
            LOG.exception("a backup failed", doing=busy.doing, file=busy.file)
        finally:
            self.busy = None
        now = self._office.now()
        try:
            await self._office.write(
                lambda connection: service.ended(
                    connection, busy.doing, busy.by, busy.file, now, outcome=outcome, about=number, details=details
                )
            )
            await self.look()
        except (StorageError, FolderSilentError) as error:
            LOG.warning("it cannot be recorded how a backup ended", file=busy.file, outcome=outcome, reason=str(error))

    def _step(self, step: Step) -> None:
        if self.busy is not None:
            self.busy = replace(self.busy, step=step)

    async def _make_if_due(self) -> None:
        looked = await self.look()
        every, now = self.shelf.keeping.every, self._office.now()
        if every is None or self._stands_by() or self.busy is not None:
            return
        times = [each.manifest.time for each in looked.backups if each.manifest is not None]
        if not self.shelf.keeping.is_due(times, now):
            return
        last = (await self.recorded()).made
        if last is not None and last.outcome is not Outcome.DONE and 0 <= now - last.time < AGAIN_AFTER * every * 3600:
            return
        await self.make(SYSTEM, How.SCHEDULE)

    async def _in_thread(self, work: Callable[[], T]) -> T:
        try:
            async with asyncio.timeout(PATIENCE):
                return await to_thread.run_sync(work, abandon_on_cancel=True, limiter=self._threads)
        except TimeoutError:
            raise FolderSilentError(str(self.shelf.folder)) from None
