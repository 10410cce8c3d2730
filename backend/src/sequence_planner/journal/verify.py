"""A check whether the journal is as it was written: both chains, what signed checkpoints say of them, and what was cut
off.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy import Connection, Table, select

from sequence_planner.core.storage_error import StorageError
from sequence_planner.journal import audit, checkpoints, run_journal
from sequence_planner.journal.archive import TRIMMED
from sequence_planner.journal.audit import AUDIT
from sequence_planner.journal.checkpoints import Checkpoint
from sequence_planner.journal.hash_chain import START, ChainPosition
from sequence_planner.journal.run_journal import RUN


@dataclass(frozen=True)
class Verified:
    """The findings: `wrong` in words, empty where all is whole; how far the chains go, and who signed them last."""

    wrong: tuple[str, ...]
    audit: ChainPosition
    run_begin: ChainPosition
    run: ChainPosition
    newest: Checkpoint | None


def verify(connection: Connection, key: str | None = None, kept: Checkpoint | None = None) -> Verified:
    """Look at all records.

    `key` is the station's public key, where that is at hand; `kept` is a checkpoint that was kept elsewhere.
    """
    begin = run_journal.last_trimmed(connection)
    wrong = [*_broken(connection, begin)]
    try:
        newest = checkpoints.newest(connection)
        wrong += _wrongly_signed(connection, begin)
        wrong += _another_key(newest, key, kept)
    except StorageError as error:
        newest = None
        wrong.append(str(error))
    if kept is not None and (why := _why_not(connection, begin, kept)) is not None:
        wrong.append(f"the checkpoint that was kept {why}")
    ends = audit.end(connection) or START, run_journal.end(connection) or START
    return Verified(tuple(wrong), ends[0], begin, ends[1], newest)


def _broken(connection: Connection, begin: ChainPosition) -> Iterator[str]:
    """Yield what the chains themselves tell."""
    if (number := audit.broken_at(connection)) is not None:
        yield f"record {number} of who did what is missing, or is not as it was written"
    if (number := run_journal.broken_at(connection)) is not None:
        yield f"record {number} of what happened is missing, or is not as it was written"
    if begin == START:
        return
    trimmed = audit.read(connection, limit=1, action=TRIMMED)
    said = trimmed[0].entry.details if trimmed else {}
    if (said.get("number"), said.get("hash")) != (begin.number, begin.hash):
        yield f"what happened up to record {begin.number} was cut off, and it is not recorded who did that"


def _wrongly_signed(connection: Connection, begin: ChainPosition) -> Iterator[str]:
    """The first checkpoint in the database that is not as it was signed, or that the chains do not fit."""
    for number, checkpoint in enumerate(checkpoints.everything(connection), start=1):
        if (why := _why_not(connection, begin, checkpoint)) is not None:
            yield f"checkpoint {number} of those in the database {why}"
            return


def _another_key(newest: Checkpoint | None, key: str | None, kept: Checkpoint | None) -> Iterator[str]:
    """Check whose key it is: whoever changes the database can put checkpoints in, but has not got the key."""
    if newest is None:
        return
    if key is not None and newest.public_key != key:
        yield "the newest checkpoint is not signed with the key of this station"
    if kept is not None and newest.public_key != kept.public_key:
        yield "the newest checkpoint is signed with another key than the checkpoint that was kept"


def _why_not(connection: Connection, begin: ChainPosition, checkpoint: Checkpoint) -> str | None:
    """Say why a checkpoint does not hold; None when it does, as far as the records that it is about are still there."""
    if not checkpoint.is_signed():
        return "is not as it was signed"
    said = checkpoint.statement()
    if _hash(connection, AUDIT, said.audit.number, START) != said.audit.hash:
        return f"does not fit: record {said.audit.number} of who did what is missing, or is another one"
    if said.run.number >= begin.number and _hash(connection, RUN, said.run.number, begin) != said.run.hash:
        return f"does not fit: record {said.run.number} of what happened is missing, or is another one"
    return None


def _hash(connection: Connection, table: Table, number: int, begin: ChainPosition) -> str | None:
    if number == begin.number:
        return begin.hash
    return connection.execute(select(table.c.hash).where(table.c.number == number)).scalar()
