"""Taking out orders that are over long enough, with their responses, and the events that are as old.

They go to a file first, which is on the disk and was read again before anything is taken out. Events and responses go
from the oldest on, so that whoever reads on from a number can be told what was missed. An order that is not over stays
whatever its age. What a webhook had still to be told, or was given up, is taken out with its event, and both the
webhook and the record of who did what say so.
"""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from pydantic import JsonValue
from sqlalchemy import Connection, Table, delete, func, insert, select, update

from sequence_planner.core.actor import Actor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import archive, audit
from sequence_planner.journal.archive import ArchiveError
from sequence_planner.journal.audit import AUDIT
from sequence_planner.journal.entry import Entry
from sequence_planner.mes.order import OVER
from sequence_planner.mes.tables import JOB_BEGIN, JOB_EVENTS, JOB_ORDERS, JOB_ORDERS_GONE, JOB_RESPONSES
from sequence_planner.mes.webhooks.tables import WEBHOOK_DELIVERIES, WEBHOOKS

CUT: Final = "job-orders-cut"  # the action in the record of who did what
FILES_REMOVED: Final = "job-orders-archive-removed"
MOST: Final = 1000  # events, responses and orders in one file and in one transaction
_NAMED: Final = 500  # in one statement
_BEGIN: Final = select(JOB_BEGIN.c.orders, JOB_BEGIN.c.events, JOB_BEGIN.c.responses)
_OVER: Final = JOB_ORDERS.c.state.in_([str(each) for each in OVER])
_ENDED: Final = func.coalesce(JOB_ORDERS.c.ended, JOB_ORDERS.c.removed)

_Row = dict[str, Any]


@dataclass(frozen=True)
class OrderFile:
    """A file with so many of each; `until` is the time of the newest, `sha256` that of the file."""

    folder: str
    file: str
    orders: int
    events: int
    responses: int
    until: float
    size: int
    sha256: str

    def path(self, folder: Path | None = None) -> Path:
        """Return where it is: in `folder`, or else where it was put."""
        if folder is not None and (named := folder / self.file).exists():
            return named
        return Path(self.folder) / self.file


@dataclass(frozen=True)
class _Old:
    begin: tuple[int, int, int]  # of orders, events and responses
    orders: list[_Row]
    events: list[_Row]
    responses: list[_Row]

    @property
    def count(self) -> int:
        return max(len(self.orders), len(self.events), len(self.responses))

    @property
    def until(self) -> float:
        """The time of the newest."""
        ended = [float(each["ended"] or each["removed"]) for each in self.orders]
        return max([*ended, *(float(each["time"]) for each in (*self.events, *self.responses))])


def order_files(connection: Connection) -> tuple[OrderFile, ...]:
    """The files that there are to be, the oldest first, as the record of who did what tells."""
    chosen = select(AUDIT.c.action, AUDIT.c.entry).where(AUDIT.c.action.in_((CUT, FILES_REMOVED)))
    found: dict[str, OrderFile] = {}
    for action, entry in connection.execute(chosen.order_by(AUDIT.c.number)):
        details = json.loads(entry)["details"]
        if action == FILES_REMOVED:
            found.pop(details["file"], None)
        elif "file" in details:
            found[details["file"]] = OrderFile(**{name: details[name] for name in OrderFile.__dataclass_fields__})
    return tuple(found.values())


def wrong_files(files: Sequence[OrderFile], folder: Path | None = None) -> Iterator[str]:
    """Yield what is wrong with the files, in words."""
    for each in files:
        try:
            archive.check(each.path(folder), each.sha256)
        except ArchiveError as error:
            yield f"{each.orders} job orders: {error}"


def cut_orders(
    database: Database, older_than: float, by: Actor, now: float, folder: Path | None, least_until: float | None = None
) -> int:
    """Take out up to `MOST` of each that is older than this time; how many of that of which there were most.

    Few are left for later, unless the oldest is older than `least_until`. Raises `StorageError`; then all is there.
    """
    with database.reading() as connection:
        old = _old(connection, older_than)
    if not old.count or (old.count < MOST and least_until is not None and _oldest(old) > least_until):
        return 0
    details: dict[str, JsonValue] = {
        "orders": len(old.orders),
        "events": len(old.events),
        "responses": len(old.responses),
        "until": old.until,
    }
    if folder is not None:
        details |= asdict(_archived(folder, old))
    with database.writing() as connection:
        if tuple(connection.execute(_BEGIN).one()) != old.begin:
            raise StorageError("somebody else takes job orders out just now: try again")
        undelivered = _delete(connection, old, now)
        if undelivered:
            details["undelivered"] = dict(undelivered)
        audit.append(connection, Entry(actor=by, action=CUT, subject=_subject(old), details=details), now)
    return old.count


def _old(connection: Connection, older_than: float) -> _Old:
    begin = connection.execute(_BEGIN).one()
    events = _oldest_of(connection, JOB_EVENTS, begin.events, older_than)
    responses = _oldest_of(connection, JOB_RESPONSES, begin.responses, older_than)
    chosen = (
        select(JOB_ORDERS)
        .where(_OVER | JOB_ORDERS.c.removed.is_not(None), older_than > _ENDED)
        .order_by(JOB_ORDERS.c.number)
        .limit(MOST)
    )
    orders = [dict(each) for each in connection.execute(chosen).mappings()]
    going = {each["job_order"] for each in responses}
    kept = _with_response(connection, [each["id"] for each in orders]) - going
    return _Old(tuple(begin), [each for each in orders if each["id"] not in kept], events, responses)


