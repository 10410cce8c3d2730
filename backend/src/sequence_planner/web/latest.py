"""A document for many clients, of which each gets the newest whenever it is ready for one.

Nothing waits in a queue: a client that is slow misses what was overtaken meanwhile, and slows nobody.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from sequence_planner.web.broadcast import Subscriber
from sequence_planner.web.settings import StreamLimits


class Latest:
    """`present` encodes the document as it is now; it is called once for each change and client."""

    def __init__(self, present: Callable[[], str], limits: StreamLimits) -> None:
        self.limits = limits
        self.somebody = asyncio.Event()  # whether anybody looks
        self._present = present
        self._subscribers: set[Subscriber] = set()

    @contextmanager
    def subscription(self, present: Callable[[], str] | None = None) -> Iterator[Subscriber | None]:
        """A subscriber for as long as the block lasts; None when there are too many already. With a `present` of its
        own it is shown a part.
        """
        if len(self._subscribers) >= self.limits.clients:
            yield None
            return
        subscriber = Subscriber(present or self._present, 0)
        self._subscribers.add(subscriber)
        self.somebody.set()
        try:
            yield subscriber
        finally:
            self._subscribers.discard(subscriber)
            if not self._subscribers:
                self.somebody.clear()

    def tell(self) -> None:
        """The document has changed."""
        for subscriber in self._subscribers:
            subscriber.resync()
