"""Routes of operator commands: tasks, alarms, approvals, corrections, recovery plans, execution, forces."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import Path, Request, Response
from pydantic import Field, StrictBool, StrictInt

from sequence_planner.auth.roles import Role
from sequence_planner.auth.watches import Watch
from sequence_planner.controller.commands.commands import (
    LONGEST_SHELVING,
    AcknowledgeAlarm,
    AcknowledgeTask,
    Act,
    ApproveRequest,
    ConfirmEstimates,
    CorrectEstimates,
    CorrectionAct,
    DecideOutputs,
    DeclineRequest,
    ForceAct,
    ForceVariable,
    GivenValue,
    GivenValues,
    OutputsAct,
    ProblemKind,
    ReleaseForce,
    ReportProblem,
    RequestApproval,
    RestoreAlarm,
    SetByOrder,
    ShelveAlarm,
    SolveProblem,
    StopErrand,
    SuppressAlarm,
    TakeErrand,
    UndoCorrection,
    UnshelveAlarm,
    Why,
)
from sequence_planner.controller.commands.production import (
    ClearOverride,
    EnterRestart,
    LeaveRestart,
    ReleaseControl,
    SetMode,
    SetOverride,
    SetService,
    SetStepping,
    StartProduction,
    TakeControl,
    TakeStep,
)
from sequence_planner.controller.commands.queries import (
    LONGEST_PREDICATE,
    AskAdvice,
    AskCorrection,
    AskGoal,
    AskReset,
)
from sequence_planner.controller.views.details import CorrectionPreview
from sequence_planner.controller.views.proposals import AdviceView, OfferView
from sequence_planner.controller.views.station import FieldValue
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, Body, Controller, Reason, live_view
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.middleware import CARRIED_OUT, carried_out
from sequence_planner.server.interface import interface

# What a person may do for the work at hand: acknowledge a task or say what is wrong with it, set an override.
#
# Each endpoint makes one command with its actor and waits for the controller's word. 204 means that it was done; a
# refusal is a problem whose `type` ends in the controller's own slug. A body may say why, which is recorded.

LARGEST_REVISION = 2**53 - 1  # the largest whole number that every JSON reader keeps
OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)

actions_router = interface(tags=["actions"], dependencies=[JSON_ONLY], responses=refused(409, 504))
actions_bodiless = interface(tags=["actions"], responses=refused(409, 504))
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


@actions_router.post("/tasks/{task}/acknowledgement", status_code=204, dependencies=[DOER])
async def acknowledge_task(
    task: Name, body: AcknowledgementBody, request: Request, client: Controller, actor: Actor
) -> None:
    """Say that a task is done; refused when the task or its revision is gone, or a watch is not for its resource."""
    await _check_own(request.state.watch, task, body.revision, client)
    await client.send(AcknowledgeTask(actor=actor, task=task, revision=body.revision))


@actions_router.post("/tasks/{task}/problem", status_code=204, dependencies=[DOER])
async def report_problem(task: Name, body: ProblemBody, request: Request, client: Controller, actor: Actor) -> None:
    """Say that a task cannot be done as things are; refused as an acknowledgement is.

    It raises an alarm until the task is over or the problem solved, and changes nothing else. Said again, it is told
    with the last reason.
    """
    await _check_own(request.state.watch, task, body.revision, client)
    await client.send(ReportProblem(actor=actor, task=task, revision=body.revision, reason=body.reason, what=body.what))


@actions_router.post("/tasks/{task}/problem/solved", status_code=204, dependencies=[DOER])
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


@actions_router.put("/overrides/{name}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def set_override(name: Name, body: OverrideBody, client: Controller, actor: Actor) -> None:
    """Set fields of an override, such as `ur10.speed`, within the bounds of the model; they expire as it says.

    It takes control. 422 `out-of-bounds` names the field and what is allowed; nothing has changed then.
    """
    await client.send(SetOverride(actor=actor, name=name, fields=body.fields, reason=body.reason))


@actions_bodiless.delete("/overrides/{name}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def clear_override(name: Name, client: Controller, actor: Actor) -> None:
    """Take back what is set, if anything is. It takes control."""
    await client.send(ClearOverride(actor=actor, name=name))


# What people do about alarms (ISA-18.2). An alarm is named by its key in `GET /alarms`, which the body carries.
#
# 204 means that it was done. 409 `alarm-gone` when there is none by that key any more.

alarms_router = interface("/alarms", tags=["alarms"], dependencies=[JSON_ONLY], responses=refused(409, 504))
AlarmWhy = Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]


class AlarmBody(Body):
    """The key of an alarm."""

    alarm: Annotated[str, Field(min_length=1, max_length=400)]
    reason: Reason = None


class AcknowledgeBody(AlarmBody):
    """The alarm as it was seen, `since` when: none that came later is acknowledged by mistake."""

    since: Annotated[float, Field(ge=0, allow_inf_nan=False, strict=True)]


class ShelveBody(Body):
    """For how many seconds it is not to be told, and why."""

    alarm: Annotated[str, Field(min_length=1, max_length=400)]
    seconds: Annotated[float, Field(gt=0, le=LONGEST_SHELVING, strict=True)]
    reason: AlarmWhy


class SuppressBody(Body):
    """Which alarm is taken out of service, and why."""

    alarm: Annotated[str, Field(min_length=1, max_length=400)]
    reason: AlarmWhy


@alarms_router.post("/acknowledge", status_code=204, dependencies=[OPERATOR])
async def acknowledge_alarm(body: AcknowledgeBody, client: Controller, actor: Actor) -> None:
    """Say that one has seen an alarm; 409 `alarm-recurred` where it came anew after the one that was seen."""
    await client.send(AcknowledgeAlarm(actor=actor, alarm=body.alarm, since=body.since, reason=body.reason))


@alarms_router.post("/shelve", status_code=204, dependencies=[OPERATOR])
async def shelve_alarm(body: ShelveBody, client: Controller, actor: Actor) -> None:
    """Not be told of an alarm for some time, eight hours at most; 409 `alarm-too-urgent` for one of high priority."""
    await client.send(ShelveAlarm(actor=actor, alarm=body.alarm, seconds=body.seconds, reason=body.reason))


@alarms_router.post("/unshelve", status_code=204, dependencies=[OPERATOR])
async def unshelve_alarm(body: AlarmBody, client: Controller, actor: Actor) -> None:
    """Be told of a shelved alarm again."""
    await client.send(UnshelveAlarm(actor=actor, alarm=body.alarm, reason=body.reason))


@alarms_router.post("/suppress", status_code=204, dependencies=[ENGINEER])
async def suppress_alarm(body: SuppressBody, client: Controller, actor: Actor) -> None:
    """Take an alarm out of service until it is restored; 409 `alarm-too-urgent` for one of high priority."""
    await client.send(SuppressAlarm(actor=actor, alarm=body.alarm, reason=body.reason))


@alarms_router.post("/restore", status_code=204, dependencies=[ENGINEER])
async def restore_alarm(body: AlarmBody, client: Controller, actor: Actor) -> None:
    """Put an alarm back in service."""
    await client.send(RestoreAlarm(actor=actor, alarm=body.alarm, reason=body.reason))


# What needs two people: one asks, in control; another, who has seen the same, approves or declines.
#
# Each endpoint makes one command with its actor and waits for the controller's word. Who waits and how it ended is in
# the station's `commands`.

Revision = Annotated[StrictInt, Field(ge=0, le=LARGEST_REVISION)]
ApprovalNamed = Annotated[str, Path(min_length=1, max_length=40)]

approvals_router = interface(
    "/approvals", tags=["approvals"], dependencies=[JSON_ONLY], responses=refused(404, 409, 422, 504)
)


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


@approvals_router.post("/corrections", status_code=204, dependencies=[OPERATOR])
async def request_correction_approval(body: CorrectionRequestBody, client: Controller, actor: Actor) -> None:
    """Ask a second person to approve a correction, within two minutes and in this state. It takes control.

    409 `no-approval-needed` where none of its variables asks for that.
    """
    await client.send(RequestApproval(actor=actor, act=body.act, revision=body.revision, reason=body.reason))


@approvals_router.post("/restored-outputs", status_code=204, dependencies=[OPERATOR])
async def request_outputs_approval(body: OutputsRequestBody, client: Controller, actor: Actor) -> None:
    """Ask a second person to approve a decision on outputs, as a correction."""
    await client.send(RequestApproval(actor=actor, act=body.act, revision=body.revision, reason=body.reason))


@approvals_router.post("/forces", status_code=204, dependencies=[ENGINEER])
async def request_force_approval(body: ForceRequestBody, client: Controller, actor: Actor) -> None:
    """Ask a second person to approve a force, as a correction."""
    await client.send(RequestApproval(actor=actor, act=body.act, revision=body.revision, reason=body.reason))


@approvals_router.post("/{request}/approve", status_code=204, dependencies=[OPERATOR])
async def approve_request(request: ApprovalNamed, body: ApprovalBody, client: Controller, actor: Actor) -> None:
    """Approve what another person has asked for: it is done at once, in the names of both.

    403 `same-person` for who has asked, 409 `request-gone` when it was answered, overtaken or took too long.
    """
    command = ApproveRequest(actor=actor, request=request, act=body.act, revision=body.revision, reason=body.reason)
    await client.send(command)


@approvals_router.post("/{request}/decline", status_code=204, dependencies=[OPERATOR])
async def decline_request(request: ApprovalNamed, body: RefusalBody, client: Controller, actor: Actor) -> None:
    """Decline what another person has asked for, or withdraw what one has asked for oneself."""
    await client.send(DeclineRequest(actor=actor, request=request, act=body.act, reason=body.reason))


# Control: one session at a time may start what moves. To take it from somebody is an act of its own, seen by all.

control_router = interface("/control-lock", tags=["control"], responses=refused(409, 504))


class ControlBody(Body):
    """The session from which control is taken over, null where nobody is in control as far as the person sees."""

    over: Annotated[str, Field(min_length=1, max_length=200)] | None
    reason: Reason = None


@control_router.put("", status_code=204, dependencies=[OPERATOR, JSON_ONLY])
async def take_control(body: ControlBody, client: Controller, actor: Actor) -> None:
    """Put this session in control; 409 `control-changed` when by now another is than the one that was seen."""
    await client.send(TakeControl(actor=actor, over=body.over, reason=body.reason))


@control_router.delete("", status_code=204, dependencies=[OPERATOR])
async def release_control(client: Controller, actor: Actor) -> None:
    """Give control up."""
    await client.send(ReleaseControl(actor=actor))


# Corrections of what the station believes, and what a person decides about outputs that came back.
#
# Each endpoint makes one command with its actor and waits for the controller's word. 204 means that it was done; a
# refusal is a problem whose `type` ends in the controller's own slug. What is possible when: `docs/restart.md`.

corrections_router = interface(
    tags=["corrections"], dependencies=[JSON_ONLY, OPERATOR], responses=refused(404, 409, 422, 504)
)


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


@corrections_router.post("/corrections/preview")
async def preview_correction(body: ValuesBody, client: Controller) -> CorrectionPreview:
    """What a correction would bring about: what it would violate, which abilities could start, the plan that follows.

    Nothing is changed by asking, and it may be asked in every mode.
    """
    return await client.ask(AskCorrection(values=body.values))


@corrections_router.post("/corrections", status_code=204)
async def correct(body: CorrectionBody, client: Controller, actor: Actor) -> None:
    """Give estimates other values, all at once: in restart mode, or before production is started. It takes control.

    409 `stale-revision` when the state is not at this revision any more; nothing has changed then.
    """
    await client.send(CorrectEstimates(actor=actor, values=body.values, revision=body.revision, reason=body.reason))


@corrections_router.post("/corrections/undo", status_code=204)
async def undo_correction(body: UndoBody, client: Controller, actor: Actor) -> None:
    """Take the last correction back, as long as its variables have the values that it gave them. It takes control.

    409 `stale-revision` when they have others, or when the last correction was made on another revision.
    """
    await client.send(UndoCorrection(actor=actor, revision=body.revision, reason=body.reason))


@corrections_router.post("/corrections/confirm", status_code=204)
async def confirm_correction(body: DecisionBody, client: Controller, actor: Actor) -> None:
    """Say that these estimates are as the station believes; 409 `stale-revision` when one is another by now."""
    await client.send(ConfirmEstimates(actor=actor, values=body.values, reason=body.reason))


@corrections_router.put("/restored-outputs", status_code=204)
async def confirm_restored_outputs(body: DecisionBody, client: Controller, actor: Actor) -> None:
    """Decide on outputs that came back from the journal and would move devices; before production. It takes control."""
    await client.send(DecideOutputs(actor=actor, values=body.values, reason=body.reason))


# Plans that a person may take: what the advisor offers, a goal by hand, the reset of an operation.
#
# Asking changes nothing. What is offered belongs to the state it was made for, and is refused once the station has
# moved.

MOST_STARTS = 150  # of a plan that a person confirms start by start; a body holds no more
recovery_router = interface(tags=["recovery"], responses=refused(409, 504))
operator_plans_router = interface(
    "/operator-plans", tags=["recovery"], dependencies=[JSON_ONLY], responses=refused(409, 504)
)


class GoalBody(Body):
    """What shall hold, in the model's language."""

    predicate: Annotated[str, Field(min_length=1, max_length=LONGEST_PREDICATE)]


