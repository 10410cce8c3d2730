"""Corrections of what the station believes, and what a person decides about outputs that came back.

Each endpoint makes one command with its actor and waits for the controller's word. 204 means that it was done; a
refusal is a problem whose `type` ends in the controller's own slug. What is possible when: `docs/restart.md`.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, StrictInt

from sequence_planner.control.asks import AskCorrection
from sequence_planner.control.correction_view import CorrectionPreview
from sequence_planner.control.restart_commands import (
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    GivenValues,
    UndoCorrection,
    Why,
)
from sequence_planner.identity.roles import Role
from sequence_planner.web.access import allowed
from sequence_planner.web.actions import LARGEST_REVISION
from sequence_planner.web.body import Body
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)

router = interface(tags=["corrections"], dependencies=[JSON_ONLY, OPERATOR], responses=refused(404, 409, 422, 504))


class ValuesBody(Body):
    """Estimated variables, each with the value that it is to have."""

    values: GivenValues


class CorrectionBody(Body):
    """The values, the revision of the state that the person saw, and why."""

    values: GivenValues
    revision: Annotated[StrictInt, Field(ge=0, le=LARGEST_REVISION)]
    reason: Why


class UndoBody(Body):
    """The revision on which the correction was made that is to be taken back, and why."""

    revision: Annotated[StrictInt, Field(ge=0, le=LARGEST_REVISION)]
    reason: Why


class DecisionBody(Body):
    """Variables with their values, and why."""

    values: GivenValues
    reason: Why


@router.post("/corrections/preview")
async def preview_correction(body: ValuesBody, client: Controller) -> CorrectionPreview:
    """What a correction would bring about: what it would violate, which abilities could start, the plan that follows.

    Nothing is changed by asking, and it may be asked in every mode.
    """
    return await client.ask(AskCorrection(values=body.values))


@router.post("/corrections", status_code=204)
async def correct(body: CorrectionBody, client: Controller, actor: Actor) -> None:
    """Give estimates other values, all at once: in restart mode, or before production is started. It takes control.

    409 `state-moved` when the state is not at this revision any more; nothing has changed then.
    """
    await client.send(CorrectEstimates(actor=actor, values=body.values, revision=body.revision, reason=body.reason))


@router.post("/corrections/undo", status_code=204)
async def undo_correction(body: UndoBody, client: Controller, actor: Actor) -> None:
    """Take the last correction back, as long as its variables have the values that it gave them. It takes control.

    409 `state-moved` when they have others, or when the last correction was made on another revision.
    """
    await client.send(UndoCorrection(actor=actor, revision=body.revision, reason=body.reason))


@router.post("/corrections/confirm", status_code=204)
async def confirm_correction(body: DecisionBody, client: Controller, actor: Actor) -> None:
    """Say that these estimates are as the station believes; 409 `state-moved` when one is another by now."""
    await client.send(ConfirmEstimates(actor=actor, values=body.values, reason=body.reason))


@router.put("/outputs", status_code=204)
async def decide_outputs(body: DecisionBody, client: Controller, actor: Actor) -> None:
    """Decide on outputs that came back from the journal and would move devices; before production. It takes control."""
    await client.send(DecideOutputs(actor=actor, values=body.values, reason=body.reason))
