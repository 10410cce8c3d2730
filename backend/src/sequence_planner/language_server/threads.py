"""The threads of a language server: in one stations are read, in the other what is asked is answered."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Found = TypeVar("Found")
_SOON = 0.03  # seconds: what is typed is mostly asked about at once


class ServerThreads:
    """Used from one event loop. Nothing is read while an answer is awaited: only one of them is at work at a time.

    All stations are read in one thread, since each is read where the working folder is its own.
    """

    def __init__(self) -> None:
        self._answering = ThreadPoolExecutor(1, "answering")
        self._reading = ThreadPoolExecutor(1, "reading")
        self._awaited = 0
        self._idle = asyncio.Event()

    async def found_at_once(self, work: Callable[[], Found]) -> Found:
        """Return what is found at once. What nobody waits for any more is not begun."""
        self._awaited += 1
        self._idle.clear()
        try:
            return await asyncio.get_running_loop().run_in_executor(self._answering, work)
        finally:
            self._awaited -= 1
            if not self._awaited:
                self._idle.set()

    async def found_later(self, work: Callable[[], Found]) -> Found:
        """Return what is found when nobody waits for an answer."""
        await asyncio.sleep(_SOON)
        while self._awaited:
            await self._idle.wait()
        return await asyncio.get_running_loop().run_in_executor(self._reading, work)

    def close(self) -> None:
        """Begin nothing more."""
        for each in (self._answering, self._reading):
            each.shutdown(wait=False, cancel_futures=True)
