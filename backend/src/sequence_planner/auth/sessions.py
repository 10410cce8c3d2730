"""Sessions of people who have signed in. A session that has ended is gone from the database.

A session's token is drawn anew whenever somebody signs in or changes the password, so one that was planted before is
worth nothing; when a person's role changes or the person is disabled, all of them end.
"""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import ColumnElement, Connection, Row, Select, delete, func, insert, select, update

from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.tables import PEOPLE, SESSIONS
from sequence_planner.auth.tokens import hash_of, new_id, new_token, record, short
from sequence_planner.auth.users import DEMONSTRATOR, Person, get_user
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.data_models import DataModel
from sequence_planner.texts.message import message

LONGEST = 12 * 3600.0  # seconds from the sign-in
LONGEST_IDLE = 3600.0  # seconds without a request or an open stream
NOTED_EVERY = 60.0  # seconds; how exactly it is known when a session was last seen
MOST_OF_A_PERSON = 20  # a further one ends the one that was not seen for longest
MOST_DEMONSTRATIONS = 200


class SignedIn(DataModel):
    """A live session: `session` is its id, which anybody may know; `expires` is when it ends at the latest."""

    session: str
    person: Person
    kind: ActorKind
    created: float
    expires: float
    last_seen: float
    address: str
    agent: str

    def actor(self, address: str) -> Actor:
        """Return who acts in this session, from where the request comes now."""
        person = self.person
        return Actor(kind=self.kind, id=person.id, name=person.name, session=self.session, address=short(address))

    def due(self, now: float) -> bool:
        """Return whether `seen` would write."""
        return self.last_seen <= now - NOTED_EVERY


def open_session(
    connection: Connection, person: Person, now: float, *, kind: ActorKind, address: str, agent: str
) -> tuple[str, SignedIn]:
    """A new session and its token, which is kept nowhere. The caller records why.

    `kind` is PERSON, or DEMONSTRATION with the person DEMONSTRATOR.
    """
    owner = None if kind is ActorKind.DEMONSTRATION else person.id
    _make_room(connection, owner)
    token = new_token()
    signed_in = SignedIn(
        session=new_id(),
        person=person,
        kind=kind,
        created=now,
        expires=now + LONGEST,
        last_seen=now,
        address=short(address),
        agent=short(agent),
    )
    values = signed_in.model_dump(include={"created", "expires", "last_seen", "address", "agent"})
    row = {"id": signed_in.session, "token_hash": hash_of(token), "person": owner, **values}
    connection.execute(insert(SESSIONS).values(row))
    return token, signed_in


def find_session(connection: Connection, token: str, now: float, *, demonstration: bool = False) -> SignedIn | None:
    """The session of a token: none when it is unknown, has ended or expired, or its person is disabled.

    Sessions of demonstrations are found only where one is going on: with `demonstration`.
    """
    found = _sessions(now, SESSIONS.c.token_hash == hash_of(token))
    row = connection.execute(found).first()
    if row is None:
        return None
    signed_in = _signed_in(row)
    return signed_in if demonstration or signed_in.kind is ActorKind.PERSON else None


def find_live(connection: Connection, session: str, now: float) -> SignedIn | None:
    """The session with this id, a person's or a demonstration's, unless it has ended or expired."""
    row = connection.execute(_sessions(now, SESSIONS.c.id == session)).first()
    return None if row is None else _signed_in(row)


def find_all_live(connection: Connection, ids: Sequence[str], now: float) -> dict[str, SignedIn]:
    """Of these sessions those that have neither ended nor expired, by id."""
    rows = connection.execute(_sessions(now, SESSIONS.c.id.in_(ids)))
    return {row.id: _signed_in(row) for row in rows}


def require_live(connection: Connection, by: Actor, now: float) -> None:
    """Raises `IdentityRefused` (`signed-out`, 401) when `by` acts in a session that has ended since it was let in.

    As a session ends with the rights it had, whoever asks this in the transaction of an act cannot be too late.
    """
    if by.session is not None and find_live(connection, by.session, now) is None:
        raise IdentityRefused("signed-out", message("refused.signed-out.ended"), 401)


