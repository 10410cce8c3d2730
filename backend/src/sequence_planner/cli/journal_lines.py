"""What `journal` prints of a station's database."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import UTC, datetime

from sequence_planner.journal import audit
from sequence_planner.journal.entry import Record
from sequence_planner.storage.database import Database


def verification(database: Database) -> tuple[bool, str]:
    """Whether a record was changed or is missing, and a line that says so or tells the last record."""
    with database.reading() as connection:
        broken = audit.broken_at(connection)
        if broken is not None:
            return True, f"record {broken} is missing, or is not as it was written"
        last = audit.read(connection, limit=1)
    if not last:
        return False, "no records yet"
    return False, f"{last[0].number} records, all as they were written; the hash of the last one is {last[0].hash}"


def documents(database: Database) -> Iterator[str]:
    """All records in order, as JSON.

    Page by page, as a reader who takes long must not keep SQLite from clearing its log.
    """
    number = 0
    while True:
        with database.reading() as connection:
            page = audit.page_after(connection, number)
        if not page:
            return
        for stored in page:
            yield stored.line()
        number = page[-1].number


def latest(database: Database, limit: int, action: str | None) -> Iterator[str]:
    """The latest records, the newest last, as lines for people."""
    with database.reading() as connection:
        records = audit.read(connection, limit=limit, action=action)
    for record in reversed(records):
        yield _line(record)


def _line(record: Record) -> str:
    """A record for people. What would steer a terminal is written as its escape."""
    entry, actor = record.entry, record.entry.actor
    when = datetime.fromtimestamp(record.time, UTC).isoformat(" ", "milliseconds")
    told = [
        str(record.number),
        when.removesuffix("+00:00") + " UTC",
        actor.name + (f" ({actor.address})" if actor.address else ""),
        entry.action,
        entry.subject,
        entry.outcome + (f" ({entry.about})" if entry.about is not None else ""),
        json.dumps(entry.details, ensure_ascii=False) if entry.details else "",
        f'"{entry.reason}"' if entry.reason else "",
    ]
    return "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode("ascii")
        for each in "  ".join(part for part in told if part)
    )
