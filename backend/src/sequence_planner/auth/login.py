"""Sign-in with a password, password change, and removal of expired sessions, attempts, keys and watches."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

from sqlalchemy import Connection, delete

from sequence_planner.auth import rate_limit
from sequence_planner.auth.api_keys import KEPT
from sequence_planner.auth.passwords import Passwords, check_password
from sequence_planner.auth.rate_limit import AttemptKind, Counter, RefusalLog
from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.sessions import SignedIn, end_session_of_token, live, open_session, require_live
from sequence_planner.auth.tables import (
    ATTEMPTS,
    FIRST_START_LINKS,
    KEYS,
    PAIRING_OFFERS,
    PROVIDER_FLOWS,
    SESSIONS,
    WATCHES,
)
from sequence_planner.auth.tokens import UNKNOWN, record, short
from sequence_planner.auth.users import Person, find_by_name, find_password, renew_hash, replace_password
from sequence_planner.auth.watches import given_up
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry, Outcome
from sequence_planner.texts.message import message

# Clearing away what is over: sessions, attempts, links and offers at once, keys and watches after 90 days.


def clear(connection: Connection, now: float) -> None:
    """Delete rows that mean nothing any more. Called whenever somebody tries to sign in; nothing depends on when."""
    for table, over in (
        (SESSIONS, ~live(now)),
        (ATTEMPTS, ATTEMPTS.c.last < now - rate_limit.FORGOTTEN_AFTER),
        (FIRST_START_LINKS, FIRST_START_LINKS.c.expires <= now),
        (PROVIDER_FLOWS, PROVIDER_FLOWS.c.expires <= now),
        (PAIRING_OFFERS, PAIRING_OFFERS.c.expires <= now),
        (KEYS, (KEYS.c.expires <= now - KEPT) | (KEYS.c.revoked <= now - KEPT)),
        (WATCHES, given_up(now) | (WATCHES.c.expires <= now - KEPT) | (WATCHES.c.revoked <= now - KEPT)),
    ):
        connection.execute(delete(table).where(over))


# Signing in, and changing one's own password.

SIGN_IN, PASSWORD_CHANGED = "sign-in", "password-changed"


@dataclass(frozen=True)
class _Attempt:
    """Somebody tries the password of a name; `actor` is who is signed in already."""

    actor: Actor | None
    action: str
    name: str
    address: str
    now: float

    @property
    def counters(self) -> tuple[Counter, ...]:
        return (rate_limit.of_address(AttemptKind.ADDRESS, self.address), rate_limit.of_name(self.name))

    def refused(self, because: str, tried: Person | None) -> Entry:
        """Return what to record where the name is that of `tried`.

        A name that nobody has may be a password that was typed in the wrong place: nothing of it is told.
        """
        name = UNKNOWN if tried is None else tried.name
        stranger = Actor(kind=ActorKind.PERSON, id="unknown", name=name, address=short(self.address))
        actor = self.actor or stranger
        return Entry(actor=actor, action=self.action, outcome=Outcome.REFUSED, details={"because": because})


@dataclass(frozen=True)
class _Known:
    """The person whose password is tried."""

    person: Person
    password_hash: str


class SignIn:
    """Lets people in who know their password, and nobody else.

    It takes the same steps, and one hash, whether a name is known or not, and whether its person is disabled or not;
    and says the same. An attempt is counted before the hash, so that many at once are not let through.
    """

    def __init__(self, database: Database, passwords: Passwords) -> None:
        self._database = database
        self._passwords = passwords
        self._limited = RefusalLog()

    async def sign_in(
        self, name: str, password: str, *, now: float, address: str, agent: str, before: str | None
    ) -> tuple[str, SignedIn]:
        """A new session and its token; the session that the browser had, of which `before` is the token, ends.

        Raises `IdentityRefused`: `wrong-name-or-password` (401), `too-many-attempts` (429), `busy` (503).
        """
        attempt = _Attempt(None, SIGN_IN, name, address, now)
        with self._passwords.place():
            known = await asyncio.to_thread(self._admit, attempt)
            right = await self._passwords.verify_in_place(known.password_hash if known else None, password)
            welcome = known is not None and right and not known.person.disabled
            newer = await self._newer_hash(known, password) if known and welcome else None
        if known and welcome:
            entered = await asyncio.to_thread(self._enter, attempt, known, newer, agent, before)
        else:
            entered = None
            await asyncio.to_thread(self._record, attempt, known)
        if entered is None:
            raise IdentityRefused("wrong-name-or-password", message("refused.wrong-name-or-password.again"), 401)
        return entered

    async def change_password(
        self, signed_in: SignedIn, old: str, new: str, *, now: float, address: str, agent: str
    ) -> tuple[str, SignedIn]:
        """A new password for the person of a session; all sessions of the person end, and a new one is opened.

        Raises `IdentityRefused`: `weak-password` (422), `wrong-password` (403) for the old one, which counts as an
        attempt, `no-password` (403) where there is none, `signed-out` (401) when the session has ended meanwhile,
        `too-many-attempts` (429), `busy` (503).
        """
        person = signed_in.person
        if signed_in.kind is not ActorKind.PERSON:
            raise IdentityRefused("no-password", message("refused.no-password.demonstration"), 403)
        check_password(new, person.name)
        if new == old:
            raise IdentityRefused("weak-password", message("refused.weak-password.same"), 422)
        attempt = _Attempt(signed_in.actor(address), PASSWORD_CHANGED, person.name, address, now)
        with self._passwords.place():
            known = await asyncio.to_thread(self._admit, attempt)
            right = await self._passwords.verify_in_place(known.password_hash if known else None, old)
            hashed = await self._passwords.hash_in_place(new) if right else None
        if known is not None and not known.password_hash:
            raise IdentityRefused("no-password", message("refused.no-password.provider"), 403)
        if known is None or hashed is None:
            await asyncio.to_thread(self._record, attempt, known)
            raise IdentityRefused("wrong-password", message("refused.wrong-password.old"), 403)
        return await asyncio.to_thread(self._replace, attempt, known, hashed, signed_in, agent)

    async def _newer_hash(self, known: _Known, password: str) -> str | None:
        outdated = self._passwords.outdated(known.password_hash)
        return await self._passwords.hash_in_place(password) if outdated else None

    def _admit(self, attempt: _Attempt) -> _Known | None:
        """Count an attempt, unless too many were made already; and find whose password is tried."""
        with self._database.reading() as connection:
            waiting = rate_limit.waiting(connection, attempt.counters, attempt.now)
            tried = find_by_name(connection, attempt.name)
        if waiting is None:
            with self._database.writing() as connection:
                self._record_limited(connection, attempt.now)
                waiting = rate_limit.waiting(connection, attempt.counters, attempt.now)
                if waiting is None:
                    clear(connection, attempt.now)
                    rate_limit.count(connection, attempt.counters, attempt.now)
                    found = find_password(connection, attempt.name)
                    return None if found is None else _Known(*found)
        self._limited.add_refusal(waiting.counter, attempt.refused("too-many-attempts", tried), attempt.now)
        if self._limited.due(attempt.now):
            with self._database.writing() as connection:
                self._record_limited(connection, attempt.now)
        raise waiting.refusal()

    def _record_limited(self, connection: Connection, now: float) -> None:
        for entry in self._limited.collect_due(now):
            append(connection, entry, now)

    def _record(self, attempt: _Attempt, known: _Known | None) -> None:
        """Write that the password was wrong."""
        tried = None if known is None else known.person
        with self._database.writing() as connection:
            append(connection, attempt.refused("wrong-name-or-password", tried), attempt.now)

    def _enter(
        self, attempt: _Attempt, known: _Known, newer: str | None, agent: str, before: str | None
    ) -> tuple[str, SignedIn] | None:
        """Open the session of somebody who knew the password; none if that has ceased to be true meanwhile."""
        with self._database.writing() as connection:
            found = find_password(connection, attempt.name)
            if found is None or found[1] != known.password_hash or found[0].disabled:
                append(connection, attempt.refused("wrong-name-or-password", known.person), attempt.now)
                return None
            person = found[0]
            rate_limit.forgive(connection, attempt.counters)
            if newer is not None:
                renew_hash(connection, person, newer)
            ended = end_session_of_token(connection, before) if before else None
            token, signed_in = open_session(
                connection, person, attempt.now, kind=ActorKind.PERSON, address=attempt.address, agent=agent
            )
            actor, subject = signed_in.actor(attempt.address), f"session {signed_in.session}"
            details = {"role": person.role.value, "agent": signed_in.agent, "session_ended": ended}
            record(connection, actor, SIGN_IN, subject, attempt.now, **details)
            return token, signed_in

    def _replace(
        self, attempt: _Attempt, known: _Known, hashed: str, signed_in: SignedIn, agent: str
    ) -> tuple[str, SignedIn]:
        with self._database.writing() as connection:
            require_live(connection, signed_in.actor(attempt.address), attempt.now)
            rate_limit.forgive(connection, attempt.counters)
            person = replace_password(connection, known.person, hashed, temporary=False)
            token, opened = open_session(
                connection, person, attempt.now, kind=ActorKind.PERSON, address=attempt.address, agent=agent
            )
            record(connection, opened.actor(attempt.address), PASSWORD_CHANGED, f"person {person.name}", attempt.now)
            return token, opened
