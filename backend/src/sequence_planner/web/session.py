"""Signing in and out: sessions of people and of demonstrations, their own password, and the first administrator.

A session begins with a token that was drawn for it and travels in a cookie that no script can read. Whatever cookie a
browser had before is never taken over: its session ends.
"""

from __future__ import annotations

import contextlib
from typing import Annotated

from fastapi import Request, Response
from pydantic import Field
from sqlalchemy import Connection

from sequence_planner.actor import ActorKind
from sequence_planner.control.commands import CommandRefused
from sequence_planner.identity import first_start, sessions
from sequence_planner.identity.passwords import check_password
from sequence_planner.identity.people import DEMONSTRATOR
from sequence_planner.identity.roles import Role
from sequence_planner.identity.sessions import SignedIn
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry
from sequence_planner.web.access import allowed, bearer_of
from sequence_planner.web.body import Body, Name
from sequence_planner.web.cookies import Credentials, credentials, forget_session
from sequence_planner.web.demonstration import may_open_demonstration
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Address, Agent, Controller, Identity, Session
from sequence_planner.web.session_answer import SessionAnswer, answered, begin_session
from sequence_planner.web.sweeper import withdraw_control

EVERYBODY = allowed(None)
ONESELF = allowed(Role.VIEWER, unready=True)
LONGEST = 1000  # characters of what somebody typed; what may be a password is a matter of `check_password`

router = interface(tags=["session"])
Typed = Annotated[str, Field(min_length=1, max_length=LONGEST)]


class SignInBody(Body):
    """Who wants to sign in."""

    name: Typed
    password: Typed


class DemonstrationBody(Body):
    """Nothing: to open a demonstration is all that there is to say."""


class PasswordBody(Body):
    """One's own password as it is, and as it is to be."""

    old: Typed
    new: Typed


class FirstAdministratorBody(Body):
    """The token of the link that the first start has shown, and who the administrator is to be."""

    token: Typed
    name: Name
    password: Typed


@router.get("/session", dependencies=[EVERYBODY], responses=refused(503))
async def session(request: Request) -> SessionAnswer:
    """Who is signed in here; nobody is an answer too."""
    shown = credentials(request)
    bearer = await bearer_of(request, Credentials(session=shown.session))
    return await answered(request, bearer.signed_in)


@router.post("/session", dependencies=[EVERYBODY, JSON_ONLY], responses=refused(401, 429, 503))
async def sign_in(
    body: SignInBody, request: Request, response: Response, identity: Identity, address: Address, agent: Agent
) -> SessionAnswer:
    """Sign in; the session that the browser had ends. 401 whatever was wrong, 429 after too many attempts."""
    before = credentials(request).session
    token, signed_in = await identity.sign_in.sign_in(
        body.name, body.password, now=identity.now(), address=address, agent=agent, before=before
    )
    return await begin_session(request, response, token, signed_in)


@router.post("/session/demonstration", dependencies=[EVERYBODY, JSON_ONLY], responses=refused(503))
async def open_demonstration(
    body: DemonstrationBody,
    request: Request,
    response: Response,
    identity: Identity,
    client: Controller,
    address: Address,
    agent: Agent,
) -> SessionAnswer:
    """Open a demonstration, at the machine itself and with emulated devices alone; else 403 `no-demonstration`."""
    if not may_open_demonstration(request, request.app.state.settings, client):
        detail = "A demonstration can be opened at the machine itself, while all devices are emulated. Sign in instead."
        raise ProblemFound(403, "no-demonstration", "No demonstration here", detail)
    before, now = credentials(request).session, identity.now()

    def write(connection: Connection) -> tuple[str, SignedIn]:
        if before is not None:
            sessions.end_session_of_token(connection, before)
        kind = ActorKind.DEMONSTRATION
        token, opened = sessions.open_session(connection, DEMONSTRATOR, now, kind=kind, address=address, agent=agent)
        append(connection, Entry(actor=opened.actor(address), action="demonstration-opened"), now)
        return token, opened

    token, opened = await identity.write(write)
    return await begin_session(request, response, token, opened)


@router.delete("/session", status_code=204, dependencies=[ONESELF])
async def sign_out(
    request: Request, response: Response, identity: Identity, client: Controller, actor: Actor, signed_in: Session
) -> None:
    """Sign out; control that the session has is given up."""
    now = identity.now()
    await identity.write(lambda connection: sessions.end_session(connection, signed_in.session, actor, now))
    forget_session(response, request.app.state.settings)
    with contextlib.suppress(CommandRefused):  # the sweeper tries again
        await withdraw_control(client, signed_in.session)


@router.put("/session/password", dependencies=[ONESELF, JSON_ONLY], responses=refused(429))
async def change_password(
    body: PasswordBody,
    request: Request,
    response: Response,
    identity: Identity,
    signed_in: Session,
    address: Address,
    agent: Agent,
) -> SessionAnswer:
    """Change one's own password; all sessions of the person end, and this browser gets a new one."""
    token, again = await identity.sign_in.change_password(
        signed_in, body.old, body.new, now=identity.now(), address=address, agent=agent
    )
    return await begin_session(request, response, token, again)


@router.post("/first-administrator", status_code=201, dependencies=[EVERYBODY, JSON_ONLY], responses=refused(409, 503))
async def first_administrator(
    body: FirstAdministratorBody,
    request: Request,
    response: Response,
    identity: Identity,
    address: Address,
    agent: Agent,
) -> SessionAnswer:
    """Make the first administrator with the link of the first start, which works once and for 15 minutes.

    403 `link-unusable` when it does not.
    """
    begun = identity.now()
    if not await identity.read(lambda connection: first_start.link_usable(connection, body.token, begun)):
        raise first_start.unusable()
    check_password(body.password, body.name)
    hashed = await identity.passwords.hash(body.password)
    before, now = credentials(request).session, identity.now()

    def write(connection: Connection) -> tuple[str, SignedIn]:
        person = first_start.use_link(connection, body.token, body.name, hashed, now, address=address)
        if before is not None:
            sessions.end_session_of_token(connection, before)
        kind = ActorKind.PERSON
        return sessions.open_session(connection, person, now, kind=kind, address=address, agent=agent)

    token, signed_in = await identity.write(write)
    return await begin_session(request, response, token, signed_in)
