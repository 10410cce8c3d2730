"""The tables of this package: orders, what has become of them, and the answers to repeated requests.

Times are seconds since the epoch. An order that was cancelled or cleared stays, without being shown. What is over long
enough is taken out (`retention`): of an order its id stays, so that it never means another one.
"""

from __future__ import annotations

from typing import Final

from sqlalchemy import Column, Double, Index, Integer, String, Table, Text, text

from sequence_planner.db.metadata import METADATA
from sequence_planner.journal.hash_chain import NUMBER

LONGEST_ID: Final = 64  # characters
ORDER: Final = String(LONGEST_ID)
NAME: Final = String(200)
SHOWN: Final = text("removed IS NULL")


def _shown(name: str, *columns: str) -> Index:
    """An index of what is shown alone: in the end nearly all orders are cleared."""
    return Index(name, *columns, sqlite_where=SHOWN, postgresql_where=SHOWN)


JOB_ORDERS: Final = Table(
    "job_orders",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),  # in the order in which they were stored
    Column("id", ORDER, nullable=False, unique=True),
    Column("work_master", NAME, nullable=False),
    Column("description", Text, nullable=False),
    Column("priority", Integer, nullable=False),
    Column("due", Double, nullable=True),
    Column("earliest", Double, nullable=True),
    Column("state", String(20), nullable=False),
    Column("revision", Integer, nullable=False),  # counts its changes
    Column("stored", Double, nullable=False),
    Column("stored_by", NAME, nullable=False),
    Column("changed", Double, nullable=False),
    Column("handed_over", Double, nullable=True),  # since when the station may have it
    Column("began", Double, nullable=True),
    Column("ended", Double, nullable=True),
    Column("wish", String(20), nullable=True),  # what the station is still to do with it
    Column("wished_by", Text, nullable=True),  # JSON of the actor
    Column("wished_because", Text, nullable=True),
    Column("removed", Double, nullable=True),  # when it was cancelled or cleared
    _shown("ix_job_orders_shown", "number"),
    _shown("ix_job_orders_shown_state", "state", "number"),
)

JOB_EVENTS: Final = Table(
    "job_events",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),
    Column("time", Double, nullable=False),
    Column("kind", String(40), nullable=False),
    Column("job_order", ORDER, nullable=False, index=True),
    Column("content", Text, nullable=False),  # JSON
)

JOB_RESPONSES: Final = Table(
    "job_responses",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),
    Column("job_order", ORDER, nullable=False, unique=True),
    Column("time", Double, nullable=False),
    Column("content", Text, nullable=False),  # JSON
    Column("removed", Double, nullable=True),  # as of its order
    _shown("ix_job_responses_shown", "number"),
)

JOB_BEGIN: Final = Table(
    "job_begin",
    METADATA,
    Column("id", Integer, primary_key=True, autoincrement=False),
    Column("orders", NUMBER, nullable=False),  # the highest number of an order that is gone
    Column("events", NUMBER, nullable=False),  # that of the last event that is gone, and all before are
    Column("responses", NUMBER, nullable=False),  # as of events
)
"""One row: up to where retention has taken things out."""

JOB_ORDERS_GONE: Final = Table(
    "job_orders_gone",
    METADATA,
    Column("id", ORDER, primary_key=True),
    Column("ended", Double, nullable=False),
)
"""The orders that retention has taken out."""

JOB_LEDGER: Final = Table(
    "job_ledger",
    METADATA,
    Column("id", Integer, primary_key=True, autoincrement=False),
    Column("number", NUMBER, nullable=False),  # of the last record of the run that has been read
    Column("content", Text, nullable=False),  # JSON
)
"""One row, or none: how far the run was read, and what was made until there for the jobs under way."""

JOB_ANSWERS: Final = Table(
    "job_answers",
    METADATA,
    Column("bearer", NAME, primary_key=True),  # the actor's id
    Column("key", NAME, primary_key=True),
    Column("digest", String(64), nullable=False),  # of the request
    Column("status", Integer, nullable=False),
    Column("tag", String(20), nullable=False),
    Column("content", Text, nullable=False),
    Column("time", Double, nullable=False, index=True),
)
"""Answers to requests with an `Idempotency-Key`."""
