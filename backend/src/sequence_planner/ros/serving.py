"""Answering requests: one task each, so that a slow answer holds nothing up."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import structlog

from sequence_planner.ros.transport import Handler, NoServerError

_log = structlog.get_logger(__name__)

#: Requests of one transport that may be answered at a time; more are dropped, and the log says so when it begins.
CAPACITY = 1000


class Serving:
    """The requests that a transport is answering. All methods belong on the event loop's thread."""

    def __init__(self) -> None:
        self._tasks: set[asyncio.Task[None]] = set()
        self._dropping = False

    def answer(self, service: str, handler: Handler, request: bytes, respond: Callable[[bytes], None]) -> None:
        """Have `respond` called with what `handler` makes of `request`; a handler that fails is logged."""
        if len(self._tasks) >= CAPACITY:
            if not self._dropping:
                _log.warning("requests dropped: too many are being answered", service=service, limit=CAPACITY)
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
