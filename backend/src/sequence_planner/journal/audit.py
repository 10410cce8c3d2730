"""The durable record of who did what: only ever added to, and chained so that a change behind its back shows."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from pydantic import ValidationError
from sqlalchemy import Column, Connection, Double, String, Table, Text, insert, select

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.metadata import METADATA
from sequence_planner.journal import hash_chain
from sequence_planner.journal.entry import Entry, Record
from sequence_planner.journal.hash_chain import BELOW_ALL, NUMBER, START, ChainLink, ChainPosition, digest

AUDIT: Final = Table(
    "audit",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),
    Column("time", Double, nullable=False),
    Column("action", String(100), nullable=False, index=True),
    Column("actor", String(200), nullable=False, index=True),
    Column("entry", Text, nullable=False),
    Column("hash", String(64), nullable=False),
)
"""`entry` is the JSON text of the entry, of which `action` and `actor` (its id) are copies to search by."""

AUDIT_END: Final = hash_chain.position_table("audit_end")
"""One row with the number and the hash of the last record, so that records missing at the end show."""

_PAGE: Final = 1000  # records read at once


@dataclass(frozen=True)
class Stored(ChainLink):
    """A record as it is in the database."""

    number: int
    time: float
    action: str
    actor: str
    entry: str
    hash: str

    def text(self) -> str:
        """It as a line of JSON, up to its hash."""
        return f'{{"number":{self.number},"time":{self.time!r},"entry":{self.entry}'

    def is_whole(self, before: str) -> bool:
        """Return whether it is what was written, also to search by."""
        if not super().is_whole(before):
            return False
        entry = json.loads(self.entry)
        return (self.action, self.actor) == (entry["action"], entry["actor"]["id"])

    def record(self) -> Record:
        """Return what it says. Raises `StorageError` if it says nothing that could have been written."""
        try:
            entry = Entry.model_validate_json(self.entry)
            return Record(number=self.number, time=self.time, entry=entry, hash=self.hash)
        except ValidationError as error:
            raise StorageError(f"record {self.number} of the journal cannot be read: it was changed") from error


def append(connection: Connection, entry: Entry, now: float) -> Record:
    """Write a record. Call it within a `writing()` block: the record is there if, and only if, all of the block is."""
    before = end(connection)
    if before is None:
        raise StorageError("the journal's end was taken out of the database: put a copy in its place")
    number = before.number + 1
    written = Stored(number, float(now), entry.action, entry.actor.id, entry.model_dump_json(), "")
    hash_ = digest(before.hash, written.text())
    connection.execute(
        insert(AUDIT),
        {
            "number": number,
            "time": written.time,
            "action": written.action,
            "actor": written.actor,
            "entry": written.entry,
            "hash": hash_,
        },
    )
    hash_chain.move(connection, AUDIT_END, ChainPosition(number, hash_), before)
    return Record(number=number, time=written.time, entry=entry, hash=hash_)


def end(connection: Connection) -> ChainPosition | None:
    """Return where the record ends; None if somebody has taken that out."""
    return hash_chain.position(connection, AUDIT_END)


def read(
    connection: Connection,
    *,
    before: int | None = None,
    limit: int = 50,
    action: str | None = None,
    actor: str | None = None,
    since: float | None = None,
    until: float | None = None,
) -> list[Record]:
    """Up to `limit` records, the newest first: those with numbers below `before`, of an action, of an actor's id, and
    from `since` to before `until`.

    Raises `StorageError` for a record that was changed so that it can no longer be read.
    """
    chosen = select(AUDIT).order_by(AUDIT.c.number.desc()).limit(limit)
    if before is not None:
        chosen = chosen.where(AUDIT.c.number < before)
    if action is not None:
        chosen = chosen.where(AUDIT.c.action == action)
    if actor is not None:
        chosen = chosen.where(AUDIT.c.actor == actor)
    if since is not None:
        chosen = chosen.where(AUDIT.c.time >= since)
    if until is not None:
        chosen = chosen.where(AUDIT.c.time < until)
    return [Stored(**row).record() for row in connection.execute(chosen).mappings()]


def page_after(connection: Connection, number: int, limit: int = _PAGE) -> list[Stored]:
    """Up to `limit` records as they are stored, in order, with numbers above `number`."""
    chosen = select(AUDIT).where(AUDIT.c.number > number).order_by(AUDIT.c.number).limit(limit)
    return [Stored(**row) for row in connection.execute(chosen).mappings()]


def broken_at(connection: Connection) -> int | None:
    """The number of the first record that is not as it was written, or is missing; None when all are whole."""
    return hash_chain.broken_at(_everything(connection), START, end(connection))


def _everything(connection: Connection) -> Iterator[Stored]:
    number = BELOW_ALL
    while page := page_after(connection, number):
        yield from page
        number = page[-1].number
