"""What needs two people: one asks, in control; another, who has seen the same, approves or declines.

Each endpoint makes one command with its actor and waits for the controller's word. Who waits and how it ended is in the
station's `approvals`.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Path
from pydantic import Field, StrictInt

from sequence_planner.control.approval_commands import (
    Act,
    ApproveRequest,
    CorrectionAct,
    DeclineRequest,
    ForceAct,
    OutputsAct,
    RequestApproval,
)
from sequence_planner.control.restart_commands import Why
from sequence_planner.identity.roles import Role
from sequence_planner.web.access import allowed
from sequence_planner.web.actions import LARGEST_REVISION
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)
Revision = Annotated[StrictInt, Field(ge=0, le=LARGEST_REVISION)]
Named = Annotated[str, Path(min_length=1, max_length=40)]

router = interface("/approvals", tags=["approvals"], dependencies=[JSON_ONLY], responses=refused(404, 409, 422, 504))


class CorrectionRequestBody(Body):
    """A correction, the revision of the state in which its preview was looked at, and why."""

    act: CorrectionAct
    revision: Revision
    reason: Why


class OutputsRequestBody(Body):
    """A decision on outputs that came back, the revision of the state that was seen, and why."""

    act: OutputsAct
    revision: Revision
    reason: Why


class ForceRequestBody(Body):
    """A force, the revision of the state that was seen, and why."""

    act: ForceAct
    revision: Revision
    reason: Why


class ApprovalBody(Body):
    """What the second person has looked at and wants too, and the revision of the state in which that was."""

    act: Act
    revision: Revision
    reason: Reason = None


class RefusalBody(Body):
    """What is declined or withdrawn."""

    act: Act
    reason: Reason = None


@router.post("/corrections", status_code=204, dependencies=[OPERATOR])
async def ask_for_correction(body: CorrectionRequestBody, client: Controller, actor: Actor) -> None:
    """Ask a second person to approve a correction, within two minutes and in this state. It takes control.

    409 `no-approval-needed` where none of its variables asks for that.
    """
    await client.send(RequestApproval(actor=actor, act=body.act, revision=body.revision, reason=body.reason))


@router.post("/outputs", status_code=204, dependencies=[OPERATOR])
async def ask_for_outputs(body: OutputsRequestBody, client: Controller, actor: Actor) -> None:
    """Ask a second person to approve a decision on outputs, as a correction."""
    await client.send(RequestApproval(actor=actor, act=body.act, revision=body.revision, reason=body.reason))


@router.post("/forces", status_code=204, dependencies=[ENGINEER])
async def ask_for_force(body: ForceRequestBody, client: Controller, actor: Actor) -> None:
    """Ask a second person to approve a force, as a correction."""
    await client.send(RequestApproval(actor=actor, act=body.act, revision=body.revision, reason=body.reason))


@router.post("/{request}/approve", status_code=204, dependencies=[OPERATOR])
async def approve_request(request: Named, body: ApprovalBody, client: Controller, actor: Actor) -> None:
    """Approve what another person has asked for: it is done at once, in the names of both.

    403 `same-person` for who has asked, 409 `request-gone` when it was answered, overtaken or took too long.
    """
    command = ApproveRequest(actor=actor, request=request, act=body.act, revision=body.revision, reason=body.reason)
    await client.send(command)


@router.post("/{request}/decline", status_code=204, dependencies=[OPERATOR])
async def decline_request(request: Named, body: RefusalBody, client: Controller, actor: Actor) -> None:
    """Decline what another person has asked for, or withdraw what one has asked for oneself."""
    await client.send(DeclineRequest(actor=actor, request=request, act=body.act, reason=body.reason))
