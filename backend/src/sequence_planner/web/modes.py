"""How the station executes: its mode and restart mode, production, steps, what is in service, and forces.

Each endpoint makes one command with its actor and waits for the controller's word. 204 means that it was done, 200
that it was done and is not in the journal yet; a
refusal is a problem whose `type` ends in the controller's own slug. Which act is possible when: `docs/control.md`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import Path, Response
from pydantic import Field, StrictBool

from sequence_planner.control.job_commands import SetByOrder
from sequence_planner.control.production_commands import (
    EnterRestart,
    LeaveRestart,
    SetMode,
    SetService,
    SetStepping,
    StartProduction,
    TakeStep,
)
from sequence_planner.control.restart_commands import ForceVariable, GivenValue, ReleaseForce, Why
from sequence_planner.control.vocabulary import Mode, ServiceKind
from sequence_planner.identity.roles import Role
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.carried_out import CARRIED_OUT, carried_out
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)
LONGEST_FORCE = 3600.0  # seconds

router = interface(tags=["modes"], dependencies=[JSON_ONLY], responses=refused(409, 504))
bodiless = interface(tags=["modes"], responses=refused(409, 504))
Named = Annotated[str, Path(max_length=400)]
# By their words: of members of an enumeration a wrong request would be shown Python's way to write them.
ModeWord = Literal["automatic", "paused", "hold"]
_MODES: dict[ModeWord, Literal[Mode.AUTOMATIC, Mode.PAUSED, Mode.HOLD]] = {
    "automatic": Mode.AUTOMATIC,
    "paused": Mode.PAUSED,
    "hold": Mode.HOLD,
}


class ModeBody(Body):
    """The mode that is wanted. Restart mode has ways of its own, in and out."""

    mode: ModeWord
    reason: Reason = None


class ReasonBody(Body):
    """To ask for it is all that there is to say, but perhaps why."""

    reason: Reason = None


class SteppingBody(Body):
    """Whether every start is to wait for a step."""

    on: StrictBool
    reason: Reason = None


class ByOrderBody(Body):
    """Whether the station is to work by order, and why."""

    on: StrictBool
    reason: Why


class ServiceBody(Body):
    """Whether it is to be in service, and why."""

    in_service: StrictBool
    reason: Why


class ForceBody(Body):
    """The value that the variable is to have, for how many seconds, and why."""

    value: GivenValue
    seconds: Annotated[float, Field(gt=0, le=LONGEST_FORCE, strict=True)]
    reason: Why


@router.put("/mode", status_code=204, dependencies=[OPERATOR], responses=CARRIED_OUT)
async def set_mode(body: ModeBody, client: Controller, actor: Actor) -> Response:
    """Change the mode of execution. To go on takes control; to pause and to hold is for anybody, and never refused.

    200 says that the station is stopped and the journal does not have it yet; 503 `stop-not-kept` that it is stopped
    and nowhere written down.
    """
    return carried_out(await client.send(SetMode(actor=actor, mode=_MODES[body.mode], reason=body.reason)))


@router.post("/production/start", status_code=204, dependencies=[OPERATOR])
async def start_production(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Allow outputs to be published; nothing else implies it. It takes control."""
    await client.send(StartProduction(actor=actor, reason=body.reason))


@router.post("/restart/enter", status_code=204, dependencies=[OPERATOR])
async def enter_restart(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Enter restart mode: operations wait, what runs may finish, and nothing is started by it. It takes control."""
    await client.send(EnterRestart(actor=actor, reason=body.reason))


@router.post("/restart/leave", status_code=204, dependencies=[OPERATOR])
async def leave_restart(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Leave restart mode for the paused one; to go on is another request. It takes control."""
    await client.send(LeaveRestart(actor=actor, reason=body.reason))


@router.put("/stepping", status_code=204, dependencies=[ENGINEER])
async def set_stepping(body: SteppingBody, client: Controller, actor: Actor) -> None:
    """For commissioning: have every single start wait for a person's step, or none. It takes control."""
    await client.send(SetStepping(actor=actor, on=body.on, reason=body.reason))


@router.post("/stepping/step", status_code=204, dependencies=[ENGINEER])
async def take_step(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Allow one start, as soon as there is one. It takes control."""
    await client.send(TakeStep(actor=actor, reason=body.reason))


@router.put("/work-by-order", status_code=204, dependencies=[OPERATOR])
async def set_by_order(body: ByOrderBody, client: Controller, actor: Actor) -> None:
    """Let operations of work masters be active for job orders only, or whenever they can be. It takes control."""
    await client.send(SetByOrder(actor=actor, on=body.on, reason=body.reason))


@router.put("/service/{of}/{name}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def set_service(of: ServiceKind, name: Named, body: ServiceBody, client: Controller, actor: Actor) -> None:
    """Take a resource, an ability or an operation out of service, or put it back. It takes control."""
    command = SetService(actor=actor, of=of, name=name, in_service=body.in_service, reason=body.reason)
    await client.send(command)


@router.put("/forces/{name}", status_code=204, dependencies=[ENGINEER], responses=refused(404))
async def force(name: Named, body: ForceBody, client: Controller, actor: Actor) -> None:
    """Let a measured variable or an output have a value for a time, whatever its device or an ability says.

    It takes control. 422 `not-in-domain` says which values there are, and 409 `force-unsafe` that the value would lead
    out of the safe states; nothing has changed then.
    """
    command = ForceVariable(actor=actor, name=name, value=body.value, seconds=body.seconds, reason=body.reason)
    await client.send(command)


@bodiless.delete("/forces/{name}", status_code=204, dependencies=[ENGINEER], responses=refused(404))
async def release_force(name: Named, client: Controller, actor: Actor) -> None:
    """Let a variable be as it comes again, if it is forced. It takes control."""
    await client.send(ReleaseForce(actor=actor, name=name))
