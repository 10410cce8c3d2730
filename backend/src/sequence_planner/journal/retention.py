"""Cutting off what happened long ago. What is left begins with a snapshot, and can be verified and replayed from it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Final

from pydantic import JsonValue
from sqlalchemy import ColumnElement, Connection, Table, delete, func, select

from sequence_planner.actor import Actor
from sequence_planner.journal import audit, chain, checkpoints, run_journal
from sequence_planner.journal.chain import Position
from sequence_planner.journal.entry import Entry
from sequence_planner.journal.run_tables import RUN, RUN_BEGIN, RUN_CHECKPOINTS
from sequence_planner.storage.database import Database, StorageError

SNAPSHOT: Final = "snapshot"  # the kind of the records that hold all that comes after needs
TRIMMED: Final = "journal-trimmed"  # the action in the record of who did what
_AT_ONCE: Final = 1000  # records in one transaction, as a station waits that writes meanwhile
_BREATH: Final = 0.01  # seconds for others to write


@dataclass(frozen=True)
class Trimmed:
    """What is left: the run begins behind the record `begin`, and `removed` records before were taken out now."""

    begin: int
    removed: int


def trim(database: Database, older_than: float, by: Actor) -> Trimmed:
    """Take out what happened before the newest snapshot that is older than this time (seconds since the epoch).

    That somebody did is in the record of who did what, in the transaction after which what stands before the snapshot
    is no part of the run any more; it then goes little by little. What was cut off by an earlier call that did not come
    to its end goes too. Raises `StorageError`.
    """
    with database.writing() as connection:
        begin = _cut(connection, older_than, by)
    removed = _remove(database, RUN, RUN.c.number, begin)
    # The next checkpoint covers all that those before have covered.
    checkpoints.make(database, time.time())
    _remove(database, RUN_CHECKPOINTS, RUN_CHECKPOINTS.c.run_number, begin)
    return Trimmed(begin, removed)


def _cut(connection: Connection, older_than: float, by: Actor) -> int:
    """Let the run begin with the snapshot; the number of the record before."""
    begin = run_journal.begin(connection)
    chosen = select(func.max(RUN.c.number)).where(
        RUN.c.kind == SNAPSHOT, RUN.c.number > begin.number + 1, RUN.c.time < older_than
    )
    snapshot: int | None = connection.execute(chosen).scalar()
    if snapshot is None:
        return begin.number
    last = run_journal.get(connection, snapshot - 1)
    if last is None:
        raise StorageError(f"record {snapshot - 1} of the journal is missing: verify it before it is trimmed")
    chain.move(connection, RUN_BEGIN, Position(last.number, last.hash), begin)
    details: dict[str, JsonValue] = {"number": last.number, "hash": last.hash}
    entry = Entry(actor=by, action=TRIMMED, subject=f"records up to {last.number}", details=details)
    audit.append(connection, entry, time.time())
    return last.number


def _remove(database: Database, table: Table, column: ColumnElement[int], begin: int) -> int:
    """Delete what lies at or before `begin`; the number of rows."""
    removed = 0
    oldest = select(table.c.number).where(column <= begin).order_by(table.c.number).limit(_AT_ONCE)
    while True:
        with database.writing() as connection:
            found = connection.execute(delete(table).where(table.c.number.in_(oldest))).rowcount
        removed += found
        if found < _AT_ONCE:
            return removed
        time.sleep(_BREATH)
