"""People, sessions, watches and keys as the server knows them, also while the database does not answer."""

from __future__ import annotations

import asyncio
import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import structlog
from anyio import to_thread
from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool

from sequence_planner.auth import api_keys, sessions, watches
from sequence_planner.auth.api_keys import Key
from sequence_planner.auth.login import SignIn
from sequence_planner.auth.oidc.settings import ProviderSettings
from sequence_planner.auth.passwords import Passwords
from sequence_planner.auth.sessions import LONGEST_IDLE, SignedIn, find_live
from sequence_planner.auth.watches import Watch, WatchState
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import WithdrawControl
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.server.http.credentials import Credentials

if TYPE_CHECKING:
    from sequence_planner.auth.oidc.sign_in import ProviderSignIn

# Who has been let in, for the time in which the database does not answer.
#
# A database that restarts must not blind the screens of operators, nor keep anybody from pausing, however long it is
# away. So whoever was signed in is let in as before, as long as the session would last; nobody else is. Whenever
# something has changed, all who are remembered are looked up again: whoever was signed out or revoked by then stays
# out. What cannot be recorded is refused by the controller all the same.

MOST = 1000
_LET_IN = (WatchState.WAITING, WatchState.ACTIVE)


@dataclass(frozen=True)
class Bearer:
    """Somebody who shows credentials: those of them that are right."""

    signed_in: SignedIn | None = None
    watch: Watch | None = None
    key: Key | None = None

    @property
    def expires(self) -> float:
        """The time when the first of them ends at the latest, in seconds since the epoch."""
        return min((each.expires for each in (self.signed_in, self.watch, self.key) if each), default=0.0)


@dataclass
class _Remembered:
    used: float  # seconds since the epoch
    bearer: Bearer


class BearerMemory:
    """Bearers by what they have shown, of which only a hash is kept. `round` counts how often all were looked up."""

    def __init__(self) -> None:
        self.round = 0
        self._found: dict[bytes, _Remembered] = {}  # the one that was not found for longest is the first

    def keep(self, shown: Credentials, bearer: Bearer, now: float, asked_in: int) -> None:
        """Remember who was found at `now`. What was asked before all were looked up again says nothing new."""
        mark = _mark(shown)
        if bearer == Bearer():
            self._found.pop(mark, None)
        elif asked_in == self.round:
            self._found.pop(mark, None)
            self._found[mark] = _Remembered(now, bearer)
            if len(self._found) > MOST:
                del self._found[next(iter(self._found))]

    def recall(self, shown: Credentials, now: float) -> Bearer | None:
        """Return who has shown this before, if that has not ended since: a session lasts for an hour without a
        request.
        """
        found = self._found.get(_mark(shown))
        if found is None or now >= found.bearer.expires or abs(now - found.used) > LONGEST_IDLE:
            return None
        found.used = now
        return found.bearer

    def look_up(self, connection: Connection, now: float) -> Callable[[], None]:
        """Look all up again; what is found counts once what is given back is called, as what was changed is durable."""
        before = dict(self._found)
        found = _still_there([each.bearer for each in before.values()], connection, now)

        def take() -> None:
            self.round += 1
            for (mark, each), bearer in zip(before.items(), found, strict=True):
                if bearer is None:
                    self._found.pop(mark, None)
                else:
                    each.bearer = bearer
            for mark in self._found.keys() - before.keys():  # kept since, and not looked up
                del self._found[mark]

        return take

    def forget(self, whose: Callable[[Bearer], bool]) -> None:
        """Forget these, as they could not be looked up."""
        self.round += 1
        for mark in [mark for mark, each in self._found.items() if whose(each.bearer)]:
            del self._found[mark]


def _still_there(bearers: list[Bearer], connection: Connection, now: float) -> list[Bearer | None]:
    """Each as it is by now; None where one of its credentials works no more."""
    signed_in = [each.signed_in.session for each in bearers if each.signed_in is not None]
    live = sessions.find_all_live(connection, signed_in, now) if signed_in else {}
    worn = {each.id: each for each in watches.all_watches(connection, now)} if any(b.watch for b in bearers) else {}
    made = {each.id: each for each in api_keys.all_keys(connection)} if any(b.key for b in bearers) else {}

    def as_it_is(bearer: Bearer) -> Bearer | None:
        session, watch, key = bearer.signed_in, bearer.watch, bearer.key
        if session is not None and (session := live.get(session.session)) is None:
            return None
        if watch is not None and ((watch := worn.get(watch.id)) is None or watch.state not in _LET_IN):
            return None
        if key is not None and not _is_as_it_was(key, made.get(key.id)):
            return None
        return replace(bearer, signed_in=session, watch=watch)

    return [as_it_is(each) for each in bearers]


