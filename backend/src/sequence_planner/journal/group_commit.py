"""The thread that makes records durable: what has come together while it wrote goes in one transaction."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from itertools import islice
from typing import Final

import structlog
from sqlalchemy import Connection, insert
from sqlalchemy.exc import SQLAlchemyError

from sequence_planner.journal import chain, run_journal
from sequence_planner.journal.chain import Position
from sequence_planner.journal.checkpointing import Checkpointing
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.journal.run_tables import RUN, RUN_END
from sequence_planner.storage.database import Database, StorageError
from sequence_planner.storage.trouble import storage_error

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
        end: Position,
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

    def begin(self) -> None:
        """Begin to write."""
        self._thread = threading.Thread(target=self._work, name="journal", daemon=True)
        self._thread.start()

    def put(self, record: RunRecord) -> None:
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
        """What waits, as soon as something does; nothing at the end. A checkpoint that is due is made meanwhile."""
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
        self._end = Position(group[-1].number, group[-1].hash)
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
        last = Position(group[-1].number, group[-1].hash)
        with self._database.writing() as connection:
            if not self._fence(connection):
                raise TakenOver
            if chain.move(connection, RUN_END, last, self._end):
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
