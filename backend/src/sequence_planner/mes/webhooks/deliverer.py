"""Delivers events to all webhooks, side by side; to each one after the other."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections.abc import Callable
from functools import partial
from typing import TypeVar

import structlog
from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.mes.webhooks import deliveries
from sequence_planner.mes.webhooks.deliveries import Due, Pace
from sequence_planner.mes.webhooks.sealing import Seal, UnreadableSecretError, key_file
from sequence_planner.mes.webhooks.sending import Sender, Undelivered
from sequence_planner.mes.webhooks.signing import signed
from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 0.5  # seconds
LOOK_FOR_WEBHOOKS = 5.0  # seconds, where there are none: whoever makes one here says so
T = TypeVar("T")


class Deliverer:
    """Looks twice a second for what is to be delivered where there are webhooks, unless it `stands_by` for another that
    does.
    """

    def __init__(
        self,
        database: Database,
        sender: Sender,
        pace: Pace | None = None,
        now: Callable[[], float] = time.time,
        stands_by: Callable[[], bool] = lambda: False,
    ) -> None:
        self._database = database
        self._sender = sender
        self._seal = Seal(key_file(database.place))
        self._pace = pace or Pace()
        self._now = now
        self._stands_by = stands_by
        self._under_way: dict[str, asyncio.Task[None]] = {}
        self._in_trouble = False
        self._made = asyncio.Event()
        self._has_webhooks = True  # as far as it is known

    def look(self) -> None:
        """A webhook was made."""
        self._made.set()

    async def run(self) -> None:
        """Deliver until cancelled. What fails is tried again and again."""
        try:
            while True:
                self._made.clear()
                if not self._stands_by():
                    await self._look()
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(LOOK_EVERY if self._has_webhooks else LOOK_FOR_WEBHOOKS):
                        await self._made.wait()
        finally:
            for task in self._under_way.values():
                task.cancel()
            await asyncio.gather(*self._under_way.values(), return_exceptions=True)

    async def _look(self) -> None:
        try:
            self._has_webhooks, found = await self._read(partial(_waiting, now=self._now()))
            self._in_trouble = False
        except StorageError as error:
            self._note(str(error))
            return
        except Exception as error:  # whatever it is, the next look may be better
            LOG.exception("webhooks cannot be looked at")
            self._note(repr(error))
            return
        for webhook in found:
            if webhook not in self._under_way:
                task = self._under_way[webhook] = asyncio.create_task(self._deliver(webhook))
                task.add_done_callback(partial(self._done, webhook))

    def _done(self, webhook: str, task: asyncio.Task[None]) -> None:
        self._under_way.pop(webhook, None)

    async def _deliver(self, webhook: str) -> None:
        """All that is to be sent to one now."""
        try:
            await self._deliver_all(webhook)
        except StorageError as error:
            self._note(str(error))
        except Exception as error:  # of one webhook must not keep others from being told
            LOG.exception("a webhook cannot be told", webhook=webhook)
            self._note(repr(error))

    async def _deliver_all(self, webhook: str) -> None:
        while True:
            if await self._read(partial(deliveries.has_new, webhook=webhook)):
                await self._write(partial(deliveries.queue, webhook=webhook, now=self._now()))
            due = await self._read(partial(deliveries.due, webhook=webhook, now=self._now()))
            if due is None:
                return
            await self._send(due)

    async def _send(self, due: Due) -> None:
        try:
            secret = self._seal.open(due.secret, due.webhook)
        except (UnreadableSecretError, StorageError) as error:  # the event is not to blame, and waits
            LOG.error("a webhook's secret cannot be read", webhook=due.webhook, says=str(error))
            await self._hold(due.webhook, "its secret cannot be read; it is written in the server's log why")
            return
        body = json.dumps(due.event.model_dump(mode="json"), separators=(",", ":")).encode()
        headers = signed(secret, f"event-{due.event.number}", self._now(), body)
        try:
            await self._sender.post(due.url, headers, body)
        except Undelivered as undelivered:
            trouble, pace = str(undelivered), self._pace
            LOG.warning("an event was not delivered", webhook=due.webhook, number=due.event.number, why=trouble)
            await self._write(lambda connection: deliveries.failed(connection, due, trouble, pace, self._now()))
        else:
            await self._write(lambda connection: deliveries.delivered(connection, due, self._now()))

    async def _hold(self, webhook: str, trouble: str) -> None:
        await self._write(lambda connection: deliveries.hold(connection, webhook, trouble, self._pace, self._now()))

    async def _read(self, work: Callable[[Connection], T]) -> T:
        def inside() -> T:
            with self._database.reading() as connection:
                return work(connection)

        return await run_in_threadpool(inside)

    async def _write(self, work: Callable[[Connection], T]) -> T:
        def inside() -> T:
            with self._database.writing() as connection:
                return work(connection)

        return await run_in_threadpool(inside)

    def _note(self, reason: str) -> None:
        if not self._in_trouble:
            LOG.warning("webhooks cannot be told now", reason=reason)
        self._in_trouble = True


def _waiting(connection: Connection, now: float) -> tuple[bool, list[str]]:
    """Whether there are webhooks, and those for which there is something to do."""
    return deliveries.are_any(connection), deliveries.waiting(connection, now)
