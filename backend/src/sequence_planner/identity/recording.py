"""Entries of this room in the journal."""

from __future__ import annotations

from pydantic import JsonValue
from sqlalchemy import Connection

from sequence_planner.actor import Actor
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry


def record(connection: Connection, by: Actor, action: str, subject: str, now: float, **details: JsonValue) -> None:
    """Write that something was done, in the transaction that does it."""
    append(connection, Entry(actor=by, action=action, subject=subject, details=details), now)
