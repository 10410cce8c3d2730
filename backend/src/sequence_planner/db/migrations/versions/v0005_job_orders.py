"""Job orders, what has become of them, and the answers to repeated requests."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Column, Double, Integer, String, Text

revision = "0005"
down_revision = "0004"

NUMBER = BigInteger().with_variant(Integer, "sqlite")
ORDER = String(64)
NAME = String(200)


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "job_orders",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("id", ORDER, nullable=False, unique=True),
        Column("work_master", NAME, nullable=False),
        Column("description", Text, nullable=False),
        Column("priority", Integer, nullable=False),
        Column("due", Double, nullable=True),
        Column("earliest", Double, nullable=True),
        Column("state", String(20), nullable=False),
        Column("revision", Integer, nullable=False),
        Column("stored", Double, nullable=False),
        Column("stored_by", NAME, nullable=False),
        Column("changed", Double, nullable=False),
        Column("handed_over", Double, nullable=True),
        Column("began", Double, nullable=True),
        Column("ended", Double, nullable=True),
        Column("wish", String(20), nullable=True),
        Column("wished_by", Text, nullable=True),
        Column("wished_because", Text, nullable=True),
        Column("removed", Double, nullable=True),
    )
    op.create_index("ix_job_orders_state_number", "job_orders", ["state", "number"])
    op.create_table(
        "job_events",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("time", Double, nullable=False),
        Column("kind", String(40), nullable=False),
        Column("job_order", ORDER, nullable=False, index=True),
        Column("content", Text, nullable=False),
    )
    op.create_table(
        "job_responses",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("job_order", ORDER, nullable=False, unique=True),
        Column("time", Double, nullable=False),
        Column("content", Text, nullable=False),
    )
    op.create_table(
        "job_ledger",
        Column("id", Integer, primary_key=True, autoincrement=False),
        Column("number", NUMBER, nullable=False),
        Column("content", Text, nullable=False),
    )
    op.create_table(
        "job_answers",
        Column("bearer", NAME, primary_key=True),
        Column("key", NAME, primary_key=True),
        Column("digest", String(64), nullable=False),
        Column("status", Integer, nullable=False),
        Column("tag", String(20), nullable=False),
        Column("content", Text, nullable=False),
        Column("time", Double, nullable=False, index=True),
    )
