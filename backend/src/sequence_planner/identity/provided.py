"""People for whom a provider vouches: who they are is its issuer and subject, never a name.

They are made when they first sign in, and have no password here. Their role is the provider's word, taken anew at each
sign-in; whether they are disabled is the station's. A sign-in under way is a row until its answer comes.
"""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from dataclasses import dataclass

from pydantic import JsonValue
from sqlalchemy import Connection, delete, insert, select, update

from sequence_planner.actor import Actor, ActorKind
from sequence_planner.identity.names import LONGEST_NAME, short
from sequence_planner.identity.openid.flow import FLOW_LIFE
from sequence_planner.identity.people import Person, add, find, replace_password
from sequence_planner.identity.recording import record
from sequence_planner.identity.refusal import IdentityRefused
from sequence_planner.identity.roles import Role
from sequence_planner.identity.tables import PEOPLE, PROVIDER_FLOWS, SESSIONS
from sequence_planner.identity.tokens import hash_of

NO_PASSWORD = ""  # a hash that no password has
_MOST_ALIKE = 20  # numbers that are tried behind a name which somebody has already


@dataclass(frozen=True)
class Provided:
    """Somebody as a provider says: `names` are what may be the person's name here, the best first."""

    issuer: str
    subject: str
    names: tuple[str, ...]
    role: Role


def open_flow(connection: Connection, token: str, to: str, now: float) -> None:
    """Note that a sign-in was begun, and the page on this server to which it leads."""
    values = {"token_hash": hash_of(token), "page": to, "expires": now + FLOW_LIFE}
    connection.execute(insert(PROVIDER_FLOWS).values(values))


def take_flow(connection: Connection, token: str, now: float) -> str | None:
    """End a sign-in that was begun, and tell to which page it leads; None where there is none, or no longer."""
    here = PROVIDER_FLOWS.c.token_hash == hash_of(token)
    taken = delete(PROVIDER_FLOWS).where(here).returning(PROVIDER_FLOWS.c.page, PROVIDER_FLOWS.c.expires)
    row = connection.execute(taken).first()
    return row.page if row is not None and now < row.expires <= now + FLOW_LIFE else None


def find_provided(connection: Connection, issuer: str, subject: str) -> Person | None:
    """The person whom a provider calls so."""
    known = select(PEOPLE.c.id).where(PEOPLE.c.issuer == issuer, PEOPLE.c.subject == subject)
    id = connection.execute(known).scalar()
    return None if id is None else find(connection, id)


def be_person(connection: Connection, provided: Provided, now: float, *, address: str) -> Person:
    """The person that this is here, made if there is none yet, with the role of today.

    Whose role has changed is signed out everywhere. A password that was set for the time in which the provider was away
    ends. The caller has seen that the person is not disabled.
    """
    person = find_provided(connection, provided.issuer, provided.subject)
    if person is None:
        return _made(connection, provided, now, address)
    if connection.execute(select(PEOPLE.c.password_hash).where(PEOPLE.c.id == person.id)).scalar() != NO_PASSWORD:
        person = replace_password(connection, person, NO_PASSWORD, temporary=False)
    if person.role is provided.role:
        return person
    changed = person.model_copy(update={"role": provided.role, "revision": person.revision + 1})
    values = {"role": changed.role.value, "revision": changed.revision}
    connection.execute(update(PEOPLE).where(PEOPLE.c.id == person.id).values(values))
    ended = connection.execute(delete(SESSIONS).where(SESSIONS.c.person == person.id)).rowcount
    told: dict[str, JsonValue] = {"role": [person.role.value, changed.role.value], "issuer": provided.issuer}
    told |= {"id": person.id, "sessions_ended": ended}
    record(connection, actor_of(person, address), "person-changed", f"person {person.name}", now, **told)
    return changed


def actor_of(person: Person, address: str) -> Actor:
    """Somebody who is about to sign in."""
    return Actor(kind=ActorKind.PERSON, id=person.id, name=person.name, address=short(address))


def _made(connection: Connection, provided: Provided, now: float, address: str) -> Person:
    person = _named(connection, provided, now)
    values = {"issuer": provided.issuer, "subject": provided.subject}
    connection.execute(update(PEOPLE).where(PEOPLE.c.id == person.id).values(values))
    told = {"id": person.id, "role": person.role.value, "issuer": provided.issuer, "known_as": provided.subject}
    record(connection, actor_of(person, address), "person-created", f"person {person.name}", now, **told)
    return person.model_copy(update={"issuer": provided.issuer})


def _named(connection: Connection, provided: Provided, now: float) -> Person:
    """A person with the first of the names that can be had: nobody gets a name that looks like somebody else's."""
    for name in _names(provided):
        try:
            return add(connection, name, provided.role, NO_PASSWORD, now, temporary=False)
        except IdentityRefused:
            continue
    raise AssertionError("a name that was drawn is taken")


def _names(provided: Provided) -> Iterator[str]:
    wanted = tuple(name.strip()[: LONGEST_NAME - 4] for name in provided.names)
    yield from wanted
    for name in wanted[:1]:
        yield from (f"{name} {number}" for number in range(2, _MOST_ALIKE))
    while True:
        yield f"Person {secrets.token_hex(4)}"
