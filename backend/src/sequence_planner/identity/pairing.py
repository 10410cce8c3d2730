"""Codes with which watches are paired: offered by somebody who is signed in, and good for one watch, for two minutes.

A code is short, as a person types it on a watch. What makes it hard to guess is that few guesses are allowed: five a
minute from one address and thirty altogether, where at most ten of the hundred million codes are good.
"""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict
from sqlalchemy import Connection, Row, Select, delete, insert, select

from sequence_planner.actor import Actor, ActorKind
from sequence_planner.identity import attempts
from sequence_planner.identity.attempts import EVERYBODY, Kind
from sequence_planner.identity.names import clean_name, name_key, short
from sequence_planner.identity.recording import record
from sequence_planner.identity.refusal import IdentityRefused
from sequence_planner.identity.tables import PAIRING_OFFERS, WATCHES
from sequence_planner.identity.tokens import hash_of, is_id, new_code, new_id, new_token, same
from sequence_planner.identity.watches import CONFIRMED_WITHIN, Watch, WatchState
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry, Outcome
from sequence_planner.storage.database import Database

OFFER_LIFE = 120.0  # seconds
MOST_OFFERS = 10  # at once


class PairingOffer(BaseModel):
    """A place for a watch of this name at a resource, for whoever knows the code before it `expires`."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    id: str
    name: str
    resource: str
    offered_by: str
    expires: float


def offer(connection: Connection, name: str, resource: str, by: Actor, now: float) -> tuple[str, PairingOffer]:
    """Offer a place, and get its code, which is kept nowhere.

    Raises `IdentityRefused`: `unfit-name` (422), `watch-exists` (409) when there is a watch or an offer of this name,
    `too-many-offers` (409).
    """
    name = clean_name(name)
    if _name_taken(connection, name, now):
        detail = f"There is a watch `{name}` already: take another name, or revoke that one."
        raise IdentityRefused("watch-exists", "Watch exists", detail, 409)
    if len(offers(connection, now)) >= MOST_OFFERS:
        detail = f"There are {MOST_OFFERS} offers already: withdraw one, or wait until they expire."
        raise IdentityRefused("too-many-offers", "Too many offers", detail, 409)
    made = PairingOffer(id=new_id(), name=name, resource=resource, offered_by=by.name, expires=now + OFFER_LIFE)
    code = new_code()
    hashes = {"code_hash": _code_hash(made.id, code), "name_key": name_key(name)}
    connection.execute(insert(PAIRING_OFFERS).values(**made.model_dump(), **hashes))
    _record(connection, made, "watch-offered", by, now)
    return code, made


def offers(connection: Connection, now: float) -> list[PairingOffer]:
    """The offers that are open, the newest first."""
    return [_offer(row) for row in connection.execute(_open(now).order_by(PAIRING_OFFERS.c.expires.desc()))]


def withdraw_offer(connection: Connection, id: str, by: Actor, now: float) -> None:
    """Let a code work no more. Raises `IdentityRefused` (`no-offer`, 404) when it was used, withdrawn or expired."""
    row = connection.execute(_open(now).where(PAIRING_OFFERS.c.id == id)).first() if is_id(id) else None
    if row is None:
        detail = "There is no such offer: its code was used, withdrawn, or has expired."
        raise IdentityRefused("no-offer", "No such offer", detail, 404)
    connection.execute(delete(PAIRING_OFFERS).where(PAIRING_OFFERS.c.id == id))
    _record(connection, _offer(row), "watch-offer-withdrawn", by, now)


def redeem(database: Database, code: str, now: float, *, address: str, agent: str) -> tuple[str, Watch]:
    """Take up an offer: the watch waits to be confirmed, with the token that it gets.

    It writes its own transactions, as a wrong code stays counted. Raises `IdentityRefused`: `wrong-code` (403),
    `too-many-attempts` (429).
    """
    counters = (attempts.of_address(Kind.PAIRING_ADDRESS, address), EVERYBODY)
    with database.reading() as connection:
        waiting = attempts.waiting(connection, counters, now)
    if waiting is None:
        with database.writing() as connection:
            waiting = attempts.waiting(connection, counters, now)
            taken = _take(connection, code, now) if waiting is None else None
            if taken is not None:
                return _make_watch(connection, taken, now, address, agent)
            if waiting is None:
                attempts.count(connection, counters, now)
                stranger = Actor(kind=ActorKind.WATCH, id="unknown", name="unknown", address=short(address))
                append(connection, Entry(actor=stranger, action="watch-redeemed", outcome=Outcome.REFUSED), now)
    if waiting is not None:
        raise waiting.refusal()
    detail = "This code does not work, or no longer: it works once, within two minutes. Ask for a new one."
    raise IdentityRefused("wrong-code", "Code does not work", detail, 403)


def _take(connection: Connection, code: str, now: float) -> PairingOffer | None:
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


def _record(connection: Connection, made: PairingOffer, action: str, by: Actor, now: float) -> None:
    record(connection, by, action, f"watch {made.name}", now, id=made.id, resource=made.resource)
