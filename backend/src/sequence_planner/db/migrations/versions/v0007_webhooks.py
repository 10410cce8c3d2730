"""Webhooks, and the events that are still to be delivered to them."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Column, Double, Integer, String, Text

revision = "0007"
down_revision = "0006"

NUMBER = BigInteger().with_variant(Integer, "sqlite")
ID = String(40)


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "webhooks",
        Column("id", ID, primary_key=True),
        Column("title", String(100), nullable=False),
        Column("url", String(2000), nullable=False),
        Column("kinds", Text, nullable=False),
        Column("secret", Text, nullable=False),
        Column("created", Double, nullable=False),
        Column("created_by", String(200), nullable=False),
        Column("position", NUMBER, nullable=False),
        Column("delivered", NUMBER, nullable=False),
        Column("last_delivered", Double, nullable=True),
        Column("failures", Integer, nullable=False),
        Column("held_until", Double, nullable=False),
        Column("trouble", Text, nullable=True),
    )
    op.create_table(
        "webhook_deliveries",
        Column("webhook", ID, primary_key=True),
        Column("event", NUMBER, primary_key=True, autoincrement=False),
        Column("attempts", Integer, nullable=False),
        Column("next", Double, nullable=False),
        Column("died", Double, nullable=True),
        Column("trouble", Text, nullable=True),
    )
    op.create_index("ix_webhook_deliveries_webhook_died_next", "webhook_deliveries", ["webhook", "died", "next"])