def seen(connection: Connection, session: str, now: float) -> None:
    """Note that a session is in use, by a request or an open stream; written at most once a minute."""
    due = (SESSIONS.c.id == session) & (SESSIONS.c.last_seen <= now - NOTED_EVERY) & live(now)
    connection.execute(update(SESSIONS).where(due).values(last_seen=now))


def end_session(connection: Connection, session: str, by: Actor, now: float) -> None:
    """Sign out. Nothing happens when the session has ended already."""
    if connection.execute(delete(SESSIONS).where(SESSIONS.c.id == session)).rowcount:
        record(connection, by, "sign-out", f"session {session}", now)


def end_session_of_token(connection: Connection, token: str) -> str | None:
    """End the session of a token, and tell its id; without an entry in the journal."""
    ended = delete(SESSIONS).where(SESSIONS.c.token_hash == hash_of(token)).returning(SESSIONS.c.id)
    return connection.execute(ended).scalar()


def end_sessions_of(connection: Connection, person_id: str, by: Actor, now: float, *, but: str | None = None) -> int:
    """End all sessions of a person but one, and tell how many there were.

    Raises `IdentityRefused` (`no-user`, 404).
    """
    person = get_user(connection, person_id)
    ended = delete(SESSIONS).where(SESSIONS.c.person == person.id)
    if but is not None:
        ended = ended.where(SESSIONS.c.id != but)
    number = connection.execute(ended).rowcount
    record(connection, by, "sessions-ended", f"person {person.name}", now, id=person.id, sessions_ended=number)
    return number


def live_sessions(connection: Connection, person_id: str, now: float) -> list[SignedIn]:
    """The sessions of a person that have not ended, the newest first."""
    found = _sessions(now, SESSIONS.c.person == person_id).order_by(SESSIONS.c.created.desc())
    return [_signed_in(row) for row in connection.execute(found)]


def live_counts(connection: Connection, now: float) -> dict[str, int]:
    """Return how many live sessions people have, by the id of the person; who has none is not among them."""
    counted = select(SESSIONS.c.person, func.count()).where(live(now), SESSIONS.c.person.is_not(None))
    return {row[0]: row[1] for row in connection.execute(counted.group_by(SESSIONS.c.person))}


def live(now: float) -> ColumnElement[bool]:
    """Rows of sessions that have not expired.

    One that has yet to begin is of another time, as when the clock was far ahead: it would never end.
    """
    begun = SESSIONS.c.created <= now + LONGEST_IDLE
    return begun & (SESSIONS.c.expires > now) & (SESSIONS.c.last_seen > now - LONGEST_IDLE)


def _make_room(connection: Connection, owner: str | None) -> None:
    """Leave room for one more session."""
    most, whose = (
        (MOST_DEMONSTRATIONS, SESSIONS.c.person.is_(None))
        if owner is None
        else (MOST_OF_A_PERSON, SESSIONS.c.person == owner)
    )
    latest = select(SESSIONS.c.id).where(whose).order_by(SESSIONS.c.last_seen.desc(), SESSIONS.c.created.desc())
    surplus = connection.execute(latest).scalars().all()[most - 1 :]
    connection.execute(delete(SESSIONS).where(SESSIONS.c.id.in_(surplus)))


def _sessions(now: float, which: ColumnElement[bool]) -> Select[tuple[object, ...]]:
    """Live sessions with their people; those of demonstrations have none."""
    enabled = PEOPLE.c.id.is_(None) | PEOPLE.c.disabled.is_(False)
    people = [PEOPLE.c[name].label(f"person_{name}") for name in Person.model_fields]
    joined = SESSIONS.outerjoin(PEOPLE, SESSIONS.c.person == PEOPLE.c.id)
    return select(SESSIONS, *people).select_from(joined).where(which, live(now), enabled)


def _signed_in(row: Row[tuple[object, ...]]) -> SignedIn:
    if row.person is None:
        person, kind = DEMONSTRATOR, ActorKind.DEMONSTRATION
    else:
        person = Person.model_validate({name: getattr(row, f"person_{name}") for name in Person.model_fields})
        kind = ActorKind.PERSON
    return SignedIn(
        session=row.id,
        person=person,
        kind=kind,
        created=row.created,
        expires=row.expires,
        last_seen=row.last_seen,
        address=row.address,
        agent=row.agent,
    )
