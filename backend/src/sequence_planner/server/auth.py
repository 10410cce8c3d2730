"""Authentication and authorization of requests: cookies, keys, access rules, session upkeep, fallback."""

from __future__ import annotations

import asyncio
import hashlib
import ipaddress
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import structlog
from anyio import to_thread
from fastapi import Depends, params
from fastapi.routing import RouteContext, iter_route_contexts
from sqlalchemy import Connection
from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection
from starlette.responses import Response
from starlette.routing import BaseRoute
from starlette.types import ASGIApp, Receive, Send
from starlette.types import Scope as ASGIScope

from sequence_planner.auth import api_keys, sessions, watches
from sequence_planner.auth.api_keys import Key
from sequence_planner.auth.login import SignIn
from sequence_planner.auth.oidc.settings import ProviderSettings
from sequence_planner.auth.passwords import Passwords
from sequence_planner.auth.roles import Role, Scope
from sequence_planner.auth.sessions import LONGEST_IDLE, SignedIn, find_live
from sequence_planner.auth.watches import Watch, WatchState
from sequence_planner.controller.commands.commands import CommandRefused
from sequence_planner.controller.commands.production import WithdrawControl
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.core.actor import SYSTEM, Actor, ActorKind
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.http.middleware import ConnectionKind, belongs_to
from sequence_planner.server.settings import Settings

if TYPE_CHECKING:
    from sequence_planner.auth.oidc.sign_in import ProviderSignIn

# What a request shows to say who it is from: cookies that only this server can set and read, or a key.
#
# On HTTPS the names begin with `__Host-`: browsers then take the cookie from this very host alone, over HTTPS alone
# (RFC 6265bis). On the loopback they end in the port, since cookies know no ports and two stations may run beside each
# other.

NAME = "sequence-planner"
SESSION_COOKIE, WATCH_COOKIE = f"__Host-{NAME}", f"__Host-{NAME}-watch"
FLOW_COOKIE = f"__Host-{NAME}-sign-in"
LONGEST = 256  # characters of a credential; what is longer is none of ours


@dataclass(frozen=True)
class Credentials:
    """The secrets that a request shows; none of them is known to be right."""

    session: str | None = None
    watch: str | None = None
    key: str | None = None


def session_cookie(settings: Settings) -> str:
    """The name of the cookie that holds a session's token."""
    return SESSION_COOKIE if settings.https else f"{NAME}-{settings.port}"


def watch_cookie(settings: Settings) -> str:
    """The name of the cookie that holds a watch's token."""
    return WATCH_COOKIE if settings.https else f"{NAME}-watch-{settings.port}"


def flow_cookie(settings: Settings) -> str:
    """The name of the cookie that holds the token of a sign-in that was begun with a provider."""
    return FLOW_COOKIE if settings.https else f"{NAME}-sign-in-{settings.port}"


def flow_token(connection: HTTPConnection) -> str | None:
    """The token of the sign-in that this browser has begun; it is not known to be right."""
    return _short(connection.cookies.get(flow_cookie(connection.app.state.settings)))


def credentials(connection: HTTPConnection) -> Credentials:
    """Return what `connection` shows. A key is shown as `Authorization: Bearer sp_…`; other schemes are not ours."""
    settings: Settings = connection.app.state.settings
    scheme, _, secret = connection.headers.get("authorization", "").partition(" ")
    cookies = connection.cookies
    return Credentials(
        session=_short(cookies.get(session_cookie(settings))),
        watch=_short(cookies.get(watch_cookie(settings))),
        key=(_short(secret.strip()) or "") if scheme.lower() == "bearer" else None,
    )


def keep_session(response: Response, settings: Settings, token: str) -> None:
    """Have the browser keep a session's token until it is closed."""
    _keep(response, session_cookie(settings), token, settings, None)


def keep_watch(response: Response, settings: Settings, token: str, seconds: int) -> None:
    """Have the browser keep a watch's token for `seconds`."""
    _keep(response, watch_cookie(settings), token, settings, seconds)


def keep_flow(response: Response, settings: Settings, token: str, seconds: int) -> None:
    """Have the browser keep the token of a sign-in for `seconds`."""
    _keep(response, flow_cookie(settings), token, settings, seconds)


def forget_flow(response: Response, settings: Settings) -> None:
    """Have the browser forget the sign-in that it has begun."""
    _keep(response, flow_cookie(settings), "", settings, 0)


def forget_session(response: Response, settings: Settings) -> None:
    """Have the browser forget its session's token."""
    _keep(response, session_cookie(settings), "", settings, 0)


def _keep(response: Response, name: str, value: str, settings: Settings, seconds: int | None) -> None:
    response.set_cookie(name, value, max_age=seconds, httponly=True, samesite="strict", secure=settings.https)


def _short(secret: str | None) -> str | None:
    return secret if secret and len(secret) <= LONGEST else None


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


