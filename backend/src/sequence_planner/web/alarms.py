"""What people do about alarms (ISA-18.2). An alarm is named by its key in `GET /alarms`, which the body carries.

204 means that it was done. 409 `alarm-gone` when there is none by that key any more.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from sequence_planner.control.alarm_commands import (
    LONGEST_SHELVING,
    AcknowledgeAlarm,
    RestoreAlarm,
    ShelveAlarm,
    SuppressAlarm,
    UnshelveAlarm,
)
from sequence_planner.identity.roles import Role
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.web.access import allowed
from sequence_planner.web.body import Body, Reason
from sequence_planner.web.interface import interface
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY, Actor, Controller

OPERATOR, ENGINEER = allowed(Role.OPERATOR), allowed(Role.ENGINEER)
router = interface("/alarms", tags=["alarms"], dependencies=[JSON_ONLY], responses=refused(409, 504))
Why = Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]


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
    reason: Why


class SuppressBody(Body):
    """Which alarm is taken out of service, and why."""

    alarm: Annotated[str, Field(min_length=1, max_length=400)]
    reason: Why


@router.post("/acknowledge", status_code=204, dependencies=[OPERATOR])
async def acknowledge_alarm(body: AcknowledgeBody, client: Controller, actor: Actor) -> None:
    """Say that one has seen an alarm; 409 `alarm-came-again` where it came anew after the one that was seen."""
    await client.send(AcknowledgeAlarm(actor=actor, alarm=body.alarm, since=body.since, reason=body.reason))


@router.post("/shelve", status_code=204, dependencies=[OPERATOR])
async def shelve_alarm(body: ShelveBody, client: Controller, actor: Actor) -> None:
    """Not be told of an alarm for some time, eight hours at most; 409 `alarm-too-urgent` for one of high priority."""
    await client.send(ShelveAlarm(actor=actor, alarm=body.alarm, seconds=body.seconds, reason=body.reason))


@router.post("/unshelve", status_code=204, dependencies=[OPERATOR])
async def unshelve_alarm(body: AlarmBody, client: Controller, actor: Actor) -> None:
    """Be told of a shelved alarm again."""
    await client.send(UnshelveAlarm(actor=actor, alarm=body.alarm, reason=body.reason))


@router.post("/suppress", status_code=204, dependencies=[ENGINEER])
async def suppress_alarm(body: SuppressBody, client: Controller, actor: Actor) -> None:
    """Take an alarm out of service until it is restored; 409 `alarm-too-urgent` for one of high priority."""
    await client.send(SuppressAlarm(actor=actor, alarm=body.alarm, reason=body.reason))


@router.post("/restore", status_code=204, dependencies=[ENGINEER])
async def restore_alarm(body: AlarmBody, client: Controller, actor: Actor) -> None:
    """Put an alarm back in service."""
    await client.send(RestoreAlarm(actor=actor, alarm=body.alarm, reason=body.reason))
