"""Smartwatches of operators: pairing codes, confirmation, lookup by resource and revocation."""

from __future__ import annotations

from enum import StrEnum

from sqlalchemy import ColumnElement, Connection, Row, Select, delete, insert, select, update

from sequence_planner.auth import rate_limit
from sequence_planner.auth.rate_limit import EVERYBODY, AttemptKind
from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.tables import PAIRING_OFFERS, WATCHES
from sequence_planner.auth.tokens import (
    clean_name,
    hash_of,
    is_id,
    name_key,
    new_code,
    new_id,
    new_token,
    record,
    same,
    short,
)
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.data_models import DataModel
from sequence_planner.db.database import Database
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry, Outcome
from sequence_planner.texts.message import message

# Watches of people at the station. Each belongs to a resource, whose tasks it shows and acknowledges.
#
# Somebody who is signed in offers a place under a name and gets a code; whoever types the code on a watch within two
# minutes has it waiting under that name; and who offered it confirms that the watch at hand is the one. Where the code
# was seen by somebody else, the watch at hand waits for nothing, and the other one is not confirmed.

DAY = 86400.0  # seconds
LIFE = 90 * DAY  # seconds that a watch works from its confirmation
CONFIRMED_WITHIN = 120.0  # seconds from the redeeming of the code
NOTED_EVERY = 60.0  # seconds; how exactly it is known when a watch was last seen


class WatchState(StrEnum):
    """Progress of a watch's registration."""

    WAITING = "waiting"
    ACTIVE = "active"
    REVOKED = "revoked"
    EXPIRED = "expired"


class Watch(DataModel):
    """A watch, as of the time that it was asked for. It works while it is active, until it `expires`.

    `paired_by` is the name of who let it in; `address` and `agent` are those it was paired from.
    """

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
        """Return whether `seen` would write."""
        return self.last_seen <= now - NOTED_EVERY


