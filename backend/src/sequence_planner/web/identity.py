"""The server's way to the people, sessions, watches and keys in the database.

The database is synchronous, so all work on it is done in threads. A request costs one read: who has been seen is
noted in memory, and written away from requests (`IdentityOffice.write_seen`). While the database does not answer, who
was let in before is remembered.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from anyio import to_thread
from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.actor import Actor
from sequence_planner.identity import keys, sessions, watches
from sequence_planner.identity.openid.settings import ProviderSettings
from sequence_planner.identity.passwords import Passwords
from sequence_planner.identity.sessions import SignedIn
from sequence_planner.identity.sign_in import SignIn
from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError
from sequence_planner.web.bearer_memory import Bearer, BearerMemory
from sequence_planner.web.cookies import Credentials

if TYPE_CHECKING:
    from sequence_planner.identity.provider_sign_in import ProviderSignIn

T = TypeVar("T")
PATIENCE = 1.0  # seconds in which the database answers, or who is remembered goes on without
ASK_AGAIN = 2.0  # seconds after which a database that did not answer is asked again about who is remembered


class IdentityOffice:
    """All that the server asks of `identity`, with the clock that it goes by (seconds since the epoch).

    With `demonstration` the sessions of a demonstration are known too; with `provider` people may sign in there.
    """

    def __init__(
        self,
        database: Database,
        passwords: Passwords,
        *,
        demonstration: bool = False,
        provider: ProviderSignIn | None = None,
        now: Callable[[], float] = time.time,
    ) -> None:
        self.database = database
        self.passwords = passwords
        self.sign_in = SignIn(database, passwords)
        self.provider = provider
        self.now = now
        self._demonstration = demonstration
        self._memory = BearerMemory()
        self._ask_again = 0.0  # seconds; on the clock of `time.monotonic`
        self._seen: dict[str, Callable[[Connection, float], None]] = {}  # what is to be written, by whose id

    @classmethod
    def open(cls, url: str, *, demonstration: bool = False, provider: ProviderSettings | None = None) -> IdentityOffice:
        """The office over the database at `url`, brought up to date. Raises `StorageError`."""
        database = Database.open(url)
        try:
            database.upgrade()
        except StorageError:
            database.close()
            raise
        sign_in = None if provider is None else _provider_sign_in(database, provider)
        return cls(database, Passwords(), demonstration=demonstration, provider=sign_in)

    def close(self) -> None:
        """Let go of the database and of the thread that hashes."""
        self.passwords.close()
        self.database.close()

    async def read(self, work: Callable[[Connection], T]) -> T:
        """What `work` reads. Raises `StorageError`, and what `work` raises."""

        def inside() -> T:
            with self.database.reading() as connection:
                return work(connection)

        return await to_thread.run_sync(inside, abandon_on_cancel=True)

    async def write(self, work: Callable[[Connection], T], *, by: Actor | None = None) -> T:
        """What `work` gives; what it wrote is durable then, or not written at all. Raises as `read` does.

        Nothing is written, and `IdentityRefused` (`signed-out`, 401) raised, when the session in which `by` acts has
        ended since the request was let in, or the key was revoked: it may have waited for a hash, or behind others.
        """

        def checked(connection: Connection) -> tuple[T, Callable[[], None]]:
            if by is not None:
                sessions.require_live(connection, by, self.now())
                keys.require_live(connection, by, self.now())
            done = work(connection)
            return done, self._memory.look_up(connection, self.now())

        done, take = await self._write(checked)
        take()  # only now: where nothing could be written, everybody is who they were
        return done

    async def note_session(self, begun: SignedIn, before: str | None) -> None:
        """Somebody has signed in, where the session with the token `before` was until now, if any.

        That has ended, and others of the same person may have: all who are remembered are looked up again.
        """
        shown = Bearer() if before is None else self._memory.recall(Credentials(session=before), self.now()) or Bearer()
        ended = None if shown.signed_in is None else shown.signed_in.session
        try:
            async with asyncio.timeout(PATIENCE):
                take = await self.read(lambda connection: self._memory.look_up(connection, self.now()))
        except (StorageError, TimeoutError):
            self._memory.forget(
                lambda each: (
                    each.signed_in is not None
                    and (each.signed_in.session == ended or each.signed_in.person.id == begun.person.id)
                )
            )
        else:
            take()

    def remembered(self, shown: Credentials) -> Bearer | None:
        """Who has shown these credentials in the last minutes; nothing is admitted by it."""
        return self._memory.recall(shown, self.now())

    async def find(self, shown: Credentials) -> Bearer:
        """Who shows these credentials: either a key, or cookies.

        Raises `StorageError` when the database does not answer and they are not those of somebody who was let in.
        """
        if shown == Credentials():
            return Bearer()
        now, asked_in = self.now(), self._memory.round
        remembered = self._memory.recall(shown, now)
        if remembered is not None and time.monotonic() < self._ask_again:
            return remembered
        try:
            async with asyncio.timeout(None if remembered is None else PATIENCE):
                bearer = await self.read(lambda connection: self._look_up(connection, shown, now))
        except (StorageError, TimeoutError) as error:
            self._ask_again = time.monotonic() + ASK_AGAIN
            remembered = self._memory.recall(shown, now)  # who was signed out meanwhile is not remembered any more
            if remembered is None:
                raise StorageError(str(error) or "the database does not answer") from error
            return remembered
        self._memory.keep(shown, bearer, now, asked_in)
        self._note(bearer, now)
        return bearer

    async def write_seen(self) -> None:
        """Write who has been seen: of each at most once a minute. Raises `StorageError`; it is tried again then."""
        seen, now = dict(self._seen), self.now()
        if not seen:
            return

        def write(connection: Connection) -> None:
            for note in seen.values():
                note(connection, now)

        await self._write(write)
        for identifier in seen:
            self._seen.pop(identifier, None)

    async def _write(self, work: Callable[[Connection], T]) -> T:
        def inside() -> T:
            with self.database.writing() as connection:
                return work(connection)

        return await run_in_threadpool(inside)

    def _look_up(self, connection: Connection, shown: Credentials, now: float) -> Bearer:
        if shown.key is not None:
            return Bearer(key=keys.find_key(connection, shown.key, now))
        signed_in = watch = None
        if shown.session is not None:
            signed_in = sessions.find_session(connection, shown.session, now, demonstration=self._demonstration)
        if shown.watch is not None:
            watch = watches.find_watch(connection, shown.watch, now)
        return Bearer(signed_in=signed_in, watch=watch)

    def _note(self, bearer: Bearer, now: float) -> None:
        if (signed_in := bearer.signed_in) is not None and signed_in.due(now):
            session = signed_in.session
            self._seen[session] = lambda connection, when: sessions.seen(connection, session, when)
        if (watch := bearer.watch) is not None and watch.due(now):
            worn = watch.id
            self._seen[worn] = lambda connection, when: watches.seen(connection, worn, when)
        if (key := bearer.key) is not None and key.due(now):
            used = key.id
            self._seen[used] = lambda connection, when: keys.used(connection, used, when)


def _provider_sign_in(database: Database, provider: ProviderSettings) -> ProviderSignIn:
    """Sign-in with a provider. Few stations have one, and what speaks to it takes a while to import."""
    from sequence_planner.identity.openid.provider import Provider  # noqa: PLC0415
    from sequence_planner.identity.provider_sign_in import ProviderSignIn  # noqa: PLC0415

    return ProviderSignIn(database, Provider(provider))
