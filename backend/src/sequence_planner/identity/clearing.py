"""Clearing away what is over: sessions, attempts, links and offers at once, keys and watches after 90 days."""

from __future__ import annotations

from sqlalchemy import Connection, delete

from sequence_planner.identity import attempts
from sequence_planner.identity.keys import KEPT
from sequence_planner.identity.sessions import live
from sequence_planner.identity.tables import (
    ATTEMPTS,
    FIRST_START_LINKS,
    KEYS,
    PAIRING_OFFERS,
    PROVIDER_FLOWS,
    SESSIONS,
    WATCHES,
)
from sequence_planner.identity.watches import given_up


def clear(connection: Connection, now: float) -> None:
    """Delete rows that mean nothing any more. Called whenever somebody tries to sign in; nothing depends on when."""
    for table, over in (
        (SESSIONS, ~live(now)),
        (ATTEMPTS, ATTEMPTS.c.last < now - attempts.FORGOTTEN_AFTER),
        (FIRST_START_LINKS, FIRST_START_LINKS.c.expires <= now),
        (PROVIDER_FLOWS, PROVIDER_FLOWS.c.expires <= now),
        (PAIRING_OFFERS, PAIRING_OFFERS.c.expires <= now),
        (KEYS, (KEYS.c.expires <= now - KEPT) | (KEYS.c.revoked <= now - KEPT)),
        (WATCHES, given_up(now) | (WATCHES.c.expires <= now - KEPT) | (WATCHES.c.revoked <= now - KEPT)),
    ):
        connection.execute(delete(table).where(over))
