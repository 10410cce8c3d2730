"""Who a browser is for this server: what it is told, and how it is given another session."""

from __future__ import annotations

from typing import Literal

from fastapi import Request, Response
from pydantic import BaseModel

from sequence_planner.actor import ActorKind
from sequence_planner.identity import people
from sequence_planner.identity.roles import Role
from sequence_planner.identity.sessions import SignedIn
from sequence_planner.identity.watches import WatchState
from sequence_planner.version import VERSION
from sequence_planner.web.access import bearer_of
from sequence_planner.web.cookies import Credentials, credentials, keep_session
from sequence_planner.web.demonstration import may_open_demonstration
from sequence_planner.web.identity import IdentityOffice


class SessionPerson(BaseModel):
    """Who is signed in; `issuer` is the provider that vouches for the person, who has no password here then."""

    id: str
    name: str
    role: Role
    issuer: str | None


class SessionProvider(BaseModel):
    """The provider with which people may sign in too.

    `sign_out` is where one signs out of it as well; null where that is not known.
    """

    title: str
    sign_out: str | None


class SessionWatch(BaseModel):
    """The watch that this device is, apart from who is signed in."""

    id: str
    name: str
    resource: str
    state: WatchState


class SessionAnswer(BaseModel):
    """Who the browser is for this server.

    `first-start`: nobody is signed in, and there is no administrator yet. `session` is the id that holds control where
    this session does; `expires` is when it ends at the latest, in seconds since the epoch. `demonstration` says that
    one may be opened here. The `version` of the program is for those who are signed in.
    """

    state: Literal["signed-out", "signed-in", "first-start"]
    person: SessionPerson | None
    session: str | None
    kind: Literal["person", "demonstration"] | None
    must_change_password: bool
    expires: float | None
    demonstration: bool
    watch: SessionWatch | None
    provider: SessionProvider | None
    version: str | None


async def begin_session(request: Request, response: Response, token: str, signed_in: SignedIn) -> SessionAnswer:
    """Have the browser keep a new session, and tell it whose it is."""
    office: IdentityOffice = request.app.state.identity
    await office.note_session(signed_in, credentials(request).session)
    keep_session(response, request.app.state.settings, token)
    return await answered(request, signed_in)


async def answered(request: Request, signed_in: SignedIn | None) -> SessionAnswer:
    """What the browser is told where `signed_in` is its session."""
    state = request.app.state
    watch = (await bearer_of(request, Credentials(watch=credentials(request).watch))).watch
    answer = SessionAnswer(
        state="signed-out",
        person=None,
        session=None,
        kind=None,
        must_change_password=False,
        expires=None,
        demonstration=may_open_demonstration(request, state.settings, state.controller),
        watch=None if watch is None else SessionWatch.model_validate(watch, from_attributes=True),
        provider=_provider(request),
        version=None,
    )
    if signed_in is not None:
        return answer.model_copy(update=_said_of(signed_in))
    office: IdentityOffice = state.identity
    has_administrator = await office.read(people.administrator_exists)
    return answer if has_administrator else answer.model_copy(update={"state": "first-start"})


def _provider(request: Request) -> SessionProvider | None:
    """The provider; where it signs people out is told once it was asked about itself."""
    office: IdentityOffice = request.app.state.identity
    if office.provider is None:
        return None
    provider, settings = office.provider.provider, request.app.state.settings
    home = f"{settings.scheme}://{request.headers['host'].lower()}/sign-in"
    return SessionProvider(title=provider.settings.title, sign_out=provider.end_address(home))


def _said_of(signed_in: SignedIn) -> dict[str, object]:
    return {
        "state": "signed-in",
        "person": SessionPerson.model_validate(signed_in.person, from_attributes=True),
        "session": signed_in.session,
        "kind": "demonstration" if signed_in.kind is ActorKind.DEMONSTRATION else "person",
        "must_change_password": signed_in.person.must_change_password,
        "expires": signed_in.expires,
        "version": VERSION,
    }