def confirm(connection: Connection, id: str, by: Actor, now: float) -> Watch:
    """Let a watch in that waits. Raises `IdentityRefused`: `no-wearable` (404), `wearable-not-waiting` (409)."""
    watch = _known(connection, id, now)
    if watch.state is not WatchState.WAITING:
        raise IdentityRefused(
            "wearable-not-waiting",
            message(
                "refused.wearable-not-waiting.state", name=watch.name, state=message(f"watch-state.{watch.state.value}")
            ),
            409,
        )
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

    Raises `IdentityRefused` (`no-wearable`, 404).
    """
    watch = _known(connection, id, now)
    if watch.state in (WatchState.WAITING, WatchState.ACTIVE):
        connection.execute(update(WATCHES).where(WATCHES.c.id == id).values(revoked=now))
        _record(connection, watch, "watch-revoked", by, now)


def given_up(now: float) -> ColumnElement[bool]:
    """Rows of watches that nobody has let in in time; they are as good as gone."""
    return WATCHES.c.confirmed.is_(None) & (WATCHES.c.expires <= now)


def watch_of(row: Row[tuple[object, ...]], now: float) -> Watch:
    """Return what a row of the table means at a time."""
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
        raise IdentityRefused("no-wearable", message("refused.no-wearable.id"), 404)
    return watch_of(row, now)


def _record(connection: Connection, watch: Watch, action: str, by: Actor, now: float) -> None:
    record(connection, by, action, f"watch {watch.name}", now, id=watch.id, resource=watch.resource)


# Codes with which watches are paired: offered by somebody who is signed in, and good for one watch, for two minutes.
#
# A code is short, as a person types it on a watch. What makes it hard to guess is that few guesses are allowed: five a
# minute from one address and thirty altogether, where at most ten of the hundred million codes are good.

OFFER_LIFE = 120.0  # seconds
MOST_OFFERS = 10  # at once


class PairingOffer(DataModel):
    """A place for a watch of this name at a resource, for whoever knows the code before it `expires`."""

    id: str
    name: str
    resource: str
    offered_by: str
    expires: float


def offer(connection: Connection, name: str, resource: str, by: Actor, now: float) -> tuple[str, PairingOffer]:
    """Offer a place, and get its code, which is kept nowhere.

    Raises `IdentityRefused`: `invalid-name` (422), `wearable-exists` (409) when there is a watch or an offer of this
    name, `too-many-offers` (409).
    """
    name = clean_name(name)
    if _name_taken(connection, name, now):
        raise IdentityRefused("wearable-exists", message("refused.wearable-exists.name", name=name), 409)
    if len(offers(connection, now)) >= MOST_OFFERS:
        raise IdentityRefused("too-many-offers", message("refused.too-many-offers.most", most=MOST_OFFERS), 409)
    made = PairingOffer(id=new_id(), name=name, resource=resource, offered_by=by.name, expires=now + OFFER_LIFE)
    code = new_code()
    hashes = {"code_hash": _code_hash(made.id, code), "name_key": name_key(name)}
    connection.execute(insert(PAIRING_OFFERS).values(**made.model_dump(), **hashes))
    _record_pairing(connection, made, "watch-offered", by, now)
    return code, made


def offers(connection: Connection, now: float) -> list[PairingOffer]:
    """The offers that are open, the newest first."""
    return [_offer(row) for row in connection.execute(_open(now).order_by(PAIRING_OFFERS.c.expires.desc()))]


def withdraw_offer(connection: Connection, id: str, by: Actor, now: float) -> None:
    """Let a code work no more. Raises `IdentityRefused` (`no-offer`, 404) when it was used, withdrawn or expired."""
    row = connection.execute(_open(now).where(PAIRING_OFFERS.c.id == id)).first() if is_id(id) else None
    if row is None:
        raise IdentityRefused("no-offer", message("refused.no-offer.used"), 404)
    connection.execute(delete(PAIRING_OFFERS).where(PAIRING_OFFERS.c.id == id))
    _record_pairing(connection, _offer(row), "watch-offer-withdrawn", by, now)


def redeem(database: Database, code: str, now: float, *, address: str, agent: str) -> tuple[str, Watch]:
    """Take up an offer: the watch waits to be confirmed, with the token that it gets.

    It writes its own transactions, as a wrong code stays counted. Raises `IdentityRefused`: `wrong-code` (403),
    `too-many-attempts` (429).
    """
    counters = (rate_limit.of_address(AttemptKind.PAIRING_ADDRESS, address), EVERYBODY)
    with database.reading() as connection:
        waiting = rate_limit.waiting(connection, counters, now)
    if waiting is None:
        with database.writing() as connection:
            waiting = rate_limit.waiting(connection, counters, now)
            taken = _redeem(connection, code, now) if waiting is None else None
            if taken is not None:
                return _make_watch(connection, taken, now, address, agent)
            if waiting is None:
                rate_limit.count(connection, counters, now)
                stranger = Actor(kind=ActorKind.WATCH, id="unknown", name="unknown", address=short(address))
                append(connection, Entry(actor=stranger, action="watch-redeemed", outcome=Outcome.REFUSED), now)
    if waiting is not None:
        raise waiting.refusal()
    raise IdentityRefused("wrong-code", message("refused.wrong-code.again"), 403)


def _redeem(connection: Connection, code: str, now: float) -> PairingOffer | None:
    """The offer of a code, which is gone then."""
    matching = [row for row in connection.execute(_open(now)) if same(row.code_hash, _code_hash(row.id, code))]
    if not matching:
        return None
    connection.execute(delete(PAIRING_OFFERS).where(PAIRING_OFFERS.c.id == matching[0].id))
    return _offer(matching[0])


def _make_watch(connection: Connection, taken: PairingOffer, now: float, address: str, agent: str) -> tuple[str, Watch]:
    token = new_token()
    watch = Watch(
        id=new_id(),
        name=taken.name,
        resource=taken.resource,
        state=WatchState.WAITING,
        paired_by=taken.offered_by,
        created=now,
        expires=now + CONFIRMED_WITHIN,
        last_seen=now,
        address=short(address),
        agent=short(agent),
    )
    values = watch.model_dump(exclude={"state"})
    connection.execute(insert(WATCHES).values(**values, token_hash=hash_of(token), name_key=name_key(taken.name)))
    actor, subject = watch.actor(address), f"watch {watch.name}"
    record(connection, actor, "watch-redeemed", subject, now, id=watch.id, offer=taken.id, resource=watch.resource)
    return token, watch


def _name_taken(connection: Connection, name: str, now: float) -> bool:
    same_watch = (WATCHES.c.name_key == name_key(name)) & (WATCHES.c.expires > now) & WATCHES.c.revoked.is_(None)
    same_offer = (PAIRING_OFFERS.c.name_key == name_key(name)) & (PAIRING_OFFERS.c.expires > now)
    found = select(WATCHES.c.id).where(same_watch).union_all(select(PAIRING_OFFERS.c.id).where(same_offer))
    return connection.execute(found).first() is not None


def _code_hash(id: str, code: str) -> str:
    """A code may be typed with blanks; it is hashed with its offer, so that no table of all codes is of use."""
    return hash_of(f"{id}:{''.join(code.split())}")


def _open(now: float) -> Select[tuple[object, ...]]:
    return select(PAIRING_OFFERS).where(PAIRING_OFFERS.c.expires > now)


def _offer(row: Row[tuple[object, ...]]) -> PairingOffer:
    return PairingOffer(id=row.id, name=row.name, resource=row.resource, offered_by=row.offered_by, expires=row.expires)


def _record_pairing(connection: Connection, made: PairingOffer, action: str, by: Actor, now: float) -> None:
    record(connection, by, action, f"watch {made.name}", now, id=made.id, resource=made.resource)
