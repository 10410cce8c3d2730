"""Passwords: what may be one, and how they are hashed."""

from __future__ import annotations

import asyncio
import contextlib
import os
import threading
import unicodedata
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from argon2 import Parameters, PasswordHasher, Type
from argon2.exceptions import InvalidHashError, VerificationError

from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.tokens import name_key, new_token
from sequence_planner.texts.message import Message, message

SHORTEST, LONGEST = 12, 256  # characters
MOST_WAITING = 16  # so the last of them waits less than a second
_SHORT_NAME = 4  # characters; shorter names may be in a password by chance
_KINDER = 5  # how much lower the priority of hashing is than that of the rest (setpriority(2))
_COMMON = frozenset(
    {"123456789012", "1234567890123", "123456789abc", "1234567890qwerty", "abcdefghijkl", "administrator"}
    | {"changemechangeme", "letmeinletmein", "passwordpassword", "password1234", "password12345", "password123456"}
    | {"qwertyuiop12", "qwertyuiop123", "qwertyuiopasdf", "qwertyuiop[]", "qwerty123456", "1q2w3e4r5t6y"}
)

# The least that the Password Storage Cheat Sheet of OWASP asks for, in KiB and passes: the same machine runs a station,
# and somebody whom a robot waits for is signed in in a moment.
COSTS = Parameters(Type.ID, version=19, salt_len=16, hash_len=32, memory_cost=12 * 1024, time_cost=3, parallelism=1)

T = TypeVar("T")


def check_password(password: str, name: str) -> None:
    """Raise `IdentityRefused` (`weak-password`, 422) unless `password` may be that of the person `name`.

    Length counts, and no rule about kinds of characters (NIST SP 800-63B, 3.1.1.2).
    """
    text, key = unicodedata.normalize("NFKC", password), name_key(name)
    folded = name_key(password)
    if len(text) < SHORTEST or max(len(text), len(password)) > LONGEST:
        raise _weak(message("refused.weak-password.length", shortest=SHORTEST, longest=LONGEST))
    if len(set(folded)) == 1:
        raise _weak(message("refused.weak-password.repeated"))
    if folded in _COMMON:
        raise _weak(message("refused.weak-password.common"))
    if key and (key in folded if len(key) >= _SHORT_NAME else not folded.replace(key, "").strip()):
        raise _weak(message("refused.weak-password.name"))


class Passwords:
    """Hashes passwords with argon2id (RFC 9106), one at a time in a thread of its own, and with a low priority.

    A hash takes memory and all of a processor for a moment, which is what makes guessing costly; so that guessing does
    not take the machine from the station, few may wait for it.
    """

    def __init__(self, hasher: PasswordHasher | None = None, *, most_waiting: int = MOST_WAITING) -> None:
        self._hasher = hasher if hasher is not None else PasswordHasher.from_parameters(COSTS)
        self._nobodys: str | None = None  # what nobody's password is compared with
        self._most, self._inside = most_waiting + 1, 0
        self._executor = ThreadPoolExecutor(1, "passwords", _give_way)

    @contextlib.contextmanager
    def place(self) -> Iterator[None]:
        """A place in the queue, for as long as the block runs. Raises `IdentityRefused` (`busy`, 503) when it is full.

        With it, what has to be done before a hash is not done in vain.
        """
        if self._inside >= self._most:
            raise IdentityRefused("busy", message("refused.busy.passwords"), 503, retry_after=2)
        self._inside += 1
        try:
            yield
        finally:
            self._inside -= 1

    async def hash(self, password: str) -> str:
        """Hash a password. Raises `IdentityRefused` (`busy`, 503)."""
        with self.place():
            return await self.hash_in_place(password)

    async def verify(self, hashed: str | None, password: str) -> bool:
        """Return whether it is the password that was hashed; without a hash never, which takes as long.

        Raises `IdentityRefused` (`busy`, 503).
        """
        with self.place():
            return await self.verify_in_place(hashed, password)

    async def hash_in_place(self, password: str) -> str:
        """Do what `hash` does, for who has a `place`."""
        return await self._aside(lambda: self._hasher.hash(_bytes(password)))

    async def verify_in_place(self, hashed: str | None, password: str) -> bool:
        """Do what `verify` does, for who has a `place`."""
        return await self._aside(lambda: self._verify(hashed, password))

    def outdated(self, hashed: str) -> bool:
        """Return whether it was hashed with other parameters than those of today."""
        return self._hasher.check_needs_rehash(hashed)

    def close(self) -> None:
        """End the thread, after the hash that it is at."""
        self._executor.shutdown(cancel_futures=True)

    def _verify(self, hashed: str | None, password: str) -> bool:
        # Made with the first password that is checked, whosesoever that is: it tells nothing, and a start is quicker.
        self._nobodys = self._nobodys or self._hasher.hash(new_token())
        tried = hashed if hashed and len(password) <= LONGEST else None
        try:
            right = self._hasher.verify(tried if tried is not None else self._nobodys, _bytes(password))
        except (VerificationError, InvalidHashError):
            return False
        return right and tried is not None

    async def _aside(self, work: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._executor, work)


def _give_way() -> None:
    with contextlib.suppress(OSError):
        own = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), own + _KINDER)


def _bytes(password: str) -> bytes:
    """The same bytes however a keyboard makes the characters (RFC 8265, 4.2)."""
    return unicodedata.normalize("NFKC", password[: LONGEST + 1]).encode("utf-8", "surrogatepass")


def _weak(detail: Message) -> IdentityRefused:
    return IdentityRefused("weak-password", detail, 422)
