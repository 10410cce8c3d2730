"""Message delivery from middleware threads to the event loop, request tasks, and type mismatch reports."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable, Iterable

import structlog

from sequence_planner.ros.qos import Direction, QualityOfService, disagreements
from sequence_planner.ros.transport import Handler, NetworkEndpoint, NoServerError, OnBatch, Sample

# Peers that do not agree with one of our own endpoints, in words.


def both_sides(graph: Iterable[NetworkEndpoint], topic: str, direction: Direction, quality: QualityOfService) -> str:
    """Say what each peer of our endpoint offers or wants otherwise; empty when they have gone again."""
    found = []
    for peer in graph:
        if peer.topic == topic and peer.direction != direction:
            sides = (quality, peer.quality) if direction == "publisher" else (peer.quality, quality)
            who = "this node" if peer.own else peer.node or "another node"
            found += [f"{text} ({who})" for text in disagreements(*sides)]
    return "; ".join(found)


# From a middleware's thread to the event loop.
#
# Waking the loop once per sample costs more than the samples do, so samples wait in a queue, the first one wakes the
# loop and the loop takes all that have come by then as one batch. The queue is bounded in samples and in bytes: a loop
# that stands still loses the oldest samples, as DDS itself does, and the log says so.

_log = structlog.get_logger(__name__)

#: Samples of one subscription that may wait for the loop.
CAPACITY = 10_000

#: Bytes of one subscription that may wait for the loop. The newest sample may always, however large it is.
CAPACITY_BYTES = 64 * 2**20


class Delivery:
    """The queue of one subscription. `push` may be called on any thread, the rest on the loop's."""

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        topic: str,
        on_batch: OnBatch,
        capacity: int = CAPACITY,
        capacity_bytes: int = CAPACITY_BYTES,
    ) -> None:
        self._loop = loop
        self._topic = topic
        self._on_batch = on_batch
        self._capacity = capacity
        self._capacity_bytes = capacity_bytes
        self._waiting: deque[Sample] = deque()
        self._bytes = 0
        self._lost = 0
        self._awake = False
        self._closed = False
        self._lock = threading.Lock()

    def push(self, samples: Iterable[Sample]) -> None:
        """Queue `samples` and wake the loop if it is not awake already."""
        with self._lock:
            if self._closed:
                return
            for sample in samples:
                self._waiting.append(sample)
                self._bytes += len(sample.data)
                while len(self._waiting) > self._capacity or (
                    self._bytes > self._capacity_bytes and len(self._waiting) > 1
                ):
                    self._bytes -= len(self._waiting.popleft().data)
                    self._lost += 1
            wake = bool(self._waiting) and not self._awake
            self._awake = self._awake or wake
        if wake:
            try:
                self._loop.call_soon_threadsafe(self._deliver)
            except RuntimeError:  # The loop has been closed: nobody listens any more.
                self.close()

    def close(self) -> None:
        """Deliver nothing from now on."""
        with self._lock:
            self._closed = True
            self._waiting.clear()

    def _deliver(self) -> None:
        with self._lock:
            batch, lost = tuple(self._waiting), self._lost
            self._waiting.clear()
            self._bytes = 0
            self._lost = 0
            self._awake = False
        if lost:
            _log.warning("samples lost: the event loop did not keep up", topic=self._topic, lost=lost)
        if batch:
            self._on_batch(batch)


# Answering requests: one task each, so that a slow answer holds nothing up.

#: Requests of one transport that may be answered at a time; more are dropped, and the log says so when it begins.
CALLS_CAPACITY = 1000


class Serving:
    """The requests that a transport is answering. All methods belong on the event loop's thread."""

    def __init__(self) -> None:
        self._tasks: set[asyncio.Task[None]] = set()
        self._dropping = False

    def answer(self, service: str, handler: Handler, request: bytes, respond: Callable[[bytes], None]) -> None:
        """Have `respond` called with what `handler` makes of `request`; a handler that fails is logged."""
        if len(self._tasks) >= CALLS_CAPACITY:
            if not self._dropping:
                _log.warning("requests dropped: too many are being answered", service=service, limit=CALLS_CAPACITY)
            self._dropping = True
            return
        self._dropping = False
        task = asyncio.get_running_loop().create_task(_answer(service, handler, request, respond))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def close(self) -> None:
        """Answer nothing any more."""
        for task in self._tasks:
            task.cancel()
        self._tasks.clear()


async def _answer(service: str, handler: Handler, request: bytes, respond: Callable[[bytes], None]) -> None:
    try:
        respond(await handler(request))
    except Exception:
        _log.exception("a request could not be answered", service=service)


def check_hashes(service: str, type_name: str, theirs: str | None, ours: str) -> None:
    """Raise NoServerError when a server tells that it was built with another definition of the service."""
    if theirs not in (None, ours):
        raise NoServerError(
            f"{service} is served with another definition of {type_name}: theirs is {theirs}, ours is {ours}. "
            "Nothing was sent; build both with the same file"
        )
