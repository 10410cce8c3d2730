"""Run journal writer: non-blocking records, made durable by a group-commit thread."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from itertools import islice
from time import monotonic
from typing import Final

import structlog
from sqlalchemy import Connection, insert
from sqlalchemy.exc import SQLAlchemyError

from sequence_planner.core.distribution import Distribution
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.errors import storage_error
from sequence_planner.journal import checkpoints, hash_chain, run_journal
from sequence_planner.journal.checkpointing import Checkpointing
from sequence_planner.journal.hash_chain import ChainPosition, digest
from sequence_planner.journal.run_journal import LONGEST_KIND, RUN, RUN_END, RunRecord

# The thread that makes records durable: what has come together while it wrote goes in one transaction.

LOG = structlog.get_logger(__name__)
FIRST_PAUSE, LONGEST_PAUSE = 0.2, 5.0  # seconds until it is tried again
TAKEN_OVER: Final = (
    "another station writes what happens to this database too: end one of the two, then start this one again"
)
_INSERT: Final = insert(RUN)
_LARGEST_GROUP: Final = 1000  # records in one transaction


# Whether records may be written in this transaction.
Fence = Callable[[Connection], bool]


class TakenOver(Exception):
    """Somebody else has written records of the run."""


class GroupCommit:
    """Writes records behind `end`, in the order in which they are put, from `begin` on.

    `tell` is called in the thread: the number up to which all is durable, and why no more is, or None. Nothing is
    written in a transaction that `fence` does not let pass.
    """

    def __init__(
        self,
        database: Database,
        end: ChainPosition,
        checkpointing: Checkpointing,
        tell: Callable[[int, str | None], None],
        fence: Fence,
    ) -> None:
        self._database = database
        self._end = end  # what is durable
        self._checkpointing = checkpointing
        self._tell = tell
        self._fence = fence
        self._queue: deque[RunRecord] = deque()
        self._changed = threading.Condition()  # the queue, or `_until`
        self._until: float | None = None  # the moment of the monotonic clock after which nothing is tried any more
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin to write."""
        self._thread = threading.Thread(target=self._work, name="journal", daemon=True)
        self._thread.start()

    def append(self, record: RunRecord) -> None:
        """Let it be written. Never waits for the disk."""
        with self._changed:
            self._queue.append(record)
            self._changed.notify()

    def close(self, patience: float) -> None:
        """Write what waits, as long as that is possible within `patience` seconds. It waits for the thread.

        What was put is dropped if it was never begun.
        """
        with self._changed:
            self._until = time.monotonic() + patience
            self._changed.notify()
        if self._thread is not None:
            self._thread.join(patience)

    def _work(self) -> None:
        try:
            while group := self._next_group():
                self._persist(group)
        except TakenOver:
            LOG.critical(TAKEN_OVER)
            self._tell(self._end.number, TAKEN_OVER)

    def _next_group(self) -> list[RunRecord]:
        """Return what waits, as soon as something does; nothing at the end. A checkpoint that is due is made
        meanwhile.
        """
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._queue or self._until is not None, self._checkpointing.due_in())
                if self._queue and not self._is_over():
                    group = list(islice(self._queue, _LARGEST_GROUP))
                    for _ in group:
                        self._queue.popleft()
                    return group
                if self._until is not None:
                    return []
            self._checkpointing.make_if_due(self._end.number)

    def _persist(self, group: Sequence[RunRecord]) -> None:
        """Try until it is written, or the end has come."""
        pause, failed = FIRST_PAUSE, False
        while (trouble := self._trouble_with(group, again=failed)) is not None:
            if not failed:
                LOG.error("what happens cannot be journalled", trouble=trouble)
            failed = True
            self._tell(self._end.number, trouble)
            self._wait(pause)
            if self._is_over():
                return
            pause = min(2 * pause, LONGEST_PAUSE)
        if failed:
            LOG.warning("what happens is journalled again", number=group[-1].number)
        self._end = ChainPosition(group[-1].number, group[-1].hash)
        self._tell(self._end.number, None)
        self._checkpointing.wrote(self._end.number)
        self._checkpointing.make_if_due(self._end.number)

    def _trouble_with(self, group: Sequence[RunRecord], again: bool) -> str | None:
        """Write them in one transaction; why they could not be written, None when they are durable."""
        try:
            self._append(group, again)
        except TakenOver:
            raise
        except StorageError as error:
            return str(error)
        except SQLAlchemyError as error:
            return str(storage_error(self._database.place, error))
        except Exception as error:  # whatever it is, it must be seen, and must not end the thread
            LOG.exception("what happens cannot be journalled")
            return f"{type(error).__name__}: {error}"
        return None

    def _append(self, group: Sequence[RunRecord], again: bool) -> None:
        last = ChainPosition(group[-1].number, group[-1].hash)
        with self._database.writing() as connection:
            if not self._fence(connection):
                raise TakenOver
            if hash_chain.move(connection, RUN_END, last, self._end):
                connection.execute(_INSERT, [vars(record) for record in group])
            elif not again or run_journal.end(connection) != last:  # where it is, only the answer was lost
                raise TakenOver

    def _wait(self, pause: float) -> None:
        """Until it is to be tried again, which is soon where the end is near."""
        with self._changed:
            if self._until is not None:
                pause = FIRST_PAUSE
            ending = self._until
            self._changed.wait_for(lambda: self._until != ending, pause)

    def _is_over(self) -> bool:
        return self._until is not None and time.monotonic() > self._until


# Writing what has happened at the station, without anybody waiting for the disk.
#
# Whoever must not go on before a record is durable looks at `durable`. A slow disk makes the groups that are written at
# once larger, and not the station slower.

MOST_WAITING: Final = 100_000
"""More records than this should not wait in memory: whoever writes so many while the database is away is to stop."""

LATENCIES: Final = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)  # seconds
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
    """Times that records took to be durable."""

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
        self._commits = GroupCommit(database, end, Checkpointing(database, signed), self._report, fence)

    def start(self) -> None:
        """Begin to write, beginning with what has been given until now."""
        now = monotonic()
        self._given = deque([now] * len(self._given))  # until now nobody waited for them
        self._commits.start()

    @property
    def end(self) -> ChainPosition:
        """The last record that was given to write."""
        return self._end

    @property
    def waiting(self) -> int:
        """The number of records that are not durable yet."""
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
        self._end = ChainPosition(number, record.hash)
        self._given.append(monotonic())
        self._commits.append(record)
        return number

    async def until_durable(self, number: int, patience: float) -> bool:
        """Return whether a record is durable by now, or within so many seconds. It is not waited for in `trouble`."""
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

    def _report(self, durable: int, trouble: str | None) -> None:
        """Hear from the thread, which may still wait for the database when the loop has ended."""
        with contextlib.suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._on_committed, durable, trouble)

    def _on_committed(self, durable: int, trouble: str | None) -> None:
        now = monotonic()
        for _ in range(durable - self.durable):
            self.latency.note(now - self._given.popleft())
        self.durable, self.trouble = durable, trouble
        self._news.set()
        self._told()
