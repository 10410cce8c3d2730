"""A connection to a rosbridge server, which comes back by itself.

roslibpy keeps it, on an event loop and a thread of its own that all connections of the process share. What it would do
with messages it does not know (a traceback each), and with those sent while there is no connection (send them whenever
there is one again), is not for commands to machines: messages are taken here as they come, and sent now or not at all.
"""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

from roslibpy import Message
from roslibpy.comm.comm_asyncio import (
    AsyncioEventLoopManager,
    AsyncioRosBridgeClientFactory,
    AsyncioRosBridgeProtocol,
)

FIRST_PAUSE = 0.3  # seconds before the first attempt to come back
LONGEST_PAUSE = 3.0  # seconds between two attempts
PING_EVERY = 2.0  # seconds
SILENCE = 3.0  # seconds without an answer to a ping after which the connection is lost
LONGEST_MESSAGE = 64 * 2**20  # bytes
LEAVE_TAKING = 1.0  # seconds to say goodbye to the server

# Its troubles are seen here, and said once.
logging.getLogger("roslibpy").setLevel(logging.CRITICAL)

_open: set[RosbridgeClient] = set()
_lock = threading.Lock()


@dataclass(frozen=True)
class Events:
    """What is called, on roslibpy's thread: when there is a connection, with each frame, and when there is none."""

    opened: Callable[[], None]
    frame: Callable[[bytes], None]
    closed: Callable[[], None]


class _Protocol(AsyncioRosBridgeProtocol):
    factory: _Factory

    def connection_made(self, transport: asyncio.Transport) -> None:
        super().connection_made(transport)
        self.factory.transport = transport

    def on_message(self, payload: bytes) -> None:
        self.factory.events.frame(payload)


class _Factory(AsyncioRosBridgeClientFactory):
    protocol = _Protocol

    def __init__(self, url: str, events: Events) -> None:
        super().__init__(url)
        self.events = events
        self.transport: asyncio.Transport | None = None  # the last one, which may still be shaking hands, or be closed
        self.setProtocolOptions(
            autoPingInterval=PING_EVERY,
            autoPingTimeout=SILENCE,
            openHandshakeTimeout=SILENCE,
            maxMessagePayloadSize=LONGEST_MESSAGE,
        )


_Factory.set_initial_delay(FIRST_PAUSE)
_Factory.set_max_delay(LONGEST_PAUSE)


class RosbridgeClient:
    """One connection. Its methods may be called on any thread but roslibpy's, and do not wait; only `close` does."""

    def __init__(self, url: str, events: Events) -> None:
        """Begin to connect to `url`, such as `ws://127.0.0.1:9090`; raises ValueError when it is no such address."""
        _check(url)
        self._protocol: AsyncioRosBridgeProtocol | None = None
        self._closing = False
        self._gone = threading.Event()
        self._gone.set()
        with _lock:
            self._factory = _Factory(url, events)
            _open.add(self)
        self._factory.on("ready", self._ready)
        self._factory.on("close", self._lost)
        self._factory.connect()

    @property
    def connected(self) -> bool:
        """Whether there is a connection."""
        return self._protocol is not None

    def send(self, message: Mapping[str, object]) -> bool:
        """Send a message of the protocol; returns False, with nothing sent then or later, without a connection."""
        protocol = self._protocol
        if protocol is None:
            return False
        protocol.send_ros_message(Message(message))
        return True

    def close(self) -> None:
        """Take leave of the server; the last client to close ends roslibpy's thread. May be repeated."""
        self._closing = True
        self._factory.maxRetries = 0
        protocol = self._protocol
        if protocol is not None:
            protocol.send_close()
            self._gone.wait(LEAVE_TAKING)
        transport = self._factory.transport
        if transport is not None and not transport.is_closing():
            self._factory.manager.loop.call_soon_threadsafe(transport.abort)
        with _lock:
            if self in _open:
                _open.discard(self)
                if not _open:
                    _end(self._factory.manager)

    def _ready(self, protocol: AsyncioRosBridgeProtocol) -> None:
        if self._closing:
            protocol.send_close()
            return
        self._gone.clear()
        self._protocol = protocol
        self._factory.events.opened()

    def _lost(self, protocol: AsyncioRosBridgeProtocol) -> None:
        self._protocol = None
        if not self._closing:
            self._factory.events.closed()
        self._gone.set()


def _check(url: str) -> None:
    parts = urlsplit(url)
    if parts.scheme not in ("ws", "wss"):
        raise ValueError("it begins with ws:// or wss://")
    if not parts.hostname or parts.port == 0:
        raise ValueError("it has a host, and a port other than 0")


def _end(manager: AsyncioEventLoopManager) -> None:
    """Give up what is under way on roslibpy's loop, and end its thread."""

    async def give_up() -> None:
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await asyncio.sleep(0)  # in which connections that were broken off are closed

    asyncio.run_coroutine_threadsafe(give_up(), manager.loop).result(LEAVE_TAKING)
    manager.terminate()
