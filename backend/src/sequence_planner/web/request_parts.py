"""What an endpoint asks for by declaring it: the live view, the way to the controller, who acts.

Each is a FastAPI dependency, so that a rule such as "never an old view" or "JSON only" stands in one place and every
endpoint that names it obeys it.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from sequence_planner.actor import Actor as Acting
from sequence_planner.control.view import StationView
from sequence_planner.identity.sessions import SignedIn
from sequence_planner.web.access import address_of
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.identity import IdentityOffice
from sequence_planner.web.problems import ProblemFound

LONGEST_AGENT = 200  # characters


async def controller(request: Request) -> ControllerClient:
    """The connection to the controller."""
    client: ControllerClient = request.app.state.controller
    return client


Controller = Annotated[ControllerClient, Depends(controller)]


async def live_view(client: Controller) -> StationView:
    """The view, if it is not older than two seconds; else the request is answered with 503."""
    if client.view is None or not client.heard:
        detail = "The controller is silent, so nothing is known of the station now. Try again."
        raise ProblemFound(503, "controller-unavailable", "The controller is not heard", detail)
    return client.view


LiveView = Annotated[StationView, Depends(live_view)]


async def actor(request: Request) -> Acting:
    """Who acts, as `access.allowed` has found out; a public route has nobody."""
    found: Acting = request.state.actor
    return found


Actor = Annotated[Acting, Depends(actor)]


async def signed_in(request: Request) -> SignedIn:
    """The session that acts, on a route that is for people alone."""
    found: SignedIn = request.state.signed_in
    return found


Session = Annotated[SignedIn, Depends(signed_in)]


async def identity(request: Request) -> IdentityOffice:
    """The way to people, sessions, watches and keys."""
    office: IdentityOffice = request.app.state.identity
    return office


Identity = Annotated[IdentityOffice, Depends(identity)]


async def address(request: Request) -> str:
    """The address of the other end, as far as it can be believed."""
    return address_of(request)


Address = Annotated[str, Depends(address)]


async def agent(request: Request) -> str:
    """What the other end calls itself: `User-Agent`, cut at 200 characters."""
    return request.headers.get("user-agent", "")[:LONGEST_AGENT]


Agent = Annotated[str, Depends(agent)]


async def json_only(request: Request) -> None:
    """Refuse any body but JSON: a form, which any page may post across sites, is never read."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json":
        detail = "Send the body as JSON, with the header Content-Type: application/json."
        raise ProblemFound(415, "not-json", "The body is not declared as JSON", detail)


JSON_ONLY = Depends(json_only)
