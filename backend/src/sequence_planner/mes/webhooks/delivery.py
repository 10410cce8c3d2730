"""Webhook delivery: HTTP POST with retries, parallel across endpoints and in order for each."""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
import ssl
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, Final, TypeVar

import structlog
from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.mes.webhooks import deliveries
from sequence_planner.mes.webhooks.deliveries import Due, Pace
from sequence_planner.mes.webhooks.endpoints import Seal, UnreadableSecretError, key_file, signed
from sequence_planner.mes.webhooks.targets import Target, TargetRefused, Targets
from sequence_planner.texts.message import message

if TYPE_CHECKING:
    import httpx

# One attempt to deliver something: a POST that is answered with 2xx in time, or the reason why it was not.

_MOST_ADDRESSES: Final = 3  # that are tried


@dataclass(frozen=True)
class Patience:
    """Seconds for the connection, for each further step, and for all of an attempt."""

    connecting: float = 5.0
    reading: float = 10.0
    all: float = 15.0


class Undelivered(Exception):
    """It was not taken; the message says why."""


async def resolved(targets: Targets, target: Target) -> list[str]:
    """The addresses of a target, each of which may be sent to. Raises `TargetRefused` where one may not, or none is
    found.
    """
    try:
        found = await asyncio.get_running_loop().getaddrinfo(target.host, target.port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError):
        raise TargetRefused(message("target.unresolved", host=target.host)) from None
    addresses = list(dict.fromkeys(str(each[4][0]) for each in found))
    targets.judge(target, addresses)
    return addresses


class Sender:
    """Sends to `targets`. No redirect is followed, no proxy and no password of the environment is used."""

    def __init__(self, targets: Targets, patience: Patience | None = None) -> None:
        self._targets = targets
        self._patience = patience or Patience()

    async def post(self, url: str, headers: Mapping[str, str], body: bytes) -> None:
        """Deliver; raises `Undelivered`."""
        try:
            async with asyncio.timeout(self._patience.all):
                await self._post(url, headers, body)
        except TargetRefused as refused:
            raise Undelivered(str(refused.why)) from None
        except TimeoutError:
            raise Undelivered(f"there was no answer within {self._patience.all:g} s") from None

    async def _post(self, url: str, headers: Mapping[str, str], body: bytes) -> None:
        import httpx  # noqa: PLC0415 - most stations have no webhooks

        target = self._targets.target(url)
        addresses = await resolved(self._targets, target)
        given = {
            **headers,
            "host": target.authority,
            "content-type": "application/json",
            "user-agent": "sequence-planner",
        }
        # The name is checked against the certificate, though the address is connected to.
        named = {"sni_hostname": target.host}
        trouble = ""
        async with self._client() as client:
            for address in addresses[:_MOST_ADDRESSES]:
                request = client.build_request(
                    "POST", target.at(address), headers=given, content=body, extensions=named
                )
                try:
                    return await self._send(client, request)
                except httpx.ConnectError as error:
                    trouble = f"{target.host} cannot be connected to ({_words(error)})"
                except httpx.TimeoutException:
                    trouble = f"{target.host} does not answer in time"
                    break
                except (httpx.HTTPError, httpx.InvalidURL, ssl.SSLError, OSError) as error:
                    trouble = f"{target.host} breaks off ({_words(error)})"
                    break
        raise Undelivered(trouble)

    async def _send(self, client: httpx.AsyncClient, request: httpx.Request) -> None:
        response = await client.send(request, stream=True, follow_redirects=False)
        await response.aclose()  # its status says all; nothing of its body is read
        status = response.status_code
        if not 200 <= status < 300:
            also = "; redirects are not followed" if 300 <= status < 400 else ""
            raise Undelivered(f"it was answered with status {status}{also}")

    def _client(self) -> httpx.AsyncClient:
        """One for each attempt: a connection to an address must not be used again for another name."""
        import httpx  # noqa: PLC0415 - as above

        limits = httpx.Limits(max_connections=1, max_keepalive_connections=0)
        return httpx.AsyncClient(verify=self._trust, trust_env=False, timeout=self._timeout, limits=limits)

    @cached_property
    def _trust(self) -> ssl.SSLContext:
        """The authorities that this machine trusts, which a company adds its own to."""
        return ssl.create_default_context()

    @cached_property
    def _timeout(self) -> httpx.Timeout:
        import httpx  # noqa: PLC0415 - as above

        return httpx.Timeout(self._patience.reading, connect=self._patience.connecting)


def _words(error: Exception) -> str:
    return str(error)[:200] or type(error).__name__


# Delivers events to all webhooks, side by side; to each one after the other.

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

    def on_webhook(self) -> None:
        """A webhook was made."""
        self._made.set()

    async def run(self) -> None:
        """Deliver until cancelled. What fails is tried again and again."""
        try:
            while True:
                self._made.clear()
                if not self._stands_by():
                    await self._poll()
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(LOOK_EVERY if self._has_webhooks else LOOK_FOR_WEBHOOKS):
                        await self._made.wait()
        finally:
            for task in self._under_way.values():
                task.cancel()
            await asyncio.gather(*self._under_way.values(), return_exceptions=True)

    async def _poll(self) -> None:
        try:
            self._has_webhooks, found = await self._read(partial(_waiting, now=self._now()))
            self._in_trouble = False
        except StorageError as error:
            self._log_trouble(str(error))
            return
        except Exception as error:  # whatever it is, the next look may be better
            LOG.exception("webhooks cannot be looked at")
            self._log_trouble(repr(error))
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
            self._log_trouble(str(error))
        except Exception as error:  # of one webhook must not keep others from being told
            LOG.exception("a webhook cannot be told", webhook=webhook)
            self._log_trouble(repr(error))

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

    def _log_trouble(self, reason: str) -> None:
        if not self._in_trouble:
            LOG.warning("webhooks cannot be told now", reason=reason)
        self._in_trouble = True


def _waiting(connection: Connection, now: float) -> tuple[bool, list[str]]:
    """Return whether there are webhooks, and those for which there is something to do."""
    return deliveries.are_any(connection), deliveries.waiting(connection, now)
