"""Whether the station can work: each check by itself, and why one fails, in words that name nothing secret."""

from __future__ import annotations

import asyncio
import time
from enum import StrEnum

import structlog
from anyio import to_thread

from sequence_planner.control.vocabulary import Production
from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.figures import Figures

LOG = structlog.get_logger(__name__)
PATIENCE = 2.0  # seconds in which the database has to write something
FRESH = 2.0  # seconds for which that it could counts, so that nobody wears it out by asking
MOST_APART = 2.0  # seconds between the time that a view tells and the time here


class ReadinessCheck(StrEnum):
    """What is looked at."""

    CONTROLLER = "controller"  # it is heard
    PREPARED = "prepared"  # the safe states are known, and the devices are its own to command
    JOURNAL = "journal"  # what happens is durable in time
    TIME = "time"  # its views are of now
    DATABASE = "database"  # it can be written to


SILENT = "The controller has been silent for two seconds."
WRONG = {
    ReadinessCheck.CONTROLLER: SILENT,
    ReadinessCheck.PREPARED: "The station is being prepared.",
    ReadinessCheck.JOURNAL: "What happens is not journalled in time, so nothing is started. The alarms say why.",
    ReadinessCheck.TIME: "The controller's time is not the server's: its views come late, or the clock was set.",
    ReadinessCheck.DATABASE: "The database cannot be written to. The server's log says why.",
}


class Readiness:
    """Looks whenever somebody asks."""

    def __init__(self, controller: ControllerClient, figures: Figures) -> None:
        self._controller = controller
        self._figures = figures
        self._turn = asyncio.Lock()
        self._due = 0.0  # on the clock of `time.monotonic`
        self._writable = False

    async def failing(self, database: Database) -> dict[ReadinessCheck, str]:
        """The checks that fail, with the reason of each; without any the station is ready.

        What nobody knows while the controller is silent fails too.
        """
        passed = {
            ReadinessCheck.CONTROLLER: self._controller.heard,
            ReadinessCheck.PREPARED: self._prepared(),
            ReadinessCheck.JOURNAL: await self._keeps_up(),
            ReadinessCheck.TIME: self._on_time(),
            ReadinessCheck.DATABASE: await self._can_be_written(database),
        }
        heard = passed[ReadinessCheck.CONTROLLER]
        of_it = (ReadinessCheck.PREPARED, ReadinessCheck.JOURNAL, ReadinessCheck.TIME)
        return {
            check: WRONG[check] if heard or check not in of_it else SILENT
            for check, is_so in passed.items()
            if not is_so
        }

    def _prepared(self) -> bool:
        view = self._controller.view
        return self._controller.heard and view is not None and view.production is not Production.PREPARING

    def _on_time(self) -> bool:
        view = self._controller.view
        return self._controller.heard and view is not None and abs(time.time() - view.time) <= MOST_APART

    async def _keeps_up(self) -> bool:
        figures = await self._figures.newest()
        if figures is None:
            return self._controller.heard and not self._prepared()  # nothing happens yet that is to be journalled
        return not figures.journal.behind

    async def _can_be_written(self, database: Database) -> bool:
        async with self._turn:
            if time.monotonic() >= self._due:
                self._writable = await _written(database)
                self._due = time.monotonic() + FRESH
            return self._writable


async def _written(database: Database) -> bool:
    try:
        async with asyncio.timeout(PATIENCE):
            await to_thread.run_sync(database.try_writing, abandon_on_cancel=True)
    except TimeoutError:
        LOG.error("the database cannot be written to", says=f"nothing was written within {PATIENCE:g} s")
        return False
    except StorageError as error:
        LOG.error("the database cannot be written to", says=str(error))
        return False
    return True
