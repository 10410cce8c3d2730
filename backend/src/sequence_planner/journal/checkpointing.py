"""The time when a checkpoint is due: after so many records, or so much time with something new."""

from __future__ import annotations

import time
from typing import Final

import structlog
from sqlalchemy.exc import SQLAlchemyError

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import checkpoints

LOG = structlog.get_logger(__name__)
RECORDS: Final = 10_000
SECONDS: Final = 3600.0


class Checkpointing:
    """Makes checkpoints, in the thread that writes the run; `signed` is the last record that one covers already."""

    def __init__(self, database: Database, signed: int) -> None:
        self._database = database
        self._signed = signed
        self._due: float | None = None  # a moment of the monotonic clock; None while there is nothing new

    def wrote(self, number: int) -> None:
        """All records up to `number` are durable."""
        if number - self._signed >= RECORDS:
            self._make(number)
        elif self._due is None:
            self._due = time.monotonic() + SECONDS

    def due_in(self) -> float | None:
        """Seconds until one is due; None while there is nothing new."""
        return None if self._due is None else max(0.0, self._due - time.monotonic())

    def make_if_due(self, number: int) -> None:
        """Make one, if it is time; all records up to `number` are durable."""
        if self._due is not None and time.monotonic() >= self._due:
            self._make(number)

    def _make(self, number: int) -> None:
        """Without one the station goes on all the same: that it is missing shows in the log and when it is verified."""
        self._signed, self._due = number, None
        try:
            checkpoints.make(self._database, time.time())
        except (StorageError, SQLAlchemyError) as error:
            LOG.error("the journal cannot be signed", trouble=str(error))
