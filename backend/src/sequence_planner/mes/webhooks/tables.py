"""The tables of this package. Times are seconds since the epoch."""

from __future__ import annotations

from typing import Final

from sqlalchemy import Column, Double, Index, Integer, String, Table, Text

from sequence_planner.db.metadata import METADATA
from sequence_planner.journal.hash_chain import NUMBER
from sequence_planner.mes.webhooks.targets import LONGEST_URL

ID: Final = String(40)

WEBHOOKS: Final = Table(
    "webhooks",
    METADATA,
    Column("id", ID, primary_key=True),
    Column("title", String(100), nullable=False),
    Column("url", String(LONGEST_URL), nullable=False),
    Column("kinds", Text, nullable=False),  # of events, divided by blanks; empty: all
    Column("secret", Text, nullable=False),  # sealed: see `sealing`
    Column("created", Double, nullable=False),
    Column("created_by", String(200), nullable=False),
    Column("position", NUMBER, nullable=False),  # of the last event that was looked at
    Column("delivered", NUMBER, nullable=False),  # how many
    Column("last_delivered", Double, nullable=True),
    Column("failures", Integer, nullable=False),  # since the last delivery
    Column("held_until", Double, nullable=False),  # nothing is sent before
    Column("trouble", Text, nullable=True),  # what went wrong last; none after a delivery
)

WEBHOOK_DELIVERIES: Final = Table(
    "webhook_deliveries",
    METADATA,
    Column("webhook", ID, primary_key=True),
    Column("event", NUMBER, primary_key=True, autoincrement=False),
    Column("attempts", Integer, nullable=False),
    Column("next", Double, nullable=False),  # when it is tried
    Column("died", Double, nullable=True),  # when it was given up
    Column("trouble", Text, nullable=True),
    Index("ix_webhook_deliveries_webhook_died_next", "webhook", "died", "next"),
)
"""Events that are still to be delivered, and those that were given up; what was delivered is gone."""
