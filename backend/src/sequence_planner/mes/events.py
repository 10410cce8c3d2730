"""The events of orders and of the station, numbered without gaps: whoever reads on from a number misses nothing.

An event is written in the transaction of the change that it tells of.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from enum import StrEnum
from typing import Final

from pydantic import JsonValue
from sqlalchemy import Connection, func, insert, select

from sequence_planner.core.clock import iso
from sequence_planner.core.data_models import DataModel
from sequence_planner.mes.order import OrderRefused
from sequence_planner.mes.tables import JOB_BEGIN, JOB_EVENTS
from sequence_planner.texts.message import message

_OF_STATION: Final = ""  # in the database, in place of an order


class EventKind(StrEnum):
    """Kind of an event. A kind is never renamed; new ones may come."""

    STORED = "job-order-stored"
    UPDATED = "job-order-updated"
    ALLOWED = "job-order-allowed"
    REVOKED = "job-order-revoked"
    RUNNING = "job-order-running"  # the station works on it, for the first time or again
    INTERRUPTED = "job-order-interrupted"
    ENDED = "job-order-ended"
    ABORTED = "job-order-aborted"
    CANCELLED = "job-order-cancelled"
    CLEARED = "job-order-cleared"
    WAITS = "job-order-waits"  # what keeps it from going on is something else than before, or nothing any more
    OPERATION_STARTED = "operation-started"
    OPERATION_COMPLETED = "operation-completed"
    # Of the station, and of no order.
    MODE_CHANGED = "station-mode-changed"
    PACKML_CHANGED = "station-packml-changed"
    PRODUCTION_STARTED = "station-production-started"
    CONTROLLER_STARTED = "station-controller-started"
    ALARM_RAISED = "alarm-raised"
    ALARM_ENDED = "alarm-ended"


class JobEvent(DataModel):
    """An event: `number` counts from 1 without gaps, `time` is in seconds since the epoch, `time_at` in ISO 8601.

    Those of the station itself have no `job_order`.
    """

    number: int
    time: float
    time_at = iso("time")
    kind: EventKind
    job_order: str | None
    content: dict[str, JsonValue]


def append(
    connection: Connection, kind: EventKind, job_order: str | None, now: float, content: Mapping[str, JsonValue]
) -> int:
    """Write an event, within a `writing()` block; its number."""
    number = last(connection) + 1
    told = {"time": now, "kind": kind.value, "job_order": job_order or _OF_STATION, "content": json.dumps(content)}
    connection.execute(insert(JOB_EVENTS), {"number": number, **told})
    return number


def after(connection: Connection, number: int, limit: int) -> list[JobEvent]:
    """Up to `limit` events with numbers above `number`, the oldest first."""
    chosen = select(JOB_EVENTS).where(JOB_EVENTS.c.number > number).order_by(JOB_EVENTS.c.number).limit(limit)
    return [
        JobEvent.model_validate({**row, "job_order": row["job_order"] or None, "content": json.loads(row["content"])})
        for row in connection.execute(chosen).mappings()
    ]


def last_trimmed_event(connection: Connection) -> int:
    """The number of the last event that is kept no more; 0 if all are."""
    found: int | None = connection.execute(select(JOB_BEGIN.c.events)).scalar_one_or_none()
    return found or 0


def last(connection: Connection) -> int:
    """The number of the newest event; 0 where there was none."""
    found: int | None = connection.execute(select(func.max(JOB_EVENTS.c.number))).scalar_one()
    return found or last_trimmed_event(connection)


def require_kept(connection: Connection, after: int) -> None:
    """Raises `OrderRefused` (`events-gone`, 410) where an event behind `after` is kept no more."""
    if after < (gone := last_trimmed_event(connection)):
        raise OrderRefused("events-gone", message("refused.events-gone.up-to", number=gone), 410)