def _oldest_of(connection: Connection, table: Table, number: int, older_than: float) -> list[_Row]:
    """Those behind a number, up to the first that is not so old."""
    chosen = select(table).where(table.c.number > number).order_by(table.c.number).limit(MOST)
    found: list[_Row] = []
    for row in connection.execute(chosen).mappings():
        if row["time"] >= older_than:
            break
        found.append(dict(row))
    return found


def _with_response(connection: Connection, ids: Sequence[str]) -> set[str]:
    found: set[str] = set()
    for some in _some(ids):
        chosen = select(JOB_RESPONSES.c.job_order).where(JOB_RESPONSES.c.job_order.in_(some))
        found |= set(connection.execute(chosen).scalars())
    return found


def _oldest(old: _Old) -> float:
    times = [float(each["ended"] or each["removed"]) for each in old.orders]
    return min([*times, *(float(each["time"]) for each in (*old.events, *old.responses))])


def _archived(folder: Path, old: _Old) -> OrderFile:
    lines = [*_lines(old)]
    mark = hashlib.sha256("\n".join(lines).encode()).hexdigest()[:8]
    file = folder / f"orders-{old.begin[1] + 1:012}-{old.begin[2] + 1:012}-{mark}{archive.ENDING}"
    written = archive.write(file, lines)
    if list(archive.lines(file, written.sha256)) != lines:
        raise ArchiveError(f"{file} was written, and is not read as it was written: is the disk sound?")
    counts = {"orders": len(old.orders), "events": len(old.events), "responses": len(old.responses)}
    return OrderFile(str(folder), file.name, **counts, until=old.until, size=written.size, sha256=written.sha256)


def _lines(old: _Old) -> Iterator[str]:
    """The first says what follows; then each order, event and response as it is in the database."""
    kinds = {"order": old.orders, "event": old.events, "response": old.responses}
    counts = {f"{kind}s": len(rows) for kind, rows in kinds.items()}
    yield _json({"archive": "job orders", **counts, "until": old.until})
    for kind, rows in kinds.items():
        for row in rows:
            content = row.get("content")
            yield _json({kind: row if content is None else {**row, "content": json.loads(content)}})


def _json(document: Mapping[str, Any]) -> str:
    return json.dumps(document, separators=(",", ":"), ensure_ascii=False)


def _delete(connection: Connection, old: _Old, now: float) -> Counter[str]:
    """All of it; how many events each webhook, by its title, was not told of."""
    numbers = {
        "orders": max([old.begin[0], *(each["number"] for each in old.orders)]),
        "events": old.events[-1]["number"] if old.events else old.begin[1],
        "responses": old.responses[-1]["number"] if old.responses else old.begin[2],
    }
    undelivered = _withdraw(connection, numbers["events"])
    connection.execute(delete(JOB_EVENTS).where(JOB_EVENTS.c.number <= numbers["events"]))
    connection.execute(delete(JOB_RESPONSES).where(JOB_RESPONSES.c.number <= numbers["responses"]))
    for some in _some([each["id"] for each in old.orders]):
        connection.execute(delete(JOB_ORDERS).where(JOB_ORDERS.c.id.in_(some)))
    if old.orders:
        gone = [{"id": each["id"], "ended": each["ended"] or each["removed"]} for each in old.orders]
        connection.execute(insert(JOB_ORDERS_GONE), gone)
    connection.execute(update(JOB_BEGIN).values(numbers))
    return undelivered


def _withdraw(connection: Connection, event: int) -> Counter[str]:
    """Let no webhook wait for an event up to this one."""
    missed: Counter[str] = Counter()
    waiting = (
        select(WEBHOOK_DELIVERIES.c.webhook, func.count())
        .where(WEBHOOK_DELIVERIES.c.event <= event)
        .group_by(WEBHOOK_DELIVERIES.c.webhook)
    )
    counts = {row[0]: row[1] for row in connection.execute(waiting)}
    for id_, title, position in connection.execute(select(WEBHOOKS.c.id, WEBHOOKS.c.title, WEBHOOKS.c.position)).all():
        count = counts.get(id_, 0) + max(0, event - position)
        if count:
            missed[title] += count
            said = f"{count} events were not delivered in time, and are kept no more"
            values = {"position": max(position, event), "trouble": said}
            connection.execute(update(WEBHOOKS).where(WEBHOOKS.c.id == id_).values(values))
    connection.execute(delete(WEBHOOK_DELIVERIES).where(WEBHOOK_DELIVERIES.c.event <= event))
    return missed


def _some(ids: Sequence[str]) -> Iterator[Sequence[str]]:
    for start in range(0, len(ids), _NAMED):
        yield ids[start : start + _NAMED]


def _subject(old: _Old) -> str:
    return f"{len(old.orders)} orders, {len(old.events)} events, {len(old.responses)} responses"
