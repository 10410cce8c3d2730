"""Watches of people at the station. Each belongs to a resource, whose tasks it shows and acknowledges.

Somebody who is signed in offers a place under a name and gets a code; whoever types the code on a watch within two
minutes has it waiting under that name; and who offered it confirms that the watch at hand is the one. Where the code
was seen by somebody else, the watch at hand waits for nothing, and the other one is not confirmed.
"""

from __future__ import annotations

from enum import StrEnum

from pydantic import BaseModel, ConfigDict
from sqlalchemy import ColumnElement, Connection, Row, select, update

from sequence_planner.actor import Actor, ActorKind
from sequence_planner.identity.names import short
from sequence_planner.identity.recording import record
from sequence_planner.identity.refusal import IdentityRefused
from sequence_planner.identity.tables import WATCHES
from sequence_planner.identity.tokens import hash_of, is_id

DAY = 86400.0  # seconds
LIFE = 90 * DAY  # seconds that a watch works from its confirmation
CONFIRMED_WITHIN = 120.0  # seconds from the redeeming of the code
NOTED_EVERY = 60.0  # seconds; how exactly it is known when a watch was last seen


class WatchState(StrEnum):
    """How far a watch has come."""

    WAITING = "waiting"
    ACTIVE = "active"
    REVOKED = "revoked"
    EXPIRED = "expired"


class Watch(BaseModel):
    """A watch, as of the time that it was asked for. It works while it is active, until it `expires`.

    `paired_by` is the name of who let it in; `address` and `agent` are those it was paired from.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    id: str
    name: str
    resource: str
    state: WatchState
    paired_by: str
    created: float
    expires: float
    last_seen: float
    address: str
    agent: str

    def actor(self, address: str) -> Actor:
        """The watch that acts, from where the request comes."""
        return Actor(kind=ActorKind.WATCH, id=self.id, name=self.name, address=short(address))

    def due(self, now: float) -> bool:
        """Whether `seen` would write."""
        return self.last_seen <= now - NOTED_EVERY


def confirm(connection: Connection, id: str, by: Actor, now: float) -> Watch:
    """Let a watch in that waits. Raises `IdentityRefused`: `no-watch` (404), `watch-not-waiting` (409)."""
    watch = _known(connection, id, now)
    if watch.state is not WatchState.WAITING:
        detail = f"The watch {watch.name} does not wait to be let in: it is {watch.state.value}."
        raise IdentityRefused("watch-not-waiting", "Watch does not wait", detail, 409)
    changes = {"paired_by": by.name, "expires": now + LIFE}
    connection.execute(update(WATCHES).where(WATCHES.c.id == id).values(**changes, confirmed=now))
    _record(connection, watch, "watch-confirmed", by, now)
    return watch.model_copy(update={**changes, "state": WatchState.ACTIVE})


def find_watch(connection: Connection, token: str, now: float) -> Watch | None:
    """The watch with this token, active or waiting: none when it is unknown, revoked or expired."""
    live = (WATCHES.c.token_hash == hash_of(token)) & (WATCHES.c.expires > now) & WATCHES.c.revoked.is_(None)
    row = connection.execute(select(WATCHES).where(live)).first()
    return None if row is None else watch_of(row, now)


def seen(connection: Connection, id: str, now: float) -> None:
    """Note that a watch is in use; written at most once a minute."""
    due = (WATCHES.c.id == id) & (WATCHES.c.last_seen <= now - NOTED_EVERY)
    connection.execute(update(WATCHES).where(due).values(last_seen=now))


def all_watches(connection: Connection, now: float) -> list[Watch]:
    """All watches, the newest first; those that work no more are among them for 90 days."""
    listed = select(WATCHES).where(~given_up(now)).order_by(WATCHES.c.created.desc(), WATCHES.c.id)
    return [watch_of(row, now) for row in connection.execute(listed)]


def revoke(connection: Connection, id: str, by: Actor, now: float) -> None:
    """Let a watch work no more; nothing happens when it works no more already.

    Raises `IdentityRefused` (`no-watch`, 404).
    """
    watch = _known(connection, id, now)
    if watch.state in (WatchState.WAITING, WatchState.ACTIVE):
        connection.execute(update(WATCHES).where(WATCHES.c.id == id).values(revoked=now))
        _record(connection, watch, "watch-revoked", by, now)


def given_up(now: float) -> ColumnElement[bool]:
    """Rows of watches that nobody has let in in time; they are as good as gone."""
    return WATCHES.c.confirmed.is_(None) & (WATCHES.c.expires <= now)


def watch_of(row: Row[tuple[object, ...]], now: float) -> Watch:
    """What a row of the table means at a time."""
    parts = {name: getattr(row, name) for name in Watch.model_fields if name != "state"}
    return Watch(**parts, state=_state(row, now))


def _state(row: Row[tuple[object, ...]], now: float) -> WatchState:
    if row.revoked is not None:
        return WatchState.REVOKED
    if row.expires <= now:
        return WatchState.EXPIRED
    return WatchState.WAITING if row.confirmed is None else WatchState.ACTIVE


def _known(connection: Connection, id: str, now: float) -> Watch:
    found = select(WATCHES).where(WATCHES.c.id == id, ~given_up(now))
    row = connection.execute(found).first() if is_id(id) else None
    if row is None:
        detail = "There is no watch with this id, or nobody has let it in within two minutes."
        raise IdentityRefused("no-watch", "No such watch", detail, 404)
    return watch_of(row, now)


def _record(connection: Connection, watch: Watch, action: str, by: Actor, now: float) -> None:
    record(connection, by, action, f"watch {watch.name}", now, id=watch.id, resource=watch.resource)
