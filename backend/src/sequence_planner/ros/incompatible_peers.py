"""Peers at our services whose middleware writes calls otherwise: they are neither asked nor answered, and named once.

DDS brings them together with our endpoints all the same, and cannot read what they send.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection

import structlog

from sequence_planner.ros.environment import worded
from sequence_planner.ros.transport import ServiceEnd

_log = structlog.get_logger(__name__)

_EVERY = 1.0  # seconds between two looks


class Strangers:
    """Looks for them as long as there are services. All methods belong on the event loop's thread."""

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        ends_of: Callable[[Collection[str]], Collection[ServiceEnd]],
        there_are: Callable[[bool], None] = lambda _: None,
    ) -> None:
        """Begin without services.

        `ends_of` gives the ends of those named that are on the network now; `there_are` is told at each look whether
        any of them is such a peer.
        """
        self._loop = loop
        self._ends_of = ends_of
        self._there_are = there_are
        self._services: set[str] = set()
        self._seen: set[ServiceEnd] = set()
        self._told: set[ServiceEnd] = set()
        self._next: asyncio.TimerHandle | None = None

    def add(self, service: str) -> None:
        """Look at the ends of a service, from now on."""
        self._services.add(service)
        if self._next is None:
            self._look()

    def close(self) -> None:
        """Look no more."""
        if self._next is not None:
            self._next.cancel()
        self._there_are(False)

    def _look(self) -> None:
        self._next = self._loop.call_later(_EVERY, self._look)
        there = {end for end in self._ends_of(self._services) if not (end.own or end.understood)}
        self._there_are(bool(there))
        # Its name comes a moment later than the peer itself.
        news = {end for end in there if end.node is not None or end in self._seen} - self._told
        for end in news:
            _log.warning(
                "a peer whose calls are written otherwise is neither asked nor answered: "
                "run both with the same RMW_IMPLEMENTATION",
                service=end.service,
                peer=end.node or "not named",
                role=end.role,
                middleware=worded(end.vendor),
            )
        self._seen, self._told = there, (self._told & there) | news
