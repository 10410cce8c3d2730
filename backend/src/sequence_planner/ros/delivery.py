"""From a middleware's thread to the event loop.

Waking the loop once per sample costs more than the samples do, so samples wait in a queue, the first one wakes the loop
and the loop takes all that have come by then as one batch. The queue is bounded: a loop that stands still loses the
oldest samples, as DDS itself does, and the log says so.
"""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Iterable

import structlog

from sequence_planner.ros.transport import OnBatch, Sample

_log = structlog.get_logger(__name__)

#: Samples of one subscription that may wait for the loop.
CAPACITY = 10_000


class Delivery:
    """The queue of one subscription. `push` may be called on any thread, the rest on the loop's."""

    def __init__(
        self, loop: asyncio.AbstractEventLoop, topic: str, on_batch: OnBatch, capacity: int = CAPACITY
    ) -> None:
        self._loop = loop
        self._topic = topic
        self._on_batch = on_batch
        self._waiting: deque[Sample] = deque(maxlen=capacity)
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
                self._lost += len(self._waiting) == self._waiting.maxlen
                self._waiting.append(sample)
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
            self._lost = 0
            self._awake = False
        if lost:
            _log.warning("samples lost: the event loop did not keep up", topic=self._topic, lost=lost)
        if batch:
            self._on_batch(batch)
