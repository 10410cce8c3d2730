"""Waiting for what comes about, for as long as this machine needs as it is now.

How long a test waits is no promise of the program; what is promised within a time is asserted of a quiet machine.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final

PATIENCE: Final = 60.0
"""Seconds of a quiet machine within which processes have started and answered, and any discovery has come about."""

_WORK: Final = 100_000  # turns of a loop
_REFERENCE: Final = 0.002  # seconds of a processor that they take on the machine on which bounds were chosen
_LOAD: Final = Path("/proc/loadavg")


@cache
def _slowness() -> float:
    """How many times as long a processor of this machine takes as the one on which bounds were chosen; at least 1."""

    def seconds() -> float:
        began = time.process_time()
        for _ in range(_WORK):
            pass
        return time.process_time() - began

    return max(min(seconds() for _ in range(5)) / _REFERENCE, 1.0)


def slowdown() -> float:
    """How many times as long work takes now as on a quiet machine: its speed, and how many share each processor."""
    try:
        last_minute, _, _, now, *_ = _LOAD.read_text(encoding="ascii").split()
        sharing = max(float(last_minute), int(now.partition("/")[0]))
    except OSError:
        sharing = 1.0  # it does not say
    return _slowness() * max(sharing / len(os.sched_getaffinity(0)), 1.0)


def patience(seconds: float) -> float:
    """The seconds by the clock for what takes so many on a quiet machine, where one cannot look again and again."""
    return seconds * slowdown()


class Deadline:
    """So many seconds of a quiet machine: time counts less while others have the processors."""

    def __init__(self, seconds: float = PATIENCE) -> None:
        self._left = seconds
        self._seen = time.monotonic()

    @property
    def over(self) -> bool:
        """Whether the time is over, as far as one has looked often enough to know."""
        now = time.monotonic()
        self._left -= (now - self._seen) / slowdown()
        self._seen = now
        return self._left <= 0


def until(holds: Callable[[], object], what: str = "what is waited for", *, seconds: float = PATIENCE) -> None:
    """Wait until `holds` returns something true. AssertionError when it does not in time."""
    deadline = Deadline(seconds)
    while (pause := _pause(holds)) is not None:
        assert not deadline.over, f"{what} did not come about in time"
        time.sleep(pause)


async def until_async(
    holds: Callable[[], object], what: str = "what is waited for", *, seconds: float = PATIENCE
) -> None:
    """Wait as `until` does, while the event loop goes on."""
    deadline = Deadline(seconds)
    while (pause := _pause(holds)) is not None:
        assert not deadline.over, f"{what} did not come about in time"
        await asyncio.sleep(pause)


def _pause(holds: Callable[[], object]) -> float | None:
    """The seconds until one looks again, of which looking takes a tenth at most; None when it is so."""
    began = time.monotonic()
    if holds():
        return None
    return min(max(10 * (time.monotonic() - began), 0.01), 0.1)
