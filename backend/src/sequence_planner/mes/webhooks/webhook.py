"""Webhooks in the database: who is told of which events.

Each change is one transaction, with the record of who did it.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict
from sqlalchemy import Connection, RowMapping, delete, func, insert, select

from sequence_planner.actor import Actor
from sequence_planner.identity.names import clean_name
from sequence_planner.identity.recording import record
from sequence_planner.identity.tokens import is_id, new_id
from sequence_planner.mes import events
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.refusal import OrderRefused
from sequence_planner.mes.times import iso
from sequence_planner.mes.webhooks.sealing import Seal
from sequence_planner.mes.webhooks.signing import new_secret
from sequence_planner.mes.webhooks.tables import WEBHOOK_DELIVERIES, WEBHOOKS

MOST_WEBHOOKS: Final = 20


class Webhook(BaseModel):
    """Who is told, without the secret.

    Events up to `position` were delivered, or wait, or were given up; `waiting` and `given_up` say how many. `failures`
    counts attempts since the last delivery, after which nothing is sent before `held_until`; `trouble` is what went
    wrong in the last of them. No `kinds` are all kinds of events.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    id: str
    title: str
    url: str
    kinds: tuple[EventKind, ...]
    created: float
    created_at = iso("created")
    created_by: str
    position: int
    delivered: int
    last_delivered: float | None
    last_delivered_at = iso("last_delivered", optional=True)
    waiting: int
    given_up: int
    failures: int
    held_until: float
    held_until_at = iso("held_until")
    trouble: str | None


def make(
    connection: Connection,
    seal: Seal,
    title: str,
    url: str,
    kinds: Collection[EventKind],
    after: int | None,
    by: Actor,
    now: float,
) -> tuple[str, Webhook]:
    """A new webhook, told of the events after that one (None: after the last that there is), and its secret.

    `url` must be one that may be sent to. Raises `OrderRefused` (`too-many-webhooks`, 409; `events-gone`, 410), and
    `IdentityRefused` (`unfit-name`, 422).
    """
    if (connection.execute(select(func.count()).select_from(WEBHOOKS)).scalar_one()) >= MOST_WEBHOOKS:
        detail = f"There are {MOST_WEBHOOKS} webhooks. Delete one that is not needed."
        raise OrderRefused("too-many-webhooks", "There are too many webhooks", detail)
    if after is not None:
        events.require_kept(connection, after)
    id, secret, last = new_id(), new_secret(), events.last(connection)
    asked = " ".join(each for each in EventKind if each in kinds)
    row = {
        "id": id,
        "title": clean_name(title),
        "url": url,
        "kinds": asked,
        "secret": seal.seal(secret, id),
        "created": now,
        "created_by": by.name,
        "position": last if after is None else min(after, last),
        "delivered": 0,
        "failures": 0,
        "held_until": 0.0,
    }
    connection.execute(insert(WEBHOOKS), row)
    record(connection, by, "webhook-created", f"webhook {row['title']}", now, id=id, to=_host(url), kinds=asked)
    return secret, get(connection, id)


def get(connection: Connection, id: str) -> Webhook:
    """The webhook with this id. Raises `OrderRefused` (`no-webhook`, 404)."""
    row = connection.execute(select(WEBHOOKS).where(WEBHOOKS.c.id == id)).mappings().first() if is_id(id) else None
    if row is None:
        raise OrderRefused(
            "no-webhook", "No such webhook", "There is no webhook with this id. Look at those that there are.", 404
        )
    return _webhook(row, _counts(connection))


def everyone(connection: Connection) -> list[Webhook]:
    """All webhooks, the newest first."""
    counts = _counts(connection)
    rows = connection.execute(select(WEBHOOKS).order_by(WEBHOOKS.c.created.desc(), WEBHOOKS.c.id)).mappings()
    return [_webhook(row, counts) for row in rows]


def remove(connection: Connection, id: str, by: Actor, now: float) -> None:
    """Tell it of nothing more; what waits for it goes. Raises `OrderRefused` (`no-webhook`, 404)."""
    webhook = get(connection, id)
    connection.execute(delete(WEBHOOK_DELIVERIES).where(WEBHOOK_DELIVERIES.c.webhook == id))
    connection.execute(delete(WEBHOOKS).where(WEBHOOKS.c.id == id))
    left = webhook.waiting + webhook.given_up
    to = _host(webhook.url)
    record(connection, by, "webhook-deleted", f"webhook {webhook.title}", now, id=id, to=to, undelivered=left)


def _host(url: str) -> str:
    """All that the journal has of a URL: more people read that than webhooks, and a path or a query may be a secret."""
    return urlsplit(url).netloc


def _counts(connection: Connection) -> dict[tuple[str, bool], int]:
    """How many events wait for each webhook, and how many were given up."""
    given_up = WEBHOOK_DELIVERIES.c.died.is_not(None)
    grouped = select(WEBHOOK_DELIVERIES.c.webhook, given_up, func.count()).group_by(
        WEBHOOK_DELIVERIES.c.webhook, given_up
    )
    return {(id, bool(dead)): count for id, dead, count in connection.execute(grouped)}


def _webhook(row: RowMapping, counts: dict[tuple[str, bool], int]) -> Webhook:
    shown = {name: value for name, value in row.items() if name != "secret"}
    return Webhook.model_validate(
        {
            **shown,
            "kinds": tuple(row["kinds"].split()),
            "waiting": counts.get((row["id"], False), 0),
            "given_up": counts.get((row["id"], True), 0),
        }
    )
