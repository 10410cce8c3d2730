"""Signing in with a provider: begun in a browser, and finished in the same one with what the provider says."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

from pydantic import JsonValue
from sqlalchemy import Connection

from sequence_planner.actor import Actor, ActorKind
from sequence_planner.identity import attempts
from sequence_planner.identity.attempts import Counter, Kind
from sequence_planner.identity.clearing import clear
from sequence_planner.identity.limited import Limited
from sequence_planner.identity.names import UNKNOWN, short
from sequence_planner.identity.openid.flow import Answer, Flow
from sequence_planner.identity.openid.provider import Provider, names_in
from sequence_planner.identity.openid.refusals import disabled, no_role, not_begun
from sequence_planner.identity.provided import Provided, actor_of, be_person, find_provided, open_flow, take_flow
from sequence_planner.identity.recording import record
from sequence_planner.identity.refusal import IdentityRefused
from sequence_planner.identity.sessions import SignedIn, end_session_of_token, end_sessions_of, open_session
from sequence_planner.identity.sign_in import SIGN_IN
from sequence_planner.identity.tokens import hash_of
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry, Outcome
from sequence_planner.storage.database import Database


@dataclass(frozen=True)
class _KeptOut:
    """Somebody whom the provider knows, and the station does not let in."""

    actor: Actor
    counter: Counter
    refused: IdentityRefused


ANYBODY = Counter(Kind.PROVIDER, hash_of("everybody"))
"""Refusals of which it is not known whom they concern: however many there are, one record a minute tells of them."""


class ProviderSignIn:
    """Lets people in for whom the provider vouches, and whom the station has a role for."""

    def __init__(self, database: Database, provider: Provider) -> None:
        self.provider = provider
        self._database = database
        self._limited = Limited()

    async def begin(self, to: str, back: str, *, now: float, address: str) -> tuple[str, str]:
        """Begin: the token that the browser keeps, and where it goes. `to` is the page that it comes to in the end.

        Raises `IdentityRefused`: `provider-unavailable` (503), `too-many-attempts` (429).
        """
        flow = Flow.begin()
        counters = (attempts.of_address(Kind.PROVIDER, address),)

        def count() -> None:
            with self._database.writing() as connection:
                waiting = attempts.waiting(connection, counters, now)
                if waiting is not None:
                    raise waiting.refusal()
                clear(connection, now)
                attempts.count(connection, counters, now)
                open_flow(connection, flow.token, to, now)

        await asyncio.to_thread(count)
        return flow.token, await self.provider.address(flow, back)

    async def finish(
        self,
        token: str | None,
        answer: Answer,
        back: str,
        *,
        now: float,
        address: str,
        agent: str,
        before: str | None,
    ) -> tuple[str, SignedIn, str]:
        """Finish: a new session and its token, and the page to go to; the session of the token `before` ends.

        `token` is what the browser has kept; it works once. Raises `IdentityRefused`: `sign-in-not-begun`,
        `provider-answer-unfit`, `provider-refused`, `no-role`, `disabled` (403), `provider-unavailable` (503).
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

    def _take(self, token: str | None, state: str, now: float) -> tuple[Flow, str]:
        """The sign-in that this browser has begun. One that an answer does not belong to goes on."""
        flow = None if token is None else Flow(token)
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
        counter = Counter(Kind.PROVIDER, hash_of(f"{issuer} {subject}"))
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
        self._limited.note(counter, Entry(actor=actor, action=SIGN_IN, outcome=Outcome.REFUSED, details=details), now)
        if self._limited.due(now):
            with self._database.writing() as connection:
                for entry in self._limited.take(now):
                    append(connection, entry, now)


def _stranger(address: str) -> Actor:
    return Actor(kind=ActorKind.PERSON, id="unknown", name=UNKNOWN, address=short(address))
