"""Sign-in through an OpenID Connect provider: the browser's login flow, and accounts by issuer and subject."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Iterator
from dataclasses import dataclass

from pydantic import JsonValue
from sqlalchemy import Connection, delete, insert, select, update

from sequence_planner.auth import rate_limit
from sequence_planner.auth.login import SIGN_IN, clear
from sequence_planner.auth.oidc.flow import FLOW_LIFE, ProviderAnswer, SignInFlow
from sequence_planner.auth.oidc.provider import Provider, disabled, names_in, no_role, not_begun
from sequence_planner.auth.rate_limit import AttemptKind, Counter, RefusalLog
from sequence_planner.auth.roles import IdentityRefused, Role
from sequence_planner.auth.sessions import SignedIn, end_session_of_token, end_sessions_of, open_session
from sequence_planner.auth.tables import PEOPLE, PROVIDER_FLOWS, SESSIONS
from sequence_planner.auth.tokens import LONGEST_NAME, UNKNOWN, hash_of, record, short
from sequence_planner.auth.users import Person, add, find, replace_password
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry, Outcome

# People for whom a provider vouches: who they are is its issuer and subject, never a name.
#
# They are made when they first sign in, and have no password here. Their role is the provider's word, taken anew at
# each sign-in; whether they are disabled is the station's. A sign-in under way is a row until its answer comes.

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


# Signing in with a provider: begun in a browser, and finished in the same one with what the provider says.


@dataclass(frozen=True)
class _KeptOut:
    """Somebody whom the provider knows, and the station does not let in."""

    actor: Actor
    counter: Counter
    refused: IdentityRefused


ANYBODY = Counter(AttemptKind.PROVIDER, hash_of("everybody"))
"""Refusals of which it is not known whom they concern: however many there are, one record a minute tells of them."""


class ProviderSignIn:
    """Lets people in for whom the provider vouches, and whom the station has a role for."""

    def __init__(self, database: Database, provider: Provider) -> None:
        self.provider = provider
        self._database = database
        self._limited = RefusalLog()

    async def begin(self, to: str, back: str, *, now: float, address: str) -> tuple[str, str]:
        """Begin: the token that the browser keeps, and where it goes. `to` is the page that it comes to in the end.

        Raises `IdentityRefused`: `provider-unavailable` (503), `too-many-attempts` (429).
        """
        flow = SignInFlow.begin()
        counters = (rate_limit.of_address(AttemptKind.PROVIDER, address),)

        def count() -> None:
            with self._database.writing() as connection:
                waiting = rate_limit.waiting(connection, counters, now)
                if waiting is not None:
                    raise waiting.refusal()
                clear(connection, now)
                rate_limit.count(connection, counters, now)
                open_flow(connection, flow.token, to, now)

        await asyncio.to_thread(count)
        return flow.token, await self.provider.address(flow, back)

    async def finish(
        self,
        token: str | None,
        answer: ProviderAnswer,
        back: str,
        *,
        now: float,
        address: str,
        agent: str,
        before: str | None,
    ) -> tuple[str, SignedIn, str]:
        """Finish: a new session and its token, and the page to go to; the session of the token `before` ends.

        `token` is what the browser has kept; it works once. Raises `IdentityRefused`: `sign-in-not-begun`,
        `provider-answer-invalid`, `provider-refused`, `no-role`, `disabled` (403), `provider-unavailable` (503).
        """
        try:
            flow, to = await asyncio.to_thread(self._take, token, answer.state, now)
            claims = await self.provider.claims(answer, flow, back, now)
        except IdentityRefused as refused:
            await asyncio.to_thread(self._refuse, ANYBODY, _stranger(address), refused, now)
            raise
        entered = await asyncio.to_thread(self._enter, claims, now, address, agent, before)
        if isinstance(entered, _KeptOut):
            await asyncio.to_thread(self._refuse, entered.counter, entered.actor, entered.refused, now)
            raise entered.refused
        return *entered, to

    def _take(self, token: str | None, state: str, now: float) -> tuple[SignInFlow, str]:
        """The sign-in that this browser has begun. One that an answer does not belong to goes on."""
        flow = None if token is None else SignInFlow(token)
        if flow is None or not flow.is_state(state):
            raise not_begun()
        with self._database.writing() as connection:
            to = take_flow(connection, flow.token, now)
        if to is None:
            raise not_begun()
        return flow, to

    def _enter(
        self, claims: dict[str, object], now: float, address: str, agent: str, before: str | None
    ) -> tuple[str, SignedIn] | _KeptOut:
        issuer, subject, role = self.provider.settings.issuer, str(claims["sub"]), self.provider.settings.role(claims)
        with self._database.writing() as connection:
            person = find_provided(connection, issuer, subject)
            if role is not None and not (person and person.disabled):
                provided = Provided(issuer, subject, names_in(claims), role)
                return self._open(connection, provided, now, address, agent, before)
            if person is not None:  # whoever has lost the role keeps no session that has it
                end_sessions_of(connection, person.id, actor_of(person, address), now)
        actor = _stranger(address) if person is None else actor_of(person, address)
        counter = Counter(AttemptKind.PROVIDER, hash_of(f"{issuer} {subject}"))
        return _KeptOut(actor, counter, no_role() if role is None else disabled())

    def _open(
        self, connection: Connection, provided: Provided, now: float, address: str, agent: str, before: str | None
    ) -> tuple[str, SignedIn]:
        person = be_person(connection, provided, now, address=address)
        ended = end_session_of_token(connection, before) if before else None
        token, signed_in = open_session(connection, person, now, kind=ActorKind.PERSON, address=address, agent=agent)
        details = {"role": person.role.value, "agent": signed_in.agent, "session_ended": ended}
        subject = f"session {signed_in.session}"
        record(connection, signed_in.actor(address), SIGN_IN, subject, now, **details, issuer=provided.issuer)
        return token, signed_in

    def _refuse(self, counter: Counter, actor: Actor, refused: IdentityRefused, now: float) -> None:
        """Record a refusal, the first of its kind at once and further ones together."""
        details: dict[str, JsonValue] = {"because": refused.slug, "issuer": self.provider.settings.issuer}
        self._limited.add_refusal(
            counter, Entry(actor=actor, action=SIGN_IN, outcome=Outcome.REFUSED, details=details), now
        )
        if self._limited.due(now):
            with self._database.writing() as connection:
                for entry in self._limited.collect_due(now):
                    append(connection, entry, now)


def _stranger(address: str) -> Actor:
    return Actor(kind=ActorKind.PERSON, id="unknown", name=UNKNOWN, address=short(address))
