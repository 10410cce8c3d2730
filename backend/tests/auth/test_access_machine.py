"""A credential is good exactly when a plain model says so, whatever people have done in whatever order.

The model is of this page alone: a dictionary for each kind of credential, and the times when each ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)
from sqlalchemy import Connection, delete

from auth.situations import ADA, AGENT, BOTH, HERE, NOW
from sequence_planner.auth import api_keys, sessions, users, watches
from sequence_planner.auth import watches as pairing
from sequence_planner.auth.login import clear
from sequence_planner.auth.roles import IdentityRefused, Role, Scope
from sequence_planner.auth.tables import KEYS, PAIRING_OFFERS, PEOPLE, SESSIONS, WATCHES
from sequence_planner.auth.users import Person
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.journal import audit
from support.examples import examples

MINUTE, HOUR, DAY = 60.0, 3600.0, 86400.0
PAUSES = (1.0, 1.0, MINUTE, MINUTE, 2 * MINUTE, 59 * MINUTE, HOUR, 11 * HOUR, DAY, 89 * DAY)
WHICH = st.integers(0, 7)
Revoking = Callable[[Connection, str, Actor, float], None]


@dataclass
class Credential:
    """When it ends; of a session also whose it is, and when it was seen last; of a watch whether it was let in."""

    ends: float
    id: str
    owner: str = ""
    seen: float = NOW
    confirmed: bool = False


class Access(RuleBasedStateMachine):
    """Two administrators, one operator, and all that may happen to them."""

    def __init__(self, database: Database) -> None:
        super().__init__()
        self.database, self.now = database, NOW
        self.sessions, self.keys, self.watches = (
            dict[str, Credential](),
            dict[str, Credential](),
            dict[str, Credential](),
        )
        self.codes = dict[str, float]()
        self.people = dict[str, Person]()

    @initialize()
    def begin(self) -> None:
        with self.database.writing() as connection:
            for table in (SESSIONS, PEOPLE, KEYS, WATCHES, PAIRING_OFFERS):
                connection.execute(delete(table))
            for name, role in (("Ada", Role.ADMINISTRATOR), ("Eva", Role.ADMINISTRATOR), ("Adam", Role.OPERATOR)):
                person = users.create(connection, name, role, "hash", ADA, NOW, temporary=False)
                self.people[person.id] = person

    @rule(pause=st.sampled_from(PAUSES))
    def time_passes(self, pause: float) -> None:
        self.now += pause

    @rule(which=WHICH)
    def somebody_signs_in(self, which: int) -> None:
        person = self._person(which)
        if not person.disabled:
            with self.database.writing() as connection:
                token, opened = sessions.open_session(
                    connection, person, self.now, kind=ActorKind.PERSON, address=HERE, agent=AGENT
                )
            self.sessions[token] = Credential(self.now + 12 * HOUR, opened.session, person.id, self.now)

    @precondition(lambda self: self.sessions)
    @rule(which=WHICH, out=st.booleans())
    def somebody_is_seen_or_signs_out(self, which: int, out: bool) -> None:
        token = list(self.sessions)[which % len(self.sessions)]
        session = self.sessions[token]
        with self.database.writing() as connection:
            if out:
                sessions.end_session(connection, session.id, ADA, self.now)
                session.ends = self.now
            else:
                sessions.seen(connection, session.id, self.now)
                if self._session_is_good(session) and session.seen <= self.now - MINUTE:
                    session.seen = self.now

    @rule(which=WHICH, role=st.sampled_from([None, *Role]), disabled=st.sampled_from([None, False, True]))
    def a_person_is_changed(self, which: int, role: Role | None, disabled: bool | None) -> None:
        person = self._person(which)
        wanted = (person.role if role is None else role, person.disabled if disabled is None else disabled)
        others = [each for each in self.people.values() if each != person]
        somebody = any(each.role is Role.ADMINISTRATOR and not each.disabled for each in others)
        stays = somebody or wanted == (Role.ADMINISTRATOR, False)
        try:
            with self.database.writing() as connection:
                changed = users.change(
                    connection, person.id, person.revision, ADA, self.now, role=role, disabled=disabled
                )
        except IdentityRefused as refused:
            assert refused.slug == "last-administrator"
            assert not stays
            return
        assert stays
        assert (changed.role, changed.disabled) == wanted
        self.people[person.id] = changed
        if changed != person:
            self._end_sessions_of(person)

    @rule(which=WHICH)
    def a_password_is_reset(self, which: int) -> None:
        person = self._person(which)
        with self.database.writing() as connection:
            users.set_password(connection, person.id, "another hash", ADA, self.now, temporary=True)
            found = users.find(connection, person.id)
        assert found is not None
        self.people[person.id] = found
        self._end_sessions_of(person)

    @rule(days=st.sampled_from([1, 30, 730]))
    def a_key_is_made(self, days: int) -> None:
        with self.database.writing() as connection:
            secret, key = api_keys.make_key(connection, "MES", frozenset({Scope.READ}), days, ADA, self.now)
        self.keys[secret] = Credential(self.now + days * DAY, key.id)

    @precondition(lambda self: self.keys)
    @rule(which=WHICH, overlap=st.sampled_from([0, 1, 720]), days=st.sampled_from([None, 1, 730]))
    def a_key_gets_another_secret(self, which: int, overlap: int, days: int | None) -> None:
        id = list(self.keys.values())[which % len(self.keys)].id
        secrets = [secret for secret in self.keys.values() if secret.id == id]  # the last is that of today
        try:
            with self.database.writing() as connection:
                secret, key = api_keys.rotate_key(connection, id, overlap, days, ADA, self.now)
        except IdentityRefused as refused:
            assert refused.slug in ("key-expired", "no-key")
            assert secrets[-1].ends <= self.now
            return
        assert secrets[-1].ends > self.now
        self.keys[secret] = Credential(secrets[-1].ends if days is None else self.now + days * DAY, id)
        assert key.expires == self.keys[secret].ends
        for before in secrets[:-1]:
            before.ends = min(before.ends, self.now)
        secrets[-1].ends = min(secrets[-1].ends, self.now + overlap * HOUR, key.expires)

    @precondition(lambda self: self.keys)
    @rule(which=WHICH)
    def a_key_is_revoked(self, which: int) -> None:
        id = list(self.keys.values())[which % len(self.keys)].id
        secrets = [secret for secret in self.keys.values() if secret.id == id]
        self._revoke(secrets[-1], api_keys.revoke_key, "no-key")
        for secret in secrets:
            secret.ends = min(secret.ends, self.now)

    @rule(which=WHICH)
    def a_place_for_a_watch_is_offered(self, which: int) -> None:
        try:
            with self.database.writing() as connection:
                code, made = pairing.offer(connection, f"Watch {which}", "operator", ADA, self.now)
        except IdentityRefused as refused:
            assert refused.slug in ("wearable-exists", "too-many-offers")
            return
        assert made.expires == self.now + 2 * MINUTE
        self.codes[code] = made.expires

    @precondition(lambda self: self.codes)
    @rule(which=WHICH)
    def a_code_is_typed(self, which: int) -> None:
        code = list(self.codes)[which % len(self.codes)]
        try:
            # Each from an address of its own: how many wrong ones are let through is told elsewhere.
            token, watch = pairing.redeem(self.database, code, self.now, address=f"address {self.now}", agent=AGENT)
        except IdentityRefused as refused:
            assert refused.slug == "too-many-attempts" or self.codes[code] <= self.now
            return
        assert self.codes[code] > self.now
        self.codes[code] = self.now
        self.watches[token] = Credential(self.now + 2 * MINUTE, watch.id)

    @precondition(lambda self: self.watches)
    @rule(which=WHICH, revoked=st.booleans())
    def a_watch_is_let_in_or_revoked(self, which: int, revoked: bool) -> None:
        watch = list(self.watches.values())[which % len(self.watches)]
        if revoked:
            self._revoke(watch, watches.revoke, "no-wearable")
            return
        good = watch.ends > self.now and not watch.confirmed
        try:
            with self.database.writing() as connection:
                watches.confirm(connection, watch.id, ADA, self.now)
        except IdentityRefused:
            assert not good
            return
        assert good
        watch.ends, watch.confirmed = self.now + 90 * DAY, True

    @rule()
    def what_is_over_is_cleared_away(self) -> None:
        with self.database.writing() as connection:
            clear(connection, self.now)

    @invariant()
    def credentials_are_good_when_they_should_be(self) -> None:
        with self.database.reading() as connection:
            for token, session in self.sessions.items():
                found = sessions.find_session(connection, token, self.now)
                assert (found is not None) is self._session_is_good(session)
                assert found is None or found.person == self.people[session.owner]
            for secret, key in self.keys.items():
                assert (api_keys.find_key(connection, secret, self.now) is not None) is (key.ends > self.now)
            for token, watch in self.watches.items():
                seen = watches.find_watch(connection, token, self.now)
                assert (seen is not None) is (watch.ends > self.now)
                assert seen is None or (seen.state is watches.WatchState.ACTIVE) is watch.confirmed

    def teardown(self) -> None:
        """Nothing was forgotten on the way."""
        with self.database.reading() as connection:
            assert audit.broken_at(connection) is None

    def _person(self, which: int) -> Person:
        return list(self.people.values())[which % len(self.people)]

    def _session_is_good(self, session: Credential) -> bool:
        return self.now < session.ends and self.now < session.seen + HOUR

    def _end_sessions_of(self, person: Person) -> None:
        for session in self.sessions.values():
            if session.owner == person.id:
                session.ends = min(session.ends, self.now)

    def _revoke(self, credential: Credential, revoke: Revoking, gone: str) -> None:
        try:
            with self.database.writing() as connection:
                revoke(connection, credential.id, ADA, self.now)
        except IdentityRefused as refused:
            assert refused.slug == gone
            assert credential.ends <= self.now
        credential.ends = min(credential.ends, self.now)


@BOTH
def test_a_credential_is_good_exactly_when_it_should_be(database: Database) -> None:
    class Here(Access):
        """On the database of this test."""

        def __init__(self) -> None:
            super().__init__(database)

    run_state_machine_as_test(Here, settings=settings(examples(20), stateful_step_count=40))
