"""Everybody who may knock at the server's door, each with what they show."""

from __future__ import annotations

import time
from dataclasses import dataclass

from sqlalchemy import update

from sequence_planner.auth import api_keys, sessions, users, watches
from sequence_planner.auth import watches as pairing
from sequence_planner.auth.oidc.sign_in import open_flow
from sequence_planner.auth.roles import Role, Scope
from sequence_planner.auth.tables import KEYS, SESSIONS
from sequence_planner.auth.tokens import new_token
from sequence_planner.auth.users import DEMONSTRATOR
from sequence_planner.auth.watches import Watch
from sequence_planner.core.actor import SYSTEM, ActorKind
from sequence_planner.server.http.credentials import session_cookie, watch_cookie
from support.server import Server

HOUR = 3600.0  # seconds
Headers = dict[str, str]


@dataclass(frozen=True)
class Bearer:
    """What somebody shows, and what should come of it: the role, scope or watch that it is still worth."""

    headers: Headers
    role: Role | None = None
    scopes: tuple[Scope, ...] | None = None  # of a key that is live; None: no key
    watch: bool = False
    waiting: bool = False
    unready: bool = False


def key(server: Server, *scopes: Scope) -> tuple[str, api_keys.Key]:
    """A key and its secret."""
    with server.identity.database.writing() as connection:
        return api_keys.make_key(connection, "MES", frozenset(scopes), 30, SYSTEM, time.time())


def watch(server: Server, name: str, *, confirmed: bool = True, resource: str = "operator") -> tuple[str, Watch]:
    """A watch and its token."""
    now, database = time.time(), server.identity.database
    with database.writing() as connection:
        code, _ = pairing.offer(connection, name, resource, SYSTEM, now)
    token, made = pairing.redeem(database, code, now, address="127.0.0.1", agent="tests")
    if confirmed:
        with database.writing() as connection:
            made = watches.confirm(connection, made.id, SYSTEM, now)
    return token, made


def everybody(server: Server) -> dict[str, Bearer]:
    """Each kind of somebody."""
    found = {
        "nobody": Bearer({}),
        "made up": Bearer(server.cookie("x" * 43)),
        "too long": Bearer(server.cookie("x" * 4000)),
    }
    for role in Role:
        found[role.value] = Bearer(server.cookie(server.session(server.person(role))[0]), role=role)
    return found | _unready(server) | _keys(server) | _watches(server) | _gone(server)


def _gone(server: Server) -> dict[str, Bearer]:
    """Sessions of administrators that are none any more."""
    database, now = server.identity.database, time.time()
    ended, signed_in = server.session(server.person(Role.ADMINISTRATOR))
    outcast = server.person(Role.ADMINISTRATOR)
    banned, _ = server.session(outcast)
    changed = server.person(Role.ADMINISTRATOR)
    demoted, _ = server.session(changed)
    with database.writing() as connection:
        sessions.end_session(connection, signed_in.session, SYSTEM, now)
        users.change(connection, outcast.id, outcast.revision, SYSTEM, now, disabled=True)
        users.change(connection, changed.id, changed.revision, SYSTEM, now, role=Role.VIEWER)
        kind = ActorKind.DEMONSTRATION
        shown, _ = sessions.open_session(connection, DEMONSTRATOR, now, kind=kind, address="127.0.0.1", agent="")
    expired, old = server.session(server.person(Role.ADMINISTRATOR))
    idle, left = server.session(server.person(Role.ADMINISTRATOR))
    with database.writing() as connection:
        for signed_in, values in ((old, {"expires": now}), (left, {"last_seen": now - HOUR})):
            connection.execute(update(SESSIONS).where(SESSIONS.c.id == signed_in.session).values(values))
    tokens = {"ended": ended, "disabled": banned, "demoted": demoted, "idle": idle, "expired": expired}
    return {name: Bearer(server.cookie(token)) for name, token in {**tokens, "demonstration": shown}.items()}


def _unready(server: Server) -> dict[str, Bearer]:
    person = server.person(Role.ADMINISTRATOR, temporary=True)
    token, _ = server.session(person)
    return {"must change the password": Bearer(server.cookie(token), role=person.role, unready=True)}


def _keys(server: Server) -> dict[str, Bearer]:
    found = {}
    orders = ((Scope.ORDERS_READ,), (Scope.ORDERS_WRITE,), (Scope.WEBHOOKS,))
    for scopes in ((Scope.READ,), (Scope.AUDIT,), (Scope.METRICS,), (Scope.READ, Scope.AUDIT), *orders):
        secret, _ = key(server, *scopes)
        found[f"key to {' and '.join(scopes)}"] = Bearer(_bearing(secret), scopes=scopes)
    secret, revoked = key(server, Scope.READ, Scope.AUDIT)
    with server.identity.database.writing() as connection:
        api_keys.revoke_key(connection, revoked.id, SYSTEM, time.time())
    token, _ = server.session(server.person(Role.ADMINISTRATOR))
    administrator = server.cookie(token)
    before, rotated = key(server, *Scope)
    over, expired = key(server, *Scope)
    with server.identity.database.writing() as connection:
        after, _ = api_keys.rotate_key(connection, rotated.id, 0, None, SYSTEM, time.time())
        connection.execute(update(KEYS).where(KEYS.c.id == expired.id).values(expires=time.time()))
        open_flow(connection, flow := new_token(), "/", time.time())
    return {
        **found,
        "key, before its rotation": Bearer(_bearing(before)),
        "key, after its rotation": Bearer(_bearing(after), scopes=tuple(Scope)),
        "key, expired": Bearer(_bearing(over)),
        "key in the place of a session": Bearer(server.cookie(after)),
        "session in the place of a key": Bearer(_bearing(token)),
        "sign-in under way in the place of a session": Bearer(server.cookie(flow)),
        "key, revoked": Bearer(_bearing(secret)),
        "key, revoked, of an administrator": Bearer(_bearing(secret) | administrator),
        "key, made up": Bearer(_bearing(f"sp_{'0' * 16}_{'x' * 43}")),
        "key, nonsense": Bearer({"Authorization": "Bearer x"}),
        "key, too long": Bearer({"Authorization": f"bearer {'x' * 4000}"}),
    }


def _bearing(secret: str) -> Headers:
    return {"Authorization": f"Bearer {secret}"}


def _watches(server: Server) -> dict[str, Bearer]:
    name = watch_cookie(server.settings)
    active, worn = watch(server, "Watch of Ada")
    waiting, _ = watch(server, "Watch of Ben", confirmed=False)
    revoked, lost = watch(server, "Watch of Cleo")
    with server.identity.database.writing() as connection:
        watches.revoke(connection, lost.id, SYSTEM, time.time())
    assert worn.resource == "operator"
    return {
        "watch": Bearer({"Cookie": f"{name}={active}"}, watch=True),
        "watch, waiting": Bearer({"Cookie": f"{name}={waiting}"}, waiting=True),
        "watch, revoked": Bearer({"Cookie": f"{name}={revoked}"}),
        "watch in the place of a session": Bearer({"Cookie": f"{session_cookie(server.settings)}={active}"}),
    }
