"""Routes of sessions: sign-in by password or OpenID Connect, demonstrations, first administrator."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import Request, Response
from pydantic import AfterValidator, Field
from sqlalchemy import Connection

from sequence_planner.auth import first_start, sessions, users
from sequence_planner.auth.oidc.flow import FLOW_LIFE, ProviderAnswer
from sequence_planner.auth.passwords import check_password
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import SignedIn
from sequence_planner.auth.users import DEMONSTRATOR
from sequence_planner.auth.watches import WatchState
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.core.actor import ActorKind
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry
from sequence_planner.server.auth import allowed, bearer_of, may_open_demonstration
from sequence_planner.server.dependencies import (
    JSON_ONLY,
    Actor,
    Address,
    Agent,
    AnswerModel,
    Body,
    Controller,
    Identity,
    Name,
    Session,
)
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.credentials import (
    Credentials,
    credentials,
    flow_token,
    forget_flow,
    forget_session,
    keep_flow,
    keep_session,
)
from sequence_planner.server.interface import interface
from sequence_planner.server.services.identity import IdentityService, withdraw_control
from sequence_planner.server.settings import Settings
from sequence_planner.texts.message import message
from sequence_planner.version import VERSION

if TYPE_CHECKING:
    from sequence_planner.auth.oidc.sign_in import ProviderSignIn

# Who a browser is for this server: what it is told, and how it is given another session.


class SessionPerson(AnswerModel):
    """The signed-in person; `issuer` is the provider that vouches for them: they have no password here then."""

    id: str
    name: str
    role: Role
    issuer: str | None


class SessionProvider(AnswerModel):
    """The provider with which people may sign in too.

    `sign_out` is where one signs out of it as well; null where that is not known.
    """

    title: str
    sign_out: str | None


class SessionWatch(AnswerModel):
    """The watch that this device is, apart from who is signed in."""

    id: str
    name: str
    resource: str
    state: WatchState


class SessionAnswer(AnswerModel):
    """Who the browser is for this server.

    `first-start`: nobody is signed in, and there is no administrator yet, but perhaps somebody else who may sign in
    (`people`, which is true in all other states). `session` is the id that holds control where
    this session does; `expires` is when it ends at the latest, in seconds since the epoch. `demonstration` says that
    one may be opened here. `station` is the station's title by language (`""`: the same in all), so that people see
    where they sign in; null while that is not known. The `version` of the program is for those who are signed in.
    """

    state: Literal["signed-out", "signed-in", "first-start"]
    people: bool
    station: dict[str, str] | None
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
    office: IdentityService = request.app.state.identity
    await office.note_session(signed_in, credentials(request).session)
    keep_session(response, request.app.state.settings, token)
    return await answered(request, signed_in)


async def answered(request: Request, signed_in: SignedIn | None) -> SessionAnswer:
    """Return what the browser is told where `signed_in` is its session."""
    state = request.app.state
    watch = (await bearer_of(request, Credentials(watch=credentials(request).watch))).watch
    answer = SessionAnswer(
        state="signed-out",
        people=True,
        station=None if state.controller.view is None else state.controller.view.station.titles,
        person=None,
        session=None,
        kind=None,
        must_change_password=False,
        expires=None,
        demonstration=may_open_demonstration(request, state.settings, state.controller),
        watch=None if watch is None else SessionWatch.model_validate(watch, from_attributes=True),
        provider=_provider_answer(request),
        version=None,
    )
    if signed_in is not None:
        return answer.model_copy(update=_said_of(signed_in))
    office: IdentityService = state.identity
    if await office.read(users.administrator_exists):
        return answer
    return answer.model_copy(update={"state": "first-start", "people": await office.read(users.anybody_exists)})


def _provider_answer(request: Request) -> SessionProvider | None:
    """The provider; where it signs people out is told once it was asked about itself."""
    office: IdentityService = request.app.state.identity
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


# Signing in with a provider of OpenID Connect.
#
# The page asks where to send the browser, and brings back what the provider said: as JSON from a page of this server,
# so that nothing which changes something is a link that others can give, and every refusal is a problem in words. The
# browser keeps a token for the sign-in that it has begun; without it the answer is not taken.

BACK = "/sign-in/provider"  # the page to which the provider sends the browser back
HOME = "/"
LONGEST_PAGE = 2000  # characters

provider_router = interface("/session/provider", tags=["session"], dependencies=[allowed(None), JSON_ONLY])


def own_page(text: str) -> str:
    """A page of this server: a path and what follows it. Raises ValueError for what a browser may take elsewhere."""
    if "//" in text.partition("?")[0].partition("#")[0]:  # `/.//name` is `//name` once its dots are taken out
        raise ValueError("a page of this server is a path without //")
    return text


# Browsers read a backslash as a slash, and drop what does not show.
PLAIN = r"^/([!-.0-\[\]-~][!-\[\]-~]*)?$"
Page = Annotated[str, Field(max_length=LONGEST_PAGE, pattern=PLAIN), AfterValidator(own_page)]
Brought = Annotated[str, Field(min_length=1, max_length=LONGEST_PAGE)]
Code = Annotated[str, Field(pattern=r"^[a-z_]{1,60}$")]


class BeginBody(Body):
    """The page of this server that is opened in the end."""

    to: Page = HOME


class BegunAnswer(AnswerModel):
    """Address for the browser to go to."""

    location: str


class ProviderAnswerBody(Body):
    """Answer of the provider, by the browser: `state` and either a `code` or an `error`; `iss` is the provider."""

    state: Brought
    code: Brought | None = None
    error: Code | None = None
    iss: Brought | None = None


class ProviderSessionAnswer(AnswerModel):
    """The session that was opened, and the page of this server to go to."""

    session: SessionAnswer
    to: str


@provider_router.post("", responses=refused(404, 429, 503))
async def begin_sign_in(
    body: BeginBody, request: Request, response: Response, identity: Identity, address: Address
) -> BegunAnswer:
    """Begin to sign in with the provider, which has ten minutes to answer.

    404 `no-provider` where the station has none, 503 `provider-unavailable` while it is away.
    """
    back, settings = _back(request), request.app.state.settings
    token, location = await _provider(identity).begin(body.to, back, now=identity.now(), address=address)
    keep_flow(response, settings, token, int(FLOW_LIFE))
    return BegunAnswer(location=location)


@provider_router.post("/answer", responses=refused(404, 503))
async def finish_sign_in(
    body: ProviderAnswerBody, request: Request, response: Response, identity: Identity, address: Address, agent: Agent
) -> ProviderSessionAnswer:
    """Finish what this browser has begun; the session that it had ends.

    403 `sign-in-not-begun` where it has begun none, `provider-refused`, `provider-answer-invalid`, `no-role` or
    `disabled`; 503 `provider-unavailable`.
    """
    token, signed_in, page = await _provider(identity).finish(
        flow_token(request),
        ProviderAnswer(state=body.state, code=body.code, error=body.error, issuer=body.iss),
        _back(request),
        now=identity.now(),
        address=address,
        agent=agent,
        before=credentials(request).session,
    )
    forget_flow(response, request.app.state.settings)
    return ProviderSessionAnswer(session=await begin_session(request, response, token, signed_in), to=page)


def _provider(office: IdentityService) -> ProviderSignIn:
    if office.provider is None:
        raise ProblemFound(404, "no-provider", message("refused.no-provider.password"))
    return office.provider


def _back(request: Request) -> str:
    """Return where the provider sends the browser back to, by the name by which the station was opened."""
    settings: Settings = request.app.state.settings
    return f"{settings.scheme}://{request.headers['host'].lower()}{BACK}"


# Signing in and out: sessions of people and of demonstrations, their own password, and the first administrator.
#
# A session begins with a token that was drawn for it and travels in a cookie that no script can read. Whatever cookie a
# browser had before is never taken over: its session ends.

EVERYBODY = allowed(None)
ONESELF = allowed(Role.VIEWER, unready=True)
LONGEST = 1000  # characters of what somebody typed; what may be a password is a matter of `check_password`

session_router = interface(tags=["session"])
Typed = Annotated[str, Field(min_length=1, max_length=LONGEST)]


class SignInBody(Body):
    """Credentials of a person who signs in."""

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


@session_router.get("/session", dependencies=[EVERYBODY], responses=refused(503))
async def session(request: Request) -> SessionAnswer:
    """The signed-in person, if any."""
    shown = credentials(request)
    bearer = await bearer_of(request, Credentials(session=shown.session))
    return await answered(request, bearer.signed_in)


@session_router.post("/session", dependencies=[EVERYBODY, JSON_ONLY], responses=refused(401, 429, 503))
async def sign_in(
    body: SignInBody, request: Request, response: Response, identity: Identity, address: Address, agent: Agent
) -> SessionAnswer:
    """Sign in; the session that the browser had ends. 401 whatever was wrong, 429 after too many attempts."""
    before = credentials(request).session
    token, signed_in = await identity.sign_in.sign_in(
        body.name, body.password, now=identity.now(), address=address, agent=agent, before=before
    )
    return await begin_session(request, response, token, signed_in)


@session_router.post("/session/demonstration", dependencies=[EVERYBODY, JSON_ONLY], responses=refused(503))
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
        raise ProblemFound(403, "no-demonstration", message("refused.no-demonstration.emulated"))
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


@session_router.delete("/session", status_code=204, dependencies=[ONESELF])
async def sign_out(
    request: Request, response: Response, identity: Identity, client: Controller, actor: Actor, signed_in: Session
) -> None:
    """Sign out; control that the session has is given up."""
    now = identity.now()
    await identity.write(lambda connection: sessions.end_session(connection, signed_in.session, actor, now))
    forget_session(response, request.app.state.settings)
    with contextlib.suppress(CommandRefused):  # the sweeper tries again
        await withdraw_control(client, signed_in.session)


@session_router.put("/session/password", dependencies=[ONESELF, JSON_ONLY], responses=refused(429))
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


@session_router.post("/setup", status_code=201, dependencies=[EVERYBODY, JSON_ONLY], responses=refused(409, 503))
async def set_up(
    body: FirstAdministratorBody,
    request: Request,
    response: Response,
    identity: Identity,
    address: Address,
    agent: Agent,
) -> SessionAnswer:
    """Make the first administrator with the link of the first start, which works once and for 15 minutes.

    403 `setup-link-invalid` when it does not.
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
