"""What an endpoint asks for by declaring it: the live view, the way to the controller, who acts.

Each is a FastAPI dependency, so that a rule such as "never an old view" or "JSON only" stands in one place and every
endpoint that names it obeys it.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from sequence_planner.control.view import StationView
from sequence_planner.web.controller_client import ControllerClient
from sequence_planner.web.problems import ProblemFound


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


async def actor() -> str:
    """Who acts: always `local` until there is sign-in."""
    return "local"


Actor = Annotated[str, Depends(actor)]


async def json_only(request: Request) -> None:
    """Refuse any body but JSON: a form, which any page may post across sites, is never read."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json":
        detail = "Send the body as JSON, with the header Content-Type: application/json."
        raise ProblemFound(415, "not-json", "The body is not declared as JSON", detail)


JSON_ONLY = Depends(json_only)