# Where a demonstration may be opened: at the machine itself, and only as long as all devices are emulated.

FORWARDED = ("forwarded", "x-forwarded-for", "x-real-ip")  # somebody stands between: the other end is not the browser


def may_be_demonstration(connection: HTTPConnection, settings: Settings, controller: ControllerClient) -> bool:
    """Return whether a demonstration that was opened may go on: nothing speaks against it."""
    is_real = controller.view is not None and not controller.view.station.emulated
    return settings.demonstration and is_beside(connection) and not is_real


def may_open_demonstration(connection: HTTPConnection, settings: Settings, controller: ControllerClient) -> bool:
    """Return whether a demonstration may be opened: the controller itself says now that its devices are emulated."""
    is_emulated = controller.heard and controller.view is not None and controller.view.station.emulated
    return is_emulated and may_be_demonstration(connection, settings, controller)


def is_beside(connection: HTTPConnection) -> bool:
    """Return whether the other end of the connection is on this machine."""
    if connection.client is None or any(name in connection.headers for name in FORWARDED):
        return False
    try:
        return ipaddress.ip_address(connection.client.host).is_loopback
    except ValueError:
        return False


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


# Who may use a route: every route and WebSocket declares it, by `allowed` or its like, where it is defined.
#
# A request shows a key, or else a session's cookie, or else a watch's. What it shows is looked up once; then only what
# the route declares decides. The application is not built when a route declares nothing (`check_declared`).

# In the place of a role: everybody, watches alone, and programs on this machine.
PUBLIC, WATCH, BESIDE = "public", "watch", "beside"


@dataclass(frozen=True)
class Admitted:
    """Somebody who has been let in: `actor`, and of the other three the one that it is."""

    actor: Actor
    signed_in: SignedIn | None = None
    watch: Watch | None = None
    key: Key | None = None

    @property
    def id(self) -> str:
        """Of the session, the watch or the key."""
        if self.signed_in is not None:
            return self.signed_in.session
        found = self.watch or self.key
        return self.actor.id if found is None else found.id


@dataclass(frozen=True)
class Access:
    """The access that a route declares. Without `role` no person may use it; `public` lets everybody in.

    `scope` is that of the keys which may; `watch` lets active watches in, `waiting` those too that nobody has
    confirmed yet; `unready` lets people in who must change their password first. `beside` lets in whoever shows no key
    on this machine itself, `any_key` every key that is valid.
    """

    role: Role | None = None
    public: bool = False
    beside: bool = False
    scope: Scope | None = None
    watch: bool = False
    waiting: bool = False
    unready: bool = False
    any_key: bool = False

    @property
    def who(self) -> str:
        """The role, or what stands in its place."""
        if self.role is not None:
            return self.role.value
        return PUBLIC if self.public else BESIDE if self.beside else WATCH

    async def __call__(self, connection: HTTPConnection) -> None:
        """Let a request in, and keep in its `state` who it is; or raise `ProblemFound`."""
        if self.public or (self.beside and is_beside(connection) and credentials(connection).key is None):
            return
        admitted = await self.admit(connection)
        belongs_to(connection.scope, (ConnectionKind.BEARER, admitted.id))
        connection.state.access = self
        connection.state.actor = admitted.actor
        connection.state.signed_in, connection.state.watch = admitted.signed_in, admitted.watch
        connection.state.key = admitted.key

    async def admit(self, connection: HTTPConnection) -> Admitted:
        """Return who shows what is asked for here. Raises `ProblemFound` 401 or 403, and 503 when nobody can be looked
        up.
        """
        shown = self._asked_for(credentials(connection))
        return self._judge(shown, await bearer_of(connection, shown), address_of(connection))

    def _asked_for(self, shown: Credentials) -> Credentials:
        """Of what is shown, what matters here."""
        if shown.key is not None:
            return Credentials(key=shown.key)
        session = None if self.role is None else shown.session
        return Credentials(session=session, watch=shown.watch if self.watch else None)

    def _judge(self, shown: Credentials, bearer: Bearer, address: str) -> Admitted:
        if shown.key is not None:
            return self._judge_key(bearer.key, address)
        if self.watch and bearer.watch is not None and (bearer.signed_in is None or self._wrong(bearer.signed_in)):
            return self._judge_watch(bearer.watch, address)
        if bearer.signed_in is None:
            raise _signed_out()
        if (wrong := self._wrong(bearer.signed_in)) is not None:
            raise wrong
        return Admitted(bearer.signed_in.actor(address), signed_in=bearer.signed_in)

    def _wrong(self, signed_in: SignedIn) -> ProblemFound | None:
        person = signed_in.person
        if person.must_change_password and not self.unready:
            detail = "Your password was set by somebody else. Choose one of your own first."
            return ProblemFound(403, "password-must-change", "The password must be changed", detail)
        if self.role is None or not person.role.includes(self.role):
            needed = "a paired watch" if self.role is None else f"the role {self.role.value}"
            detail = f"This takes {needed}; you have the role {person.role.value}. Ask an administrator."
            return ProblemFound(403, "role-too-low", "You may not do this", detail)
        return None

    def _judge_key(self, key: Key | None, address: str) -> Admitted:
        if key is None:
            detail = "The key is unknown, has expired or was revoked. Ask an administrator for another."
            raise _signed_out(detail)
        if not self.any_key and (self.scope is None or self.scope not in key.scopes):
            needed = "no key may do this" if self.scope is None else f"it takes one with the scope {self.scope.value}"
            detail = f"The key {key.name} may not do this: {needed}."
            raise ProblemFound(403, "scope-missing", "The key may not do this", detail)
        return Admitted(key.actor(address), key=key)

    def _judge_watch(self, watch: Watch, address: str) -> Admitted:
        if watch.state is not WatchState.ACTIVE and not (self.waiting and watch.state is WatchState.WAITING):
            detail = "Whoever made the code must first confirm this watch."
            raise ProblemFound(403, "wearable-unconfirmed", "The watch is not confirmed yet", detail)
        return Admitted(watch.actor(address), watch=watch)


