"""Writing what has happened at the station, without anybody waiting for the disk.

Whoever must not go on before a record is durable looks at `durable`. A slow disk makes the groups that are written at
once larger, and not the station slower.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections import deque
from collections.abc import Callable
from time import monotonic
from typing import Final

import structlog

from sequence_planner.distribution import Distribution
from sequence_planner.journal import checkpoints, run_journal
from sequence_planner.journal.chain import Position, digest
from sequence_planner.journal.checkpointing import Checkpointing
from sequence_planner.journal.group_commit import Fence, GroupCommit
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.journal.run_tables import LONGEST_KIND
from sequence_planner.storage.database import Database, StorageError

MOST_WAITING: Final = 100_000
"""More records than this should not wait in memory: whoever writes so many while the database is away is to stop."""

LATENCIES: Final = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)  # seconds
LOG = structlog.get_logger(__name__)
_CLOSING: Final = 5.0  # seconds for what still waits at the end


class RunWriter:
    """Writes records, in order, from `begin` on. It is used from one event loop, on which `told` hears of each change.
    Nothing is written where `fence` says that somebody else does by now.

    Raises `StorageError` if the database cannot be read.
    """

    durable: int
    """Every record up to this number is durable."""
    trouble: str | None
    """Why nothing can be written now, for people. It is tried again, and None when it works again."""
    latency: Distribution
    """How long records took to be durable."""

    def __init__(self, database: Database, told: Callable[[], None], fence: Fence = lambda _: True) -> None:
        with database.reading() as connection:
            end, signed = run_journal.end(connection), checkpoints.signed_up_to(connection)
        if end is None:
            raise StorageError(f"the journal's end was taken out of {database.place}: put a copy in its place")
        self.durable, self.trouble = end.number, None
        self.latency = Distribution(LATENCIES)
        self._given = deque[float]()  # when each record that waits was given to write, on the clock
        self._told = told
        self._news = asyncio.Event()
        self._loop = asyncio.get_running_loop()
        self._end = end  # of what was given to write
        self._closed = False
        self._commits = GroupCommit(database, end, Checkpointing(database, signed), self._tell, fence)

    def begin(self) -> None:
        """Begin to write, beginning with what has been given until now."""
        now = monotonic()
        self._given = deque([now] * len(self._given))  # until now nobody waited for them
        self._commits.begin()

    @property
    def end(self) -> Position:
        """The last record that was given to write."""
        return self._end

    @property
    def waiting(self) -> int:
        """How many records are not durable yet."""
        return self._end.number - self.durable

    def write(self, kind: str, time: float, content: str) -> int:
        """The number of a new record, which is durable some time later. It never blocks.

        `content` is JSON text on one line, `time` is in seconds since the epoch.
        """
        if self._closed:
            raise RuntimeError("the journal is closed")
        if not 0 < len(kind) <= LONGEST_KIND or "\n" in content:
            raise ValueError(f"a record of kind {kind!r} cannot be written: its kind is too long, or it has two lines")
        number = self._end.number + 1
        text = RunRecord(number, float(time), kind, content, "").text()
        record = RunRecord(number, float(time), kind, content, digest(self._end.hash, text))
        self._end = Position(number, record.hash)
        self._given.append(monotonic())
        self._commits.put(record)
        return number

    async def until_durable(self, number: int, patience: float) -> bool:
        """Whether a record is durable by now, or within so many seconds. It is not waited for in `trouble`."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(patience):
                while self.durable < number and self.trouble is None:
                    self._news.clear()
                    await self._news.wait()
        return self.durable >= number

    async def close(self) -> None:
        """Write what waits, as long as that is possible within 5 s, if it was begun. Nothing can be written then."""
        self._closed = True
        await asyncio.to_thread(self._commits.close, _CLOSING)
        if self.waiting:
            LOG.error("what happened last is not journalled", records=self.waiting, trouble=self.trouble)

    def _tell(self, durable: int, trouble: str | None) -> None:
        """Hear from the thread, which may still wait for the database when the loop has ended."""
        with contextlib.suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._heard, durable, trouble)

    def _heard(self, durable: int, trouble: str | None) -> None:
        now = monotonic()
        for _ in range(durable - self.durable):
            self.latency.note(now - self._given.popleft())
        self.durable, self.trouble = durable, trouble
        self._news.set()
        self._told()
