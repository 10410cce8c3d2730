"""Control: one session at a time may start what moves. To take it from somebody is an act of its own, seen by all."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from sequence_planner.control.commands import ReleaseControl, TakeControl
from sequence_planner.identity.roles import Role
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)
router = interface("/control", tags=["control"], responses=refused(409, 504))


class ControlBody(Body):
    """The session from which control is taken over, null where nobody is in control as far as the person sees."""

    over: Annotated[str, Field(min_length=1, max_length=200)] | None
    reason: Reason = None


@router.put("", status_code=204, dependencies=[OPERATOR, JSON_ONLY])
async def take_control(body: ControlBody, client: Controller, actor: Actor) -> None:
    """Put this session in control; 409 `control-moved` when by now another is than the one that was seen."""
    await client.send(TakeControl(actor=actor, over=body.over, reason=body.reason))


@router.delete("", status_code=204, dependencies=[OPERATOR])
async def release_control(client: Controller, actor: Actor) -> None:
    """Give control up."""
    await client.send(ReleaseControl(actor=actor))
