"""What a person may do: change the mode, start production, acknowledge a task, set an override.

Each endpoint makes one command with its actor and waits for the controller's word. 204 means that it was done; a
refusal is a problem whose `type` ends in the controller's own slug.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path
from pydantic import BaseModel, ConfigDict, Field, StrictInt

from sequence_planner.control.commands import AcknowledgeTask, ClearOverride, SetMode, SetOverride, StartProduction
from sequence_planner.control.override_view import FieldValue
from sequence_planner.control.view import Mode
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

LARGEST_REVISION = 2**53 - 1  # the largest whole number that every JSON reader keeps

router = APIRouter(tags=["actions"], dependencies=[JSON_ONLY])
bodiless = APIRouter(tags=["actions"])
Name = Annotated[str, Path(max_length=200)]


class Body(BaseModel):
    """Base of all bodies: nothing beside what is declared."""

    model_config = ConfigDict(extra="forbid")


class ModeBody(Body):
    """The mode that is wanted."""

    mode: Mode


class StartBody(Body):
    """Nothing: to start production is all that there is to say."""


class AcknowledgementBody(Body):
    """The revision of the task that the person saw, so that no other is acknowledged by mistake."""

    revision: Annotated[StrictInt, Field(ge=0, le=LARGEST_REVISION)]


class OverrideBody(Body):
    """The values of the fields that are to be set; others are as they come."""

    fields: Annotated[dict[str, FieldValue], Field(min_length=1, max_length=100)]


@router.put("/mode", status_code=204)
async def set_mode(body: ModeBody, client: Controller, actor: Actor) -> None:
    """Change the mode of execution."""
    await client.send(SetMode(actor=actor, mode=body.mode))


@router.post("/production/start", status_code=204)
async def start_production(body: StartBody, client: Controller, actor: Actor) -> None:
    """Allow outputs to be published; nothing else implies it."""
    await client.send(StartProduction(actor=actor))


@router.post("/tasks/{task}/acknowledgement", status_code=204)
async def acknowledge(
    task: Annotated[str, Path(max_length=200)], body: AcknowledgementBody, client: Controller, actor: Actor
) -> None:
    """Say that a task is done; refused when the task or its revision is gone."""
    await client.send(AcknowledgeTask(actor=actor, task=task, revision=body.revision))


@router.put("/overrides/{name}", status_code=204)
async def set_override(name: Name, body: OverrideBody, client: Controller, actor: Actor) -> None:
    """Set fields of an override, such as `ur10.speed`, within the bounds of the model; they expire as it says.

    422 `out-of-bounds` names the field and what is allowed; nothing has changed then.
    """
    await client.send(SetOverride(actor=actor, name=name, fields=body.fields))


@bodiless.delete("/overrides/{name}", status_code=204)
async def clear_override(name: Name, client: Controller, actor: Actor) -> None:
    """Take back what is set, if anything is."""
    await client.send(ClearOverride(actor=actor, name=name))