class ResetBody(Body):
    """The operation whose precondition shall hold again."""

    operation: Annotated[str, Field(min_length=1, max_length=200)]


class ErrandBody(Body):
    """The offer, and all that it contains as the person has seen it: the starts in order, and the corrections."""

    offer: Annotated[str, Field(min_length=1, max_length=100)]
    starts: Annotated[list[Annotated[str, Field(max_length=200)]], Field(max_length=MOST_STARTS)]
    corrections: Annotated[dict[str, GivenValue], Field(default_factory=dict, max_length=200)]
    reason: Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]


class StopBody(Body):
    """To stop is all that there is to say, but perhaps why."""

    reason: Reason = None


@recovery_router.get("/recovery/proposals", dependencies=[OPERATOR])
async def recovery_proposals(client: Controller) -> AdviceView:
    """Proven ways on from the present state, the least effort first, each with its plan.

    409 `plan-running` while a plan is being carried out. With an offer in `obstacle` stands what to do first.
    """
    return await client.ask(AskAdvice())


@operator_plans_router.post("/goal-preview", dependencies=[ENGINEER])
async def preview_goal(body: GoalBody, client: Controller) -> OfferView:
    """A plan to whatever shall hold, to be looked at and perhaps taken.

    422 `bad-predicate` names the place; 409 `goal-holds` and `no-plan` say why there is nothing to take.
    """
    return await client.ask(AskGoal(predicate=body.predicate))


