"""FastAPI dependencies and shared types of routes: controller, actor, bodies, pass-through responses."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated, Any

from fastapi import Depends, Path, Request, Response
from fastapi.responses import StreamingResponse
from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.auth.sessions import SignedIn
from sequence_planner.auth.tokens import LONGEST_NAME, clean_name
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.actor import Actor as Acting
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.server.auth import address_of
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.texts.message import message

# What requests have in common: bodies with nothing undeclared, names that people give, identifiers.


class Body(BaseModel):
    """Base of all bodies: nothing beside what is declared."""

    model_config = ConfigDict(extra="forbid")


class AnswerModel(BaseModel):
    """Base of answers. What reads and writes one is built when it is first needed, as most are needed seldom."""

    model_config = ConfigDict(defer_build=True)


class NothingBody(Body):
    """Nothing more is to be said."""


def _name(text: str) -> str:
    try:
        return clean_name(text)
    except IdentityRefused as refused:
        raise ValueError(refused.detail) from None


Name = Annotated[str, Field(min_length=1, max_length=LONGEST_NAME), AfterValidator(_name)]
Reason = Annotated[str | None, Field(max_length=LONGEST_REASON)]
Identifier = Annotated[str, Path(max_length=200)]


# What an endpoint asks for by declaring it: the live view, the way to the controller, who acts.
#
# Each is a FastAPI dependency, so that a rule such as "never an old view" or "JSON only" stands in one place and every
# endpoint that names it obeys it.

LONGEST_AGENT = 200  # characters


async def controller(request: Request) -> ControllerClient:
    """The connection to the controller."""
    client: ControllerClient = request.app.state.controller
    return client


Controller = Annotated[ControllerClient, Depends(controller)]


async def live_view(client: Controller) -> StationView:
    """The view, if it is not older than two seconds; else the request is answered with 503."""
    if client.view is None or not client.heard:
        raise ProblemFound(503, "controller-unavailable", message("refused.controller-unavailable.silent"))
    return client.view


LiveView = Annotated[StationView, Depends(live_view)]


async def actor(request: Request) -> Acting:
    """Return who acts, as `access.allowed` has found out; a public route has nobody."""
    found: Acting = request.state.actor
    return found


Actor = Annotated[Acting, Depends(actor)]


async def signed_in(request: Request) -> SignedIn:
    """The session that acts, on a route that is for people alone."""
    found: SignedIn = request.state.signed_in
    return found


Session = Annotated[SignedIn, Depends(signed_in)]


async def identity(request: Request) -> IdentityService:
    """The way to people, sessions, watches and keys."""
    office: IdentityService = request.app.state.identity
    return office


Identity = Annotated[IdentityService, Depends(identity)]


async def address(request: Request) -> str:
    """The address of the other end, as far as it can be believed."""
    return address_of(request)


Address = Annotated[str, Depends(address)]


async def agent(request: Request) -> str:
    """Return what the other end calls itself: `User-Agent`, cut at 200 characters."""
    return request.headers.get("user-agent", "")[:LONGEST_AGENT]


Agent = Annotated[str, Depends(agent)]


async def json_only(request: Request) -> None:
    """Refuse any body but JSON: a form, which any page may post across sites, is never read."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json":
        raise ProblemFound(415, "not-json", message("refused.not-json.header"))


JSON_ONLY = Depends(json_only)


# What another process has found, and bodies for it: both pass through the server as they are.
#
# To read a large document, or to write one, would keep everybody waiting who asks for something else, a stop for one.

JSON = "application/json"
PIECE = 64 * 1024  # bytes that are written, and compressed, in one go


def found(text: str) -> Response:
    """The answer that consists of this JSON."""
    content = text.encode()
    if len(content) <= PIECE:
        return Response(content, media_type=JSON)
    return StreamingResponse(_pieces(content), media_type=JSON)


async def _pieces(content: bytes) -> AsyncIterator[bytes]:
    for start in range(0, len(content), PIECE):
        yield content[start : start + PIECE]
        await asyncio.sleep(0)  # others come between


async def _unread_body(request: Request) -> bytes:
    await json_only(request)
    return await request.body()


UnreadBody = Annotated[bytes, Depends(_unread_body)]


def takes(model: type[BaseModel]) -> dict[str, Any]:
    """Return what `openapi_extra` of a route says whose `UnreadBody` is a `model`, which `openapi_document` must
    know.
    """
    schema = {"$ref": f"#/components/schemas/{model.__name__}"}
    return {"requestBody": {"required": True, "content": {JSON: {"schema": schema}}}}