def _is_as_it_was(key: Key, found: Key | None) -> bool:
    """Return whether a key was neither revoked nor given another secret since."""
    if found is None or found.revoked is not None:
        return False
    return (key.former_until, key.created) == (found.former_until, found.created)


def _mark(shown: Credentials) -> bytes:
    return hashlib.sha256(repr(shown).encode("utf-8", "surrogatepass")).digest()


# The server's way to the people, sessions, watches and keys in the database.
#
# The database is synchronous, so all work on it is done in threads. A request costs one read: who has been seen is
# noted in memory, and written away from requests (`IdentityService.write_seen`). While the database does not answer,
# who was let in before is remembered.

T = TypeVar("T")
PATIENCE = 1.0  # seconds in which the database answers, or who is remembered goes on without
ASK_AGAIN = 2.0  # seconds after which a database that did not answer is asked again about who is remembered


class IdentityService:
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
    def open(
        cls, url: str, *, demonstration: bool = False, provider: ProviderSettings | None = None
    ) -> IdentityService:
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
        """Return what `work` reads. Raises `StorageError`, and what `work` raises."""

        def inside() -> T:
            with self.database.reading() as connection:
                return work(connection)

        return await to_thread.run_sync(inside, abandon_on_cancel=True)

    async def write(self, work: Callable[[Connection], T], *, by: Actor | None = None) -> T:
        """Return what `work` gives; what it wrote is durable then, or not written at all. Raises as `read` does.

        Nothing is written, and `IdentityRefused` (`signed-out`, 401) raised, when the session in which `by` acts has
        ended since the request was let in, or the key was revoked: it may have waited for a hash, or behind others.
        """

        def checked(connection: Connection) -> tuple[T, Callable[[], None]]:
            if by is not None:
                sessions.require_live(connection, by, self.now())
                api_keys.require_live(connection, by, self.now())
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
        """Return who has shown these credentials in the last minutes; nothing is admitted by it."""
        return self._memory.recall(shown, self.now())

    async def find(self, shown: Credentials) -> Bearer:
        """Return who shows these credentials: either a key, or cookies.

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
            return Bearer(key=api_keys.find_key(connection, shown.key, now))
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
            self._seen[used] = lambda connection, when: api_keys.used(connection, used, when)


def _provider_sign_in(database: Database, provider: ProviderSettings) -> ProviderSignIn:
    """Sign-in with a provider. Few stations have one, and what speaks to it takes a while to import."""
    from sequence_planner.auth.oidc.provider import Provider  # noqa: PLC0415
    from sequence_planner.auth.oidc.sign_in import ProviderSignIn  # noqa: PLC0415

    return ProviderSignIn(database, Provider(provider))


# What the server does about sessions by itself: one that has ended loses control, and it notes who has been seen.
#
# Rows that are over need no sweeping: they go whenever another of their kind comes.

LOG = structlog.get_logger(__name__)
LOOK_EVERY = 0.5  # seconds


class Sweeper:
    """Looks twice a second whether the session in control still lives."""

    def __init__(self, office: IdentityService, controller: ControllerClient) -> None:
        self._office = office
        self._controller = controller
        self._in_trouble = False

    async def run(self) -> None:
        """Sweep until cancelled. What fails is tried again and again."""
        while True:
            try:
                await self._sweep()
                self._in_trouble = False
            except (StorageError, CommandRefused) as error:
                self._note(str(error))
            except Exception as error:  # whatever it is, who has lost a session must not keep control
                self._note(repr(error))
            await asyncio.sleep(LOOK_EVERY)

    def _note(self, reason: str) -> None:
        if not self._in_trouble:
            LOG.warning("sessions cannot be looked after now", reason=reason)
        self._in_trouble = True

    async def _sweep(self) -> None:
        await self._withdraw()
        await self._office.write_seen()

    async def _withdraw(self) -> None:
        view = self._controller.view
        if view is None or view.control is None or not self._controller.heard:
            return
        session, now = view.control.session, self._office.now()

        def lives(connection: Connection) -> bool:
            return find_live(connection, session, now) is not None

        if not await self._office.read(lives):
            await withdraw_control(self._controller, session)


async def withdraw_control(controller: ControllerClient, session: str) -> None:
    """Have the controller take control from a session that has ended, if it has it. Raises `CommandRefused`."""
    view = controller.view
    if view is not None and view.control is not None and view.control.session == session:
        await controller.send(WithdrawControl(actor=SYSTEM, session=session))
