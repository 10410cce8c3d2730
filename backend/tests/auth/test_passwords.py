"""What may be a password, and how passwords are hashed."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterator
from typing import Literal

import pytest
from argon2 import PasswordHasher, extract_parameters

from sequence_planner.auth.passwords import LONGEST, Passwords, check_password
from sequence_planner.auth.roles import IdentityRefused
from support.people import CHEAP, cheap_passwords


@pytest.fixture
def passwords() -> Iterator[Passwords]:
    made = cheap_passwords()
    yield made
    made.close()


@pytest.mark.parametrize(
    ("password", "name"),
    [
        ("correct horse battery", "Eva"),
        ("x" * 11 + "y", "Eva"),
        ("Evergreen forests", "Eva"),
        ("秘密の言葉はとても長いです", "Eva"),
        ("a" * 255 + "b", "Eva"),
    ],
)
def test_passwords_that_may_be(password: str, name: str) -> None:
    check_password(password, name)


@pytest.mark.parametrize(
    ("password", "name", "why"),
    [
        ("short words", "Eva", "12 to 256"),
        ("b" + "a" * 256, "Eva", "12 to 256"),
        ("aaaaaaaaaaaaaaaa", "Eva", "over and over"),
        ("Password1234", "Eva", "first that somebody would try"),
        ("I am eva lind 1", "Eva Lind", "name"),
        ("ｅｖａ ｌｉｎｄ ｅｖａ", "Eva Lind", "name"),
        ("evaevaevaeva", "Eva", "name"),
    ],
)
def test_passwords_that_may_not_be(password: str, name: str, why: str) -> None:
    with pytest.raises(IdentityRefused, match=why) as refused:
        check_password(password, name)
    assert (refused.value.slug, refused.value.status) == ("weak-password", 422)
    assert password not in str(refused.value)


@pytest.mark.parametrize("password", ["a\u0308" * 100 + "bcd", "a\u0308b" * 100, "\u1112\u1161\u11ab" * 80 + "abcdef"])
def test_what_may_be_a_password_opens_with_the_same_characters(passwords: Passwords, password: str) -> None:
    try:
        check_password(password, "Eva")
    except IdentityRefused:
        assert len(password) > LONGEST
    else:
        assert asyncio.run(passwords.verify(asyncio.run(passwords.hash(password)), password))


def test_hashes_are_as_the_standard_recommends() -> None:
    passwords = Passwords()
    try:
        hashed = asyncio.run(passwords.hash("correct horse battery"))
        # What the Password Storage Cheat Sheet of OWASP asks for at least.
        assert hashed.startswith("$argon2id$v=19$m=12288,t=3,p=1$")
        assert hashed != asyncio.run(passwords.hash("correct horse battery"))
        assert asyncio.run(passwords.verify(hashed, "correct horse battery"))
        assert not asyncio.run(passwords.verify(hashed, "correct horse batterz"))
        assert not passwords.outdated(hashed)
        assert passwords.outdated(CHEAP.hash("correct horse battery"))
    finally:
        passwords.close()


def test_the_same_password_from_any_keyboard(passwords: Passwords) -> None:
    hashed = asyncio.run(passwords.hash("Zo\u00eb on the beach"))
    assert asyncio.run(passwords.verify(hashed, "Zoe\u0308 on the beach"))


def test_what_is_too_long_or_no_text_is_only_wrong(passwords: Passwords) -> None:
    hashed = asyncio.run(passwords.hash("x" * LONGEST))
    assert asyncio.run(passwords.verify(hashed, "x" * LONGEST))
    assert not asyncio.run(passwords.verify(hashed, "x" * 100_000))
    assert not asyncio.run(passwords.verify(hashed, "\ud800" * 20))
    assert not asyncio.run(passwords.verify("no hash", "x" * LONGEST))
    assert not asyncio.run(passwords.verify("", ""))


class Counting(PasswordHasher):
    """Counts its hashes, and what priority the thread has that makes them."""

    def __init__(self) -> None:
        super().__init__(time_cost=1, memory_cost=8, parallelism=1)
        self.verified: list[str | bytes] = []
        self.priority: int | None = None

    def verify(self, hash: str | bytes, password: str | bytes) -> Literal[True]:
        self.verified.append(hash)
        self.priority = os.getpriority(os.PRIO_PROCESS, 0)
        return super().verify(hash, password)


def test_without_a_hash_it_takes_one_of_the_same_cost_and_is_wrong() -> None:
    hasher = Counting()
    passwords = Passwords(hasher)
    known = asyncio.run(passwords.hash("correct horse battery"))
    for hashed in (None, known):
        for password in ("wrong horse battery", "", "x" * 1000):
            assert not asyncio.run(passwords.verify(hashed, password))
    passwords.close()
    assert len(hasher.verified) == 6
    assert all(extract_parameters(str(each)) == extract_parameters(known) for each in hasher.verified)


def test_hashing_gives_way_to_the_station() -> None:
    hasher = Counting()
    passwords = Passwords(hasher)
    assert not asyncio.run(passwords.verify(None, "whatever"))
    passwords.close()
    assert hasher.priority == min(os.getpriority(os.PRIO_PROCESS, 0) + 5, 19)


def test_few_may_wait() -> None:
    passwords = Passwords(CHEAP, most_waiting=3)

    async def ask() -> list[object]:
        return list(await asyncio.gather(*(passwords.verify(None, "x") for _ in range(10)), return_exceptions=True))

    answers = asyncio.run(ask())
    again = asyncio.run(ask())
    passwords.close()
    for each in (answers, again):
        refused = [answer for answer in each if isinstance(answer, IdentityRefused)]
        assert each.count(False) == 4
        assert [(one.slug, one.status, one.retry_after) for one in refused] == [("busy", 503, 2)] * 6
