"""What a person may do for the work at hand: acknowledge a task or say what is wrong with it, set an override.

Each endpoint makes one command with its actor and waits for the controller's word. 204 means that it was done; a
refusal is a problem whose `type` ends in the controller's own slug. A body may say why, which is recorded.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Request
from pydantic import Field, StrictInt

from sequence_planner.control.commands import ClearOverride, SetOverride
from sequence_planner.control.override_view import FieldValue
from sequence_planner.control.task_commands import AcknowledgeTask, ProblemKind, ReportProblem, SolveProblem
from sequence_planner.identity.roles import Role
from sequence_planner.identity.watches import Watch
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import ProblemFound, refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller, live_view

LARGEST_REVISION = 2**53 - 1  # the largest whole number that every JSON reader keeps
OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)

router = interface(tags=["actions"], dependencies=[JSON_ONLY], responses=refused(409, 504))
bodiless = interface(tags=["actions"], responses=refused(409, 504))
Name = Annotated[str, Path(max_length=200)]
DOER = allowed(Role.OPERATOR, watch=True)


class TaskBody(Body):
    """The revision of the task that the person saw, so that no other is meant by mistake."""

    revision: Annotated[StrictInt, Field(ge=0, le=LARGEST_REVISION)]


class AcknowledgementBody(TaskBody):
    """The task is done."""


class ProblemBody(TaskBody):
    """The task cannot be done as things are; `what` is in the way as far as one touch can say it, and the reason."""

    what: ProblemKind | None = None
    reason: Reason = None


class SolvedBody(TaskBody):
    """The task can be done after all."""


class OverrideBody(Body):
    """The values of the fields that are to be set; others are as they come."""

    fields: Annotated[dict[str, FieldValue], Field(min_length=1, max_length=100)]
    reason: Reason = None


@router.post("/tasks/{task}/acknowledgement", status_code=204, dependencies=[DOER])
async def acknowledge_task(
    task: Name, body: AcknowledgementBody, request: Request, client: Controller, actor: Actor
) -> None:
    """Say that a task is done; refused when the task or its revision is gone, or a watch is not for its resource."""
    await _check_own(request.state.watch, task, body.revision, client)
    await client.send(AcknowledgeTask(actor=actor, task=task, revision=body.revision))


@router.post("/tasks/{task}/problem", status_code=204, dependencies=[DOER])
async def report_problem(task: Name, body: ProblemBody, request: Request, client: Controller, actor: Actor) -> None:
    """Say that a task cannot be done as things are; refused as an acknowledgement is.

    It raises an alarm until the task is over or the problem solved, and changes nothing else. Said again, it is told
    with the last reason.
    """
    await _check_own(request.state.watch, task, body.revision, client)
    await client.send(ReportProblem(actor=actor, task=task, revision=body.revision, reason=body.reason, what=body.what))


@router.post("/tasks/{task}/problem/solved", status_code=204, dependencies=[DOER])
async def solve_problem(task: Name, body: SolvedBody, request: Request, client: Controller, actor: Actor) -> None:
    """Say that a task can be done after all; refused as an acknowledgement is."""
    await _check_own(request.state.watch, task, body.revision, client)
    await client.send(SolveProblem(actor=actor, task=task, revision=body.revision))


async def _check_own(watch: Watch | None, task: str, revision: int, client: Controller) -> None:
    """Refuse what is not asked of this watch now. A watch cannot fill the journal with what is refused."""
    if watch is None:
        return
    found = (await live_view(client)).tasks.get(task)
    if found is None:
        raise ProblemFound(409, "task-gone", "The task is gone", "Look at what is asked for now.")
    if found.resource != watch.resource:
        detail = f"{watch.name} is for the tasks of {watch.resource}, and this is none of them."
        raise ProblemFound(403, "not-your-task", "The task is somebody else's", detail)
    if found.revision != revision:
        raise ProblemFound(409, "task-changed", "The task has changed", "Look at what is asked for now.")


@router.put("/overrides/{name}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def set_override(name: Name, body: OverrideBody, client: Controller, actor: Actor) -> None:
    """Set fields of an override, such as `ur10.speed`, within the bounds of the model; they expire as it says.

    It takes control. 422 `out-of-bounds` names the field and what is allowed; nothing has changed then.
    """
    await client.send(SetOverride(actor=actor, name=name, fields=body.fields, reason=body.reason))


@bodiless.delete("/overrides/{name}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def clear_override(name: Name, client: Controller, actor: Actor) -> None:
    """Take back what is set, if anything is. It takes control."""
    await client.send(ClearOverride(actor=actor, name=name))
