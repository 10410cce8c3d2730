"""What has happened to orders, numbered without gaps, so that whoever reads on from a number misses nothing.

An event is written in the transaction of the change that it tells of.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from enum import StrEnum

from pydantic import BaseModel, ConfigDict, JsonValue
from sqlalchemy import Connection, func, insert, select

from sequence_planner.mes.tables import JOB_EVENTS


class EventKind(StrEnum):
    """What has happened. A kind is never renamed; new ones may come."""

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
    OPERATION_STARTED = "operation-started"
    OPERATION_COMPLETED = "operation-completed"


class JobEvent(BaseModel):
    """An event: `number` counts from 1 without gaps, `time` is in seconds since the epoch."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    number: int
    time: float
    kind: EventKind
    job_order: str
    content: dict[str, JsonValue]


def append(
    connection: Connection, kind: EventKind, job_order: str, now: float, content: Mapping[str, JsonValue]
) -> int:
    """Write an event, within a `writing()` block; its number."""
    number = last(connection) + 1
    row = {"number": number, "time": now, "kind": kind.value, "job_order": job_order, "content": json.dumps(content)}
    connection.execute(insert(JOB_EVENTS), row)
    return number


def after(connection: Connection, number: int, limit: int) -> list[JobEvent]:
    """Up to `limit` events with numbers above `number`, the oldest first."""
    chosen = select(JOB_EVENTS).where(JOB_EVENTS.c.number > number).order_by(JOB_EVENTS.c.number).limit(limit)
    return [
        JobEvent.model_validate({**row, "content": json.loads(row["content"])})
        for row in connection.execute(chosen).mappings()
    ]


def last(connection: Connection) -> int:
    """The number of the newest event; 0 where there is none."""
    found: int | None = connection.execute(select(func.max(JOB_EVENTS.c.number))).scalar_one()
    return found or 0