@operator_plans_router.post("/reset-preview", dependencies=[OPERATOR], responses=refused(404))
async def preview_reset(body: ResetBody, client: Controller) -> OfferView:
    """A plan to the precondition of an operation, from which it begins anew; 409 `no-plan` where there is none."""
    return await client.ask(AskReset(operation=body.operation))


@operator_plans_router.post("", status_code=204, dependencies=[OPERATOR], responses=refused(422))
async def execute_operator_plan(body: ErrandBody, client: Controller, actor: Actor) -> None:
    """Make the corrections of an offer and have its plan carried out, and nothing else. It takes control.

    409 `proposal-gone` and `stale-revision` ask to look again; `not-confirmed`: starts and corrections are not those
    of the offer.
    """
    command = TakeErrand(
        actor=actor, offer=body.offer, starts=body.starts, corrections=body.corrections, reason=body.reason
    )
    await client.send(command)


@operator_plans_router.post("/stop", status_code=204, dependencies=[OPERATOR], responses=CARRIED_OUT)
async def stop_operator_plan(body: StopBody, client: Controller, actor: Actor) -> Response:
    """Start no more of what is carried out; what runs goes on to its end. Anybody who may act can do it.

    200 says that it was done and the journal does not have it yet.
    """
    return carried_out(await client.send(StopErrand(actor=actor, reason=body.reason)))


