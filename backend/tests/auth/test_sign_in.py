"""Signing in and changing one's password, with real hashes of little cost."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from argon2 import PasswordHasher

from auth.situations import ADA, AGENT, BOTH, HERE, NOW, PASSWORD, add, entries, everything_kept, is_good
from sequence_planner.auth import sessions, users
from sequence_planner.auth.login import SignIn
from sequence_planner.auth.passwords import Passwords
from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.sessions import SignedIn
from sequence_planner.auth.users import DEMONSTRATOR
from sequence_planner.core.actor import ActorKind
from sequence_planner.db.database import Database
from sequence_planner.journal.entry import Outcome
from support.people import CHEAP

ANOTHER = "another fine password"


@dataclass(frozen=True)
class Door:
    """Where people sign in."""

    database: Database
    passwords: Passwords
    sign_in: SignIn

    async def enter(
        self, name: str, password: str = PASSWORD, *, now: float = NOW, address: str = HERE, before: str | None = None
    ) -> tuple[str, SignedIn] | IdentityRefused:
        try:
            return await self.sign_in.sign_in(name, password, now=now, address=address, agent=AGENT, before=before)
        except IdentityRefused as refused:
            return refused

    def entered(self, name: str, password: str = PASSWORD, **others: object) -> tuple[str, SignedIn]:
        answer = asyncio.run(self.enter(name, password, **others))  # type: ignore[arg-type]
        assert not isinstance(answer, IdentityRefused), answer
        return answer

    def refused(self, name: str, password: str = PASSWORD, *, now: float = NOW, address: str = HERE) -> IdentityRefused:
        answer = asyncio.run(self.enter(name, password, now=now, address=address))
        assert isinstance(answer, IdentityRefused)
        return answer

    def change(self, who: SignedIn, old: str, new: str) -> tuple[str, SignedIn] | IdentityRefused:
        try:
            return asyncio.run(self.sign_in.change_password(who, old, new, now=NOW, address=HERE, agent=AGENT))
        except IdentityRefused as refused:
            return refused


@pytest.fixture
def door(database: Database) -> Iterator[Door]:
    passwords = Passwords(CHEAP, most_waiting=100)
    yield Door(database, passwords, SignIn(database, passwords))
    passwords.close()


@BOTH
def test_who_knows_the_password_is_in(door: Door) -> None:
    eva = add(door.database, "Eva")
    token, opened = door.entered(" EVA ", address="10.0.0.7")
    assert (opened.person, opened.kind, opened.address) == (eva, ActorKind.PERSON, "10.0.0.7")
    assert is_good(door.database, token)
    (entry,) = entries(door.database, "sign-in")
    assert (entry.actor, entry.outcome) == (opened.actor("10.0.0.7"), Outcome.DONE)


def test_each_sign_in_has_a_token_of_its_own_and_ends_the_session_before(door: Door) -> None:
    add(door.database, "Eva")
    add(door.database, "Adam")
    elsewhere, _ = door.entered("Eva")
    planted, _ = door.entered("Adam")
    token, _ = door.entered("Eva", before=planted)
    assert len({elsewhere, planted, token}) == 3
    assert [is_good(door.database, each) for each in (elsewhere, planted, token)] == [True, False, True]
    made_up, _ = door.entered("Eva", before="made up by somebody")
    assert made_up != "made up by somebody"
    assert not is_good(door.database, "made up by somebody")


def test_a_wrong_password_ends_nothing(door: Door) -> None:
    add(door.database, "Eva")
    token, _ = door.entered("Eva")
    answer = asyncio.run(door.enter("Eva", "wrong horse battery", before=token))
    assert isinstance(answer, IdentityRefused)
    assert is_good(door.database, token)


@BOTH
def test_nobody_is_told_who_there_is(door: Door) -> None:
    eva = add(door.database, "Eva")
    add(door.database, "Adam")
    with door.database.writing() as connection:
        users.change(connection, eva.id, eva.revision, ADA, NOW, disabled=True)
    tries = [("Eva", PASSWORD), ("Adam", "wrong horse battery"), ("Nobody", PASSWORD), ("", ""), ("\0\ud800", "\ud800")]
    told = [door.refused(name, password) for name, password in tries]
    assert {(each.slug, each.title, each.detail, each.status, each.retry_after) for each in told} == {
        (
            "wrong-name-or-password",
            "Not signed in",
            "The name or the password is wrong. Try again, or ask an administrator for another password.",
            401,
            None,
        )
    }
    recorded = entries(door.database, "sign-in")
    assert [entry.actor.name for entry in recorded] == ["unknown", "unknown", "unknown", "Adam", "Eva"]
    assert {(entry.actor.id, entry.outcome) for entry in recorded} == {("unknown", Outcome.REFUSED)}
    assert {repr(entry.details) for entry in recorded} == {"{'because': 'wrong-name-or-password'}"}


def test_what_was_typed_in_place_of_a_name_is_kept_nowhere(door: Door) -> None:
    add(door.database, "Eva")
    for _ in range(7):  # also where it has to wait
        door.refused(PASSWORD, "")
    for _ in range(7):
        door.refused(" EVA", "wrong horse battery", address="10.0.0.7")
    recorded = [(entry.actor.name, entry.details["because"]) for entry in entries(door.database, "sign-in")]
    for name in ("unknown", "Eva"):
        assert {because for each, because in recorded if each == name} == {
            "wrong-name-or-password",
            "too-many-attempts",
        }
    assert {name for name, _ in recorded} == {"unknown", "Eva"}
    assert PASSWORD not in everything_kept(door.database)


@pytest.mark.parametrize("name", ["Adam", "Nobody"])
def test_names_are_locked_alike(door: Door, name: str) -> None:
    add(door.database, "Adam")
    slugs = [door.refused(name, "wrong horse battery", address=f"10.0.0.{each}").slug for each in range(6)]
    assert slugs == ["wrong-name-or-password"] * 5 + ["too-many-attempts"]
    locked = door.refused(name, PASSWORD, address="10.0.1.1")
    assert (locked.slug, locked.status, locked.retry_after) == ("too-many-attempts", 429, 60)
    assert name not in locked.detail


def test_the_right_password_after_the_wait(door: Door) -> None:
    add(door.database, "Eva")
    for each in range(5):
        door.refused("Eva", "wrong horse battery", address=f"10.0.0.{each}")
    assert door.refused("Eva", now=NOW + 59).slug == "too-many-attempts"
    door.entered("Eva", now=NOW + 60)
    assert door.refused("Eva", "wrong horse battery", now=NOW + 60).slug == "wrong-name-or-password"


def test_no_name_is_found_by_another_spelling_that_is_counted_apart(door: Door) -> None:
    add(door.database, "Eva\ufffd")
    for spelling in ("Eva\0", "Eva\ud800", "Eva\u200b"):
        door.refused(spelling)
    door.entered("EVA\ufffd")


@BOTH
def test_many_at_once_guess_no_more_often(door: Door) -> None:
    add(door.database, "Eva")

    async def guess() -> list[tuple[str, SignedIn] | IdentityRefused]:
        guesses = [f"wrong horse {number}" for number in range(30)] + [PASSWORD]
        return list(
            await asyncio.gather(*(door.enter("Eva", each, address=f"10.1.0.{at}") for at, each in enumerate(guesses)))
        )

    slugs = [answer.slug for answer in asyncio.run(guess()) if isinstance(answer, IdentityRefused)]
    assert slugs.count("wrong-name-or-password") <= 5
    assert len(slugs) - slugs.count("too-many-attempts") <= 5


def test_a_flood_fills_neither_the_journal_nor_the_table_of_attempts(door: Door) -> None:
    for number in range(200):
        door.refused(f"somebody {number}", address="10.0.0.7")
    refused = [entry.details for entry in entries(door.database, "sign-in")]
    assert len(refused) == 11
    assert refused[0] == {"because": "too-many-attempts", "times": 1}
    door.refused("somebody", now=NOW + 61, address="10.0.0.8")
    assert entries(door.database, "sign-in")[1].details == {"because": "too-many-attempts", "times": 189}


def test_passwords_and_tokens_are_kept_nowhere(door: Door) -> None:
    add(door.database, "Eva")
    token, opened = door.entered("Eva")
    door.refused("Eva", "wrong horse battery")
    changed = door.change(opened, PASSWORD, ANOTHER)
    assert not isinstance(changed, IdentityRefused)
    kept = everything_kept(door.database)
    for secret in (PASSWORD, "wrong horse battery", ANOTHER, token, changed[0]):
        assert secret not in kept


def test_a_password_hashed_with_older_parameters_is_hashed_anew(door: Door) -> None:
    eva = add(door.database, "Eva")
    newer = Passwords(PasswordHasher(time_cost=2, memory_cost=8, parallelism=1))
    token, opened = asyncio.run(
        SignIn(door.database, newer).sign_in("Eva", PASSWORD, now=NOW, address=HERE, agent=AGENT, before=None)
    )
    with door.database.reading() as connection:
        found = users.find_password(connection, "Eva")
    assert found is not None
    assert not newer.outdated(found[1])
    assert asyncio.run(newer.verify(found[1], PASSWORD))
    newer.close()
    assert opened.person == eva
    assert is_good(door.database, token)


def test_when_too_many_wait_nothing_is_counted(door: Door) -> None:
    add(door.database, "Eva")
    narrow = Door(door.database, door.passwords, SignIn(door.database, Passwords(CHEAP, most_waiting=0)))

    async def guess() -> list[tuple[str, SignedIn] | IdentityRefused]:
        return list(await asyncio.gather(*(narrow.enter("Eva", "wrong horse battery") for _ in range(8))))

    slugs = [answer.slug for answer in asyncio.run(guess()) if isinstance(answer, IdentityRefused)]
    assert sorted(set(slugs)) == ["busy", "wrong-name-or-password"]
    assert slugs.count("busy") == 7
    for _ in range(4):
        assert door.refused("Eva", "wrong horse battery").slug == "wrong-name-or-password"
    assert door.refused("Eva", "wrong horse battery").slug == "too-many-attempts"


def test_who_is_disabled_during_the_hash_stays_out(database: Database) -> None:
    eva = add(database, "Eva")

    class Slow(PasswordHasher):
        """Somebody disables Eva while her password is hashed."""

        def check_needs_rehash(self, hash: str | bytes) -> bool:
            with database.writing() as connection:
                users.change(connection, eva.id, eva.revision, ADA, NOW, disabled=True)
            return super().check_needs_rehash(hash)

    passwords = Passwords(Slow(time_cost=1, memory_cost=8, parallelism=1))
    door = Door(database, passwords, SignIn(database, passwords))
    assert door.refused("Eva").slug == "wrong-name-or-password"
    passwords.close()
    with database.reading() as connection:
        assert sessions.live_counts(connection, NOW) == {}


@BOTH
def test_a_password_is_changed(door: Door) -> None:
    add(door.database, "Eva", temporary=True)
    (elsewhere, _), (here, opened) = door.entered("Eva"), door.entered("Eva")
    assert opened.person.must_change_password
    changed = door.change(opened, PASSWORD, ANOTHER)
    assert not isinstance(changed, IdentityRefused)
    token, anew = changed
    assert not anew.person.must_change_password
    assert anew.session != opened.session
    assert [is_good(door.database, each) for each in (elsewhere, here, token)] == [False, False, True]
    with door.database.reading() as connection:
        assert sessions.find_session(connection, token, NOW) == anew
    assert door.refused("Eva").slug == "wrong-name-or-password"
    door.entered("Eva", ANOTHER)
    (entry,) = entries(door.database, "password-changed")
    assert (entry.actor, entry.outcome) == (anew.actor(HERE), Outcome.DONE)


def test_a_stolen_session_does_not_guess_the_password(door: Door) -> None:
    add(door.database, "Eva")
    _, opened = door.entered("Eva")
    answers = [door.change(opened, f"wrong horse {number}", ANOTHER) for number in range(6)]
    slugs = [answer.slug for answer in answers if isinstance(answer, IdentityRefused)]
    assert slugs == ["wrong-password"] * 5 + ["too-many-attempts"]
    door.refused("Eva")
    recorded = entries(door.database, "password-changed")
    assert {(entry.actor, entry.outcome) for entry in recorded} == {(opened.actor(HERE), Outcome.REFUSED)}


@pytest.mark.parametrize("new", ["short", PASSWORD, "eva eva eva eva", "x" * 300])
def test_a_password_that_may_not_be(door: Door, new: str) -> None:
    add(door.database, "Eva")
    token, opened = door.entered("Eva")
    answer = door.change(opened, PASSWORD, new)
    assert isinstance(answer, IdentityRefused)
    assert (answer.slug, answer.status) == ("weak-password", 422)
    assert is_good(door.database, token)


def test_a_session_that_has_ended_changes_no_password(door: Door) -> None:
    eva = add(door.database, "Eva")
    _, opened = door.entered("Eva")
    with door.database.writing() as connection:
        sessions.end_sessions_of(connection, eva.id, ADA, NOW)
    answer = door.change(opened, PASSWORD, ANOTHER)
    assert isinstance(answer, IdentityRefused)
    assert (answer.slug, answer.status) == ("signed-out", 401)
    door.entered("Eva")


def test_a_demonstration_has_no_password(door: Door) -> None:
    with door.database.writing() as connection:
        _, opened = sessions.open_session(
            connection, DEMONSTRATOR, NOW, kind=ActorKind.DEMONSTRATION, address=HERE, agent=AGENT
        )
    answer = door.change(opened, PASSWORD, ANOTHER)
    assert isinstance(answer, IdentityRefused)
    assert (answer.slug, answer.status) == ("no-password", 403)
    assert door.refused("Demonstration", "").slug == "wrong-name-or-password"


def test_a_reset_password_may_be_tried_at_once(door: Door) -> None:
    eva = add(door.database, "Eva")
    for each in range(6):
        door.refused("Eva", "wrong horse battery", address=f"10.0.0.{each}")
    with door.database.writing() as connection:
        users.set_password(connection, eva.id, CHEAP.hash(ANOTHER), ADA, NOW, temporary=True)
    assert not isinstance(asyncio.run(door.enter("Eva", ANOTHER)), IdentityRefused)
