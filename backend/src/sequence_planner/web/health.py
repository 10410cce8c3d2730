"""Whether the server is alive. It answers for itself: a lost controller is told, but the server is still healthy."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter
from pydantic import BaseModel

from sequence_planner.web.access import allowed
from sequence_planner.web.request_parts import Controller
from sequence_planner.web.stream_messages import ControllerState

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """The server answers, so it is alive; `controller` says whether a view came within two seconds."""

    status: Literal["alive"]
    controller: ControllerState


@router.get("/healthz", dependencies=[allowed(None)])
async def healthz(client: Controller) -> Health:
    """Alive, and whether the controller is heard."""
    return Health(status="alive", controller=ControllerState.HEARD if client.heard else ControllerState.LOST)