# How the station executes: its mode and restart mode, production, steps, what is in service, and forces.
#
# Each endpoint makes one command with its actor and waits for the controller's word. 204 means that it was done, 200
# that it was done and is not in the journal yet; a
# refusal is a problem whose `type` ends in the controller's own slug. Which act is possible when: `docs/control.md`.

LONGEST_FORCE = 3600.0  # seconds

modes_router = interface(tags=["modes"], dependencies=[JSON_ONLY], responses=refused(409, 504))
modes_bodiless = interface(tags=["modes"], responses=refused(409, 504))
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


@modes_router.put("/mode", status_code=204, dependencies=[OPERATOR], responses=CARRIED_OUT)
async def set_mode(body: ModeBody, client: Controller, actor: Actor) -> Response:
    """Change the mode of execution. To go on takes control; to pause and to hold is for anybody, and never refused.

    200 says that the station is stopped and the journal does not have it yet; 503 `stop-not-recorded` that it is
    stopped and nowhere written down.
    """
    return carried_out(await client.send(SetMode(actor=actor, mode=_MODES[body.mode], reason=body.reason)))


@modes_router.post("/production/start", status_code=204, dependencies=[OPERATOR])
async def start_production(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Allow outputs to be published; nothing else implies it. It takes control."""
    await client.send(StartProduction(actor=actor, reason=body.reason))


@modes_router.post("/restart/enter", status_code=204, dependencies=[OPERATOR])
async def enter_restart(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Enter restart mode: operations wait, what runs may finish, and nothing is started by it. It takes control."""
    await client.send(EnterRestart(actor=actor, reason=body.reason))


@modes_router.post("/restart/leave", status_code=204, dependencies=[OPERATOR])
async def leave_restart(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Leave restart mode for the paused one; to go on is another request. It takes control."""
    await client.send(LeaveRestart(actor=actor, reason=body.reason))


@modes_router.put("/stepping", status_code=204, dependencies=[ENGINEER])
async def set_stepping(body: SteppingBody, client: Controller, actor: Actor) -> None:
    """For commissioning: have every single start wait for a person's step, or none. It takes control."""
    await client.send(SetStepping(actor=actor, on=body.on, reason=body.reason))


@modes_router.post("/stepping/step", status_code=204, dependencies=[ENGINEER])
async def take_step(body: ReasonBody, client: Controller, actor: Actor) -> None:
    """Allow one start, as soon as there is one. It takes control."""
    await client.send(TakeStep(actor=actor, reason=body.reason))


@modes_router.put("/settings/job-mode", status_code=204, dependencies=[OPERATOR])
async def set_job_mode(body: ByOrderBody, client: Controller, actor: Actor) -> None:
    """Let operations of work masters be active for job orders only, or whenever they can be. It takes control."""
    await client.send(SetByOrder(actor=actor, on=body.on, reason=body.reason))


@modes_router.put("/availability/{kind}/{name}", status_code=204, dependencies=[OPERATOR], responses=refused(404))
async def set_availability(kind: ServiceKind, name: Named, body: ServiceBody, client: Controller, actor: Actor) -> None:
    """Take a resource, an ability or an operation out of service, or put it back. It takes control."""
    command = SetService(actor=actor, of=kind, name=name, in_service=body.in_service, reason=body.reason)
    await client.send(command)


@modes_router.put("/forces/{name}", status_code=204, dependencies=[ENGINEER], responses=refused(404))
async def force(name: Named, body: ForceBody, client: Controller, actor: Actor) -> None:
    """Let a measured variable or an output have a value for a time, whatever its device or an ability says.

    It takes control. 422 `not-in-domain` says which values there are, and 409 `force-unsafe` that the value would lead
    out of the safe states; nothing has changed then.
    """
    command = ForceVariable(actor=actor, name=name, value=body.value, seconds=body.seconds, reason=body.reason)
    await client.send(command)


@modes_bodiless.delete("/forces/{name}", status_code=204, dependencies=[ENGINEER], responses=refused(404))
async def release_force(name: Named, client: Controller, actor: Actor) -> None:
    """Let a variable be as it comes again, if it is forced. It takes control."""
    await client.send(ReleaseForce(actor=actor, name=name))
