"""Whether starting the server again would help: it does where its own way to the database is shut and another is open.

A database that nobody can reach comes back by itself, and the station goes on meanwhile: that is no reason to end it.
"""

from __future__ import annotations

import asyncio
import contextlib
import time

import structlog
from anyio import CapacityLimiter, to_thread
from sqlalchemy import Connection, text

from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError
from sequence_planner.web.identity import IdentityOffice

LOG = structlog.get_logger(__name__)
EVERY = 2.0  # seconds between two looks
PATIENCE = 2.0  # seconds in which a database answers
SHUT_AFTER = 10.0  # seconds for which it must be so: many who ask at once are no reason


class WayToDatabase:
    """Looks whenever somebody asks, in the background: who asks hears at once what was found last."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._looking: asyncio.Task[None] | None = None
        self._due = 0.0  # on the clock of `time.monotonic`, as is the next
        self._shut_since: float | None = None
        self._threads: CapacityLimiter | None = None  # others may have taken all that there are

    def is_shut(self, office: IdentityOffice) -> bool:
        """Whether nothing has come through it for a while that would have come through another."""
        now = time.monotonic()
        if now >= self._due and (self._looking is None or self._looking.done()):
            self._due = now + EVERY
            self._looking = asyncio.create_task(self._look(office))
        return self._shut_since is not None and now - self._shut_since >= SHUT_AFTER

    async def _look(self, office: IdentityOffice) -> None:
        if await self._answers(office) or not await self._would_answer():
            self._shut_since = None
        elif self._shut_since is None:
            self._shut_since = time.monotonic()
            LOG.error("the server's connections to the database are stuck, and a new one is not")

    async def _answers(self, office: IdentityOffice) -> bool:
        try:
            async with asyncio.timeout(PATIENCE):
                await office.read(_ask)
        except (TimeoutError, StorageError):
            return False
        return True

    async def _would_answer(self) -> bool:
        if self._threads is None:
            self._threads = CapacityLimiter(1)
        try:
            async with asyncio.timeout(PATIENCE):
                await to_thread.run_sync(self._try, abandon_on_cancel=True, limiter=self._threads)
        except (TimeoutError, StorageError):
            return False
        return True

    def _try(self) -> None:
        with contextlib.closing(Database.open(self._url, create=False)) as another, another.reading() as connection:
            _ask(connection)


def _ask(connection: Connection) -> None:
    connection.execute(text("SELECT 1"))
