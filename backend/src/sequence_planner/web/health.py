"""Whether the station is alive, for whoever would start it again, and whether it is ready, for whoever would use it.

Both are told to everybody: 200, or 503 with the reasons, which say nothing that is secret.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from fastapi import Request, Response
from pydantic import BaseModel, JsonValue

from sequence_planner.version import VERSION
from sequence_planner.web.access import allowed
from sequence_planner.web.interface import beside_interface
from sequence_planner.web.liveness import WayToDatabase
from sequence_planner.web.problems import problem_response, refused
from sequence_planner.web.readiness import SILENT, Readiness, ReadinessCheck
from sequence_planner.web.request_parts import Controller, Identity
from sequence_planner.web.stream_messages import ControllerState

SHUT = "The server's connections to the database are stuck, and a new one is not. Start the station again."

router = beside_interface(tags=["health"], dependencies=[allowed(None)])


class Health(BaseModel):
    """The server answers, and a view of the controller came within two seconds."""

    status: Literal["alive"]
    controller: Literal[ControllerState.HEARD]
    version: str


class Ready(BaseModel):
    """All of these checks were passed."""

    status: Literal["ready"]
    checks: list[ReadinessCheck]


@router.get("/healthz", response_model=Health, responses=refused(503))
async def healthz(request: Request, client: Controller, identity: Identity) -> Health | Response:
    """Alive: the server answers, its controller is heard, and nothing is wrong that would be right after a restart.

    Else 503 `not-alive`, with `reasons` by name.
    """
    way: WayToDatabase = request.app.state.way_to_database
    is_shut = way.is_shut(identity)
    if client.heard and not is_shut:
        return Health(status="alive", controller=ControllerState.HEARD, version=VERSION)
    reasons = {} if client.heard else {ReadinessCheck.CONTROLLER: SILENT}
    reasons |= {ReadinessCheck.DATABASE: SHUT} if is_shut else {}
    more = {"controller": (ControllerState.HEARD if client.heard else ControllerState.LOST).value}
    return _refusal("not-alive", "The station is not well", reasons, more)


@router.get("/readyz", response_model=Ready, responses=refused(503))
async def readyz(request: Request, identity: Identity) -> Ready | Response:
    """Ready to work: prepared, with a journal that keeps up, a database that can be written to, and views of now.

    Else 503 `not-ready`, with `reasons` by the name of each check that fails.
    """
    readiness: Readiness = request.app.state.readiness
    failing = await readiness.failing(identity.database)
    if not failing:
        return Ready(status="ready", checks=list(ReadinessCheck))
    return _refusal("not-ready", "The station is not ready", failing, {})


def _refusal(slug: str, title: str, reasons: Mapping[ReadinessCheck, str], more: Mapping[str, str]) -> Response:
    named: dict[str, JsonValue] = {check.value: why for check, why in reasons.items()}
    detail = " ".join(dict.fromkeys(reasons.values()))
    return problem_response(503, slug, title, detail, more={"reasons": named, **more})
