"""A limit to the memory of a process that looks for something in a model: a model must not exhaust the machine.

What is resident counts, and not what has been set aside: decision diagrams set aside much more than they fill. Whoever
started the process looks, since a solver lets no other thread of its own process run.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Final, Protocol

from sequence_planner.texts.message import Message, message

VARIABLE: Final = "SEQUENCE_PLANNER_MEMORY"  # of the environment: the limit in GB
USUAL: Final = 2.0  # GB
LEAST, MOST = 0.25, 1024.0  # GB
_GB = 1 << 30
LOOK: Final = 0.1  # seconds between two looks


class Killable(Protocol):
    """A process."""

    @property
    def pid(self) -> int | None:
        """Its number."""
        ...

    def kill(self) -> None:
        """End it."""
        ...


class MemoryLimitError(Exception):
    """The variable of the environment does not say how many GB."""


class MemoryLimit:
    """At most so many GB for a process; `reached` once it had more, and was killed for it."""

    def __init__(self, gigabytes: float) -> None:
        self.gigabytes = gigabytes
        self.reached = False

    @property
    def exceeded(self) -> Message:
        """Say that a process had more."""
        return message("work.memory", gigabytes=f"{self.gigabytes:g}", variable=VARIABLE)

    @contextmanager
    def held(self, process: Killable) -> Iterator[None]:
        """Kill the process as soon as it is beyond the limit; to be entered where an event loop runs."""
        watching = asyncio.create_task(self._watch(process))
        try:
            yield
        finally:
            watching.cancel()

    async def _watch(self, process: Killable) -> None:
        number = await asyncio.to_thread(lambda: process.pid)
        while number is not None and _resident(number) is not None:
            self.look(process, number)
            if self.reached:
                return
            await asyncio.sleep(LOOK)

    def look(self, process: Killable, number: int) -> None:
        """Kill the process, which has this number, if it is beyond the limit."""
        resident = _resident(number)
        if resident is not None and resident > self.gigabytes * _GB:
            self.reached = True
            process.kill()


def memory_limit(environ: Mapping[str, str] = os.environ) -> float:
    """Return how many GB there are for each process that checks a model. Raises `MemoryLimitError`."""
    text = environ.get(VARIABLE) or str(USUAL)
    try:
        limit = float(text)
    except ValueError:
        limit = 0.0
    if not LEAST <= limit <= MOST:
        raise MemoryLimitError(f"{VARIABLE} is {text}: write how many GB, {LEAST:g} to {MOST:g}")
    return limit


def _resident(pid: int) -> int | None:
    """Return how many bytes of a process are in memory (proc_pid_statm(5)); None once it has ended."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):
        return None