def allowed(
    role: Role | None,
    *,
    scope: Scope | None = None,
    watch: bool = False,
    unready: bool = False,
    any_key: bool = False,
) -> params.Depends:
    """Declares in the `dependencies` of a route who may use it: people with `role`, or everybody (None).

    Keys with `scope` may too (all that are valid with `any_key`), and active watches with `watch`. People who must
    change their password first may only use what is `unready`. Raises `ValueError` where everybody may, and more is
    said all the same.
    """
    if role is None and (scope is not None or watch or unready or any_key):
        raise ValueError("what is public is so for everybody; for watches alone there is `watch_only`")
    access = Access(role, public=role is None, scope=scope, watch=watch, unready=unready, any_key=any_key)
    declared: params.Depends = Depends(access)
    return declared


def watch_only(*, waiting: bool = False) -> params.Depends:
    """Declares that active watches alone may use a route; with `waiting` also those that are not confirmed yet."""
    declared: params.Depends = Depends(Access(watch=True, waiting=waiting))
    return declared


def beside_or(scope: Scope) -> params.Depends:
    """Declares that programs on this machine may use a route, and keys with `scope` from anywhere."""
    declared: params.Depends = Depends(Access(beside=True, scope=scope))
    return declared


def declared(route: RouteContext) -> Access:
    """Return what a route declares. Raises `RuntimeError` when it declares nothing, or more than once."""
    found = [each.dependency for each in getattr(route, "dependencies", None) or []]
    accesses = [each for each in found if isinstance(each, Access)]
    if len(accesses) != 1:
        raise RuntimeError(f"{route.path} must declare once who may use it; see `allowed`")
    return accesses[0]


def check_declared(routes: Sequence[BaseRoute]) -> None:
    """Raise `RuntimeError` when one of the routes does not declare once who may use it."""
    for route in iter_route_contexts(routes):
        declared(route)


def address_of(connection: HTTPConnection) -> str:
    """The address of the other end, as far as it can be believed; empty where there is none."""
    return "" if connection.client is None else connection.client.host


async def bearer_of(connection: HTTPConnection, shown: Credentials) -> Bearer:
    """Return who shows these credentials here. A session of a demonstration ends with what allowed it.

    Raises `StorageError`.
    """
    office: IdentityService = connection.app.state.identity
    bearer = await office.find(shown)
    if bearer.signed_in is None or bearer.signed_in.kind is not ActorKind.DEMONSTRATION:
        return bearer
    state = connection.app.state
    may_go_on = may_be_demonstration(connection, state.settings, state.controller)
    return bearer if may_go_on else replace(bearer, signed_in=None)


def _signed_out(detail: str = "Sign in, then try again.") -> ProblemFound:
    return ProblemFound(401, "signed-out", "Nobody is signed in", detail, {"WWW-Authenticate": "Bearer"})


# Whose the connection of a request is, before anybody is looked up.


class Remembering:
    """Gives the connection of a request to whom it belongs, where that was found out lately.

    It takes no time, and so nobody who asks for nothing can take their place until they are looked up.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: ASGIScope, receive: Receive, send: Send) -> None:
        """Serve one request or connection."""
        if scope["type"] in ("http", "websocket"):
            connection = HTTPConnection(scope)
            office: IdentityService = connection.app.state.identity
            bearer = office.remembered(credentials(connection))
            if bearer is not None and (found := _id_of(bearer)) is not None:
                belongs_to(scope, (ConnectionKind.BEARER, found))
        await self.app(scope, receive, send)


def _id_of(bearer: Bearer) -> str | None:
    if bearer.signed_in is not None:
        return bearer.signed_in.session
    found = bearer.watch or bearer.key
    return None if found is None else found.id


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
