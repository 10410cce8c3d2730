"""Access control: every route and WebSocket declares who may use it, by `allowed` or its like."""

from __future__ import annotations

import ipaddress
from collections.abc import Sequence
from dataclasses import dataclass, replace

from fastapi import Depends, params
from fastapi.routing import RouteContext, iter_route_contexts
from starlette.requests import HTTPConnection
from starlette.routing import BaseRoute
from starlette.types import ASGIApp, Receive, Send
from starlette.types import Scope as ASGIScope

from sequence_planner.auth.api_keys import Key
from sequence_planner.auth.roles import Role, Scope
from sequence_planner.auth.sessions import SignedIn
from sequence_planner.auth.watches import Watch, WatchState
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.http.credentials import Credentials, credentials
from sequence_planner.server.http.middleware import ConnectionKind, belongs_to
from sequence_planner.server.services.identity import Bearer, IdentityService
from sequence_planner.server.settings import Settings
from sequence_planner.texts.message import message

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
            return ProblemFound(403, "password-must-change", message("refused.password-must-change.own"))
        if self.role is None or not person.role.includes(self.role):
            if self.role is None:
                detail = message("refused.role-too-low.watch", role=person.role.value)
            else:
                detail = message("refused.role-too-low.role", needed=self.role.value, role=person.role.value)
            return ProblemFound(403, "role-too-low", detail)
        return None

    def _judge_key(self, key: Key | None, address: str) -> Admitted:
        if key is None:
            raise _signed_out("refused.signed-out.key")
        if not self.any_key and (self.scope is None or self.scope not in key.scopes):
            if self.scope is None:
                detail = message("refused.scope-missing.none", key=key.name)
            else:
                detail = message("refused.scope-missing.scope", key=key.name, scope=self.scope.value)
            raise ProblemFound(403, "scope-missing", detail)
        return Admitted(key.actor(address), key=key)

    def _judge_watch(self, watch: Watch, address: str) -> Admitted:
        if watch.state is not WatchState.ACTIVE and not (self.waiting and watch.state is WatchState.WAITING):
            raise ProblemFound(403, "wearable-unconfirmed", message("refused.wearable-unconfirmed.confirm"))
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


def _signed_out(why: str = "refused.signed-out.sign-in") -> ProblemFound:
    return ProblemFound(401, "signed-out", message(why), {"WWW-Authenticate": "Bearer"})


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
