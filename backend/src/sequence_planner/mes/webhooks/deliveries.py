"""The deliveries still to be made, in the database, so that they are so after whatever has happened to the server.

An event is taken out only after it was taken by the other end: when the server is killed in between, it is sent again.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Final

from sqlalchemy import ColumnElement, Connection, delete, func, insert, select, update

from sequence_planner.auth.tokens import record
from sequence_planner.core.actor import Actor
from sequence_planner.core.clock import iso
from sequence_planner.core.data_models import DataModel
from sequence_planner.mes import events
from sequence_planner.mes.events import JobEvent
from sequence_planner.mes.webhooks import endpoints as webhooks
from sequence_planner.mes.webhooks.tables import WEBHOOK_DELIVERIES, WEBHOOKS

MOST_WAITING: Final = 1000  # events for one webhook; further ones are looked at when some of these were delivered
_PAGE: Final = 200
_OF = WEBHOOK_DELIVERIES.c


@dataclass(frozen=True)
class Pace:
    """The times when what failed is tried again: after `first` seconds, then twice as long each time, up to `longest`.

    Between half of that and all of it is waited, by chance, so that not all come back at once. A webhook as a whole is
    tried again after `longest_hold` at the latest. An event is given up after `attempts`.
    """

    first: float = 2.0
    longest: float = 3600.0
    longest_hold: float = 300.0
    attempts: int = 20

    def after(self, failures: int, longest: float) -> float:
        """The seconds to wait after so many failures, one at least."""
        return float(min(self.first * 2.0 ** min(failures - 1, 60), longest) * random.uniform(0.5, 1.0))


@dataclass(frozen=True)
class Due:
    """An event that is to be sent now."""

    webhook: str
    url: str
    secret: str  # sealed
    event: JobEvent
    attempts: int


class DeadLetter(DataModel):
    """An event that was given up, after so many attempts, and what went wrong in the last."""

    event: JobEvent
    attempts: int
    died: float
    died_at = iso("died")
    trouble: str


def are_any(connection: Connection) -> bool:
    """Return whether there are webhooks."""
    return connection.execute(select(WEBHOOKS.c.id).limit(1)).first() is not None


def waiting(connection: Connection, now: float) -> list[str]:
    """The webhooks for which there is something to do now: events to look at, or one to be sent."""
    last = events.last(connection)
    due = select(_OF.webhook).where(_OF.died.is_(None), _OF.next <= now)
    to_do = (WEBHOOKS.c.position < last) | WEBHOOKS.c.id.in_(due)
    return list(connection.execute(select(WEBHOOKS.c.id).where(to_do, WEBHOOKS.c.held_until <= now)).scalars())


def queue(connection: Connection, webhook: str, now: float) -> None:
    """Have new events wait for a webhook, as far as there is room."""
    row = connection.execute(select(WEBHOOKS).where(WEBHOOKS.c.id == webhook)).mappings().first()
    if row is None:
        return
    count = select(func.count()).select_from(WEBHOOK_DELIVERIES).where(_OF.webhook == webhook, _OF.died.is_(None))
    room = min(MOST_WAITING - connection.execute(count).scalar_one(), _PAGE)
    found = events.after(connection, row["position"], room) if room > 0 else []
    if not found:
        return
    kinds = frozenset(row["kinds"].split())
    rows = [
        {"webhook": webhook, "event": each.number, "attempts": 0, "next": now}
        for each in found
        if not kinds or each.kind in kinds
    ]
    if rows:
        connection.execute(insert(WEBHOOK_DELIVERIES), rows)
    connection.execute(update(WEBHOOKS).where(WEBHOOKS.c.id == webhook).values(position=found[-1].number))


def has_new(connection: Connection, webhook: str) -> bool:
    """Return whether there are events that were not looked at for a webhook."""
    position = connection.execute(select(WEBHOOKS.c.position).where(WEBHOOKS.c.id == webhook)).scalar()
    return position is not None and position < events.last(connection)


def due(connection: Connection, webhook: str, now: float) -> Due | None:
    """The oldest event that may be sent now; None while the webhook is held, or is gone."""
    found = (
        select(WEBHOOKS.c.url, WEBHOOKS.c.secret, _OF.event, _OF.attempts)
        .join(WEBHOOK_DELIVERIES, _OF.webhook == WEBHOOKS.c.id)
        .where(WEBHOOKS.c.id == webhook, WEBHOOKS.c.held_until <= now, _OF.died.is_(None), _OF.next <= now)
        .order_by(_OF.event)
        .limit(1)
    )
    row = connection.execute(found).first()
    if row is None:
        return None
    (event,) = events.after(connection, row.event - 1, 1)
    return Due(webhook, row.url, row.secret, event, row.attempts)


def delivered(connection: Connection, sent: Due, now: float) -> None:
    """An event was taken."""
    connection.execute(delete(WEBHOOK_DELIVERIES).where(_is(sent.webhook, sent.event.number)))
    fresh = {"failures": 0, "held_until": 0.0, "trouble": None, "last_delivered": now}
    counted = {**fresh, "delivered": WEBHOOKS.c.delivered + 1}
    connection.execute(update(WEBHOOKS).where(WEBHOOKS.c.id == sent.webhook).values(counted))


def failed(connection: Connection, sent: Due, trouble: str, pace: Pace, now: float) -> None:
    """An event was not taken: it is tried again later, or given up."""
    attempts = sent.attempts + 1
    later = now + pace.after(attempts, pace.longest)
    changed = {
        "attempts": attempts,
        "next": later,
        "trouble": trouble,
        "died": now if attempts >= pace.attempts else None,
    }
    connection.execute(update(WEBHOOK_DELIVERIES).where(_is(sent.webhook, sent.event.number)).values(changed))
    hold(connection, sent.webhook, trouble, pace, now)


def hold(connection: Connection, webhook: str, trouble: str, pace: Pace, now: float) -> None:
    """Send nothing to a webhook for a while."""
    chosen = WEBHOOKS.c.id == webhook
    failures = (connection.execute(select(WEBHOOKS.c.failures).where(chosen)).scalar() or 0) + 1
    held = {"failures": failures, "held_until": now + pace.after(failures, pace.longest_hold), "trouble": trouble}
    connection.execute(update(WEBHOOKS).where(chosen).values(held))


def dead_letters(connection: Connection, webhook: str, after: int, limit: int) -> list[DeadLetter]:
    """Up to `limit` events that were given up, those after that one, the oldest first.

    Raises `OrderRefused` (`no-webhook`, 404).
    """
    webhooks.get(connection, webhook)
    chosen = _OF.webhook == webhook, _OF.died.is_not(None), _OF.event > after
    rows = connection.execute(select(WEBHOOK_DELIVERIES).where(*chosen).order_by(_OF.event).limit(limit)).all()
    return [
        DeadLetter(
            event=events.after(connection, row.event - 1, 1)[0],
            attempts=row.attempts,
            died=row.died,
            trouble=row.trouble or "",
        )
        for row in rows
    ]


def send_again(connection: Connection, webhook: str, numbers: list[int] | None, by: Actor, now: float) -> int:
    """Try events once more that were given up, all of them (None) or these; how many they are.

    Raises `OrderRefused` (`no-webhook`, 404).
    """
    title = webhooks.get(connection, webhook).title
    chosen = (_OF.webhook == webhook) & _OF.died.is_not(None)
    if numbers is not None:
        chosen &= _OF.event.in_(numbers)
    fresh = {"attempts": 0, "next": now, "died": None}
    count = connection.execute(update(WEBHOOK_DELIVERIES).where(chosen).values(fresh)).rowcount
    if count:
        connection.execute(update(WEBHOOKS).where(WEBHOOKS.c.id == webhook).values(held_until=0.0))
        record(connection, by, "webhook-sent-again", f"webhook {title}", now, id=webhook, events=count)
    return count


def _is(webhook: str, event: int) -> ColumnElement[bool]:
    return (_OF.webhook == webhook) & (_OF.event == event)
