"""The server process: binds its port, then serves until it is told to stop.

The port is bound and the database opened before anything else is built, so that what cannot be used is said at once and
in plain words.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import resource
import signal
import socket
import ssl
import sys
from collections.abc import Iterator
from functools import partial
from types import FrameType
from typing import Any, NoReturn, cast

import uvicorn

from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.server.app import create_app
from sequence_planner.server.binding import bind, check_demonstration, server_context
from sequence_planner.server.http.connections import IDLE_SECONDS, PromptConnection, Stream
from sequence_planner.server.http.middleware import ACCEPTED_AT_ONCE, Crowd
from sequence_planner.server.settings import Endpoint, Settings, SettingsError

LARGEST_FRAME = 1024 * 1024  # bytes; up to here the stream explains what is wrong, beyond the connection is closed
# What uvicorn takes for an error whenever a handshake is refused, though the refusal was sent.
REFUSED_HANDSHAKE = "ASGI callable returned without completing handshake."
OPEN_FILES = 8192  # connections that never finish a TLS handshake are kept for a minute and must not use them up


def uvicorn_config(settings: Settings) -> uvicorn.Config:
    """Return how uvicorn serves the station. Raises `SettingsError` when its certificate cannot be used."""
    tls, crowd = _tls(settings), Crowd()
    return uvicorn.Config(
        create_app(settings, ControllerClient(settings.controller_socket)),
        http=cast(Any, partial(PromptConnection, crowd=crowd, proxies=settings.proxies)),
        ws=cast(Any, partial(Stream, crowd=crowd)),
        ws_max_size=LARGEST_FRAME,
        ws_per_message_deflate=False,  # what is secret and what an attacker chose are not compressed together
        ssl_context_factory=None if tls is None else lambda *_: tls,
        proxy_headers=False,  # `Forwarded` believes one hop only, uvicorn as many as there are known addresses
        server_header=False,
        access_log=False,
        log_config=None,  # its events are written as all others are
        log_level="warning",
        backlog=ACCEPTED_AT_ONCE,
        timeout_keep_alive=IDLE_SECONDS,
        timeout_graceful_shutdown=2,
    )


def serve(settings: Settings, listener: socket.socket | None = None) -> None:
    """Serve until SIGTERM or SIGINT, whoever connects to `listener`, which is made if there is none.

    Exits with code 2 and a message when host, port, certificate or database cannot be used.
    """
    with _refusing():
        if settings.demonstration:
            check_demonstration(settings)
        listener = listener or bind(settings)
        _require_database(settings)
        config = uvicorn_config(settings)
    _run(config, listener)


def _run(config: uvicorn.Config, listener: socket.socket) -> None:
    # uvicorn ends in good order and then lets the signal have its way: this process removes what is its own first.
    signal.signal(signal.SIGTERM, _end)
    logging.getLogger("uvicorn.error").addFilter(lambda record: record.msg != REFUSED_HANDSHAKE)
    _allow_open_files()
    _Server(config).run(sockets=[listener])


class _Server(uvicorn.Server):
    """Looks at its clock once a second where uvicorn does so ten times; what ends it is heard at once all the same."""

    _ending: asyncio.Event | None = None

    async def main_loop(self) -> None:
        """Wait until it is to end."""
        self._loop, self._ending = asyncio.get_running_loop(), asyncio.Event()
        while not await self.on_tick(0):
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(1.0):
                    await self._ending.wait()

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """A signal has come."""
        super().handle_exit(sig, frame)
        if self._ending is not None:
            self._loop.call_soon_threadsafe(self._ending.set)


def _end(number: int, frame: FrameType | None) -> NoReturn:
    raise SystemExit(128 + number)


def _require_database(settings: Settings) -> None:
    with contextlib.closing(Database.open(settings.database)) as database:
        database.upgrade()


@contextlib.contextmanager
def _refusing() -> Iterator[None]:
    try:
        yield
    except (SettingsError, StorageError) as refused:
        sys.stderr.write(f"{refused}\n")
        raise SystemExit(2) from refused


def _tls(endpoint: Endpoint) -> ssl.SSLContext | None:
    if endpoint.certificate is None or endpoint.private_key is None:
        return None
    return server_context(endpoint.certificate, endpoint.private_key)


def _allow_open_files() -> None:
    """Let this process have as many files open as it may, up to what connections can need."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = OPEN_FILES if hard == resource.RLIM_INFINITY else min(hard, OPEN_FILES)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
