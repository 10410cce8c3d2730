"""Signing in with a provider of OpenID Connect.

The page asks where to send the browser, and brings back what the provider said: as JSON from a page of this server, so
that nothing which changes something is a link that others can give, and every refusal is a problem in words. The
browser keeps a token for the sign-in that it has begun; without it the answer is not taken.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from fastapi import Request, Response
from pydantic import AfterValidator, BaseModel, Field

from sequence_planner.identity.openid.flow import FLOW_LIFE, Answer
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body
from sequence_planner.web.cookies import credentials, flow_token, forget_flow, keep_flow
from sequence_planner.web.identity import IdentityOffice
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Address, Agent, Identity
from sequence_planner.web.session_answer import SessionAnswer, begin_session
from sequence_planner.web.settings import Settings

if TYPE_CHECKING:  # most stations have no provider, and what speaks to one takes a while to import
    from sequence_planner.identity.provider_sign_in import ProviderSignIn

BACK = "/sign-in/provider"  # the page to which the provider sends the browser back
HOME = "/"
LONGEST_PAGE = 2000  # characters

router = interface("/session/provider", tags=["session"], dependencies=[allowed(None), JSON_ONLY])


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


class BegunAnswer(BaseModel):
    """Where the browser is to go."""

    location: str


class ProviderAnswerBody(Body):
    """What the provider has sent back with the browser: `state` and either a `code` or an `error`; `iss` is itself."""

    state: Brought
    code: Brought | None = None
    error: Code | None = None
    iss: Brought | None = None


class ProviderSessionAnswer(BaseModel):
    """The session that was opened, and the page of this server to go to."""

    session: SessionAnswer
    to: str


@router.post("", responses=refused(404, 429, 503))
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


@router.post("/answer", responses=refused(404, 503))
async def finish_sign_in(
    body: ProviderAnswerBody, request: Request, response: Response, identity: Identity, address: Address, agent: Agent
) -> ProviderSessionAnswer:
    """Finish what this browser has begun; the session that it had ends.

    403 `sign-in-not-begun` where it has begun none, `provider-refused`, `provider-answer-unfit`, `no-role` or
    `disabled`; 503 `provider-unavailable`.
    """
    token, signed_in, page = await _provider(identity).finish(
        flow_token(request),
        Answer(state=body.state, code=body.code, error=body.error, issuer=body.iss),
        _back(request),
        now=identity.now(),
        address=address,
        agent=agent,
        before=credentials(request).session,
    )
    forget_flow(response, request.app.state.settings)
    return ProviderSessionAnswer(session=await begin_session(request, response, token, signed_in), to=page)


def _provider(office: IdentityOffice) -> ProviderSignIn:
    if office.provider is None:
        detail = "This station has no provider: sign in with a name and a password."
        raise ProblemFound(404, "no-provider", "There is no provider", detail)
    return office.provider


def _back(request: Request) -> str:
    """Where the provider sends the browser back to, by the name by which the station was opened."""
    settings: Settings = request.app.state.settings
    return f"{settings.scheme}://{request.headers['host'].lower()}{BACK}"
