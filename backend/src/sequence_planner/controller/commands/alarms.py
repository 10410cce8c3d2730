"""Commands for alarms: what a person may do about one, after ISA-18.2. None of it changes the alarm's cause."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from sequence_planner.controller.commands.command import Command, Route, Why

LONGEST_SHELVING = 8 * 3600.0  # seconds


class AlarmCommand(Command):
    """`alarm` is its key in the view."""

    about = "alarm {alarm}"
    alarm: str = Field(min_length=1, max_length=400)


class AcknowledgeAlarm(AlarmCommand):
    """Say that one has seen an alarm; 409 `alarm-recurred` where it came anew after the one that was seen."""

    routes = (
        Route(
            "POST",
            "/alarms/acknowledge",
            "acknowledge_alarm",
            tag="alarms",
            body="AcknowledgeBody",
            body_text="The alarm as it was seen, `since` when: none that came later is acknowledged by mistake.",
        ),
    )
    kind: Literal["acknowledge-alarm"] = "acknowledge-alarm"
    since: Annotated[float, Field(ge=0, allow_inf_nan=False, strict=True)]


class ShelveAlarm(AlarmCommand):
    """Not be told of an alarm for some time, eight hours at most; 409 `alarm-too-urgent` for one of high priority."""

    routes = (
        Route(
            "POST",
            "/alarms/shelve",
            "shelve_alarm",
            tag="alarms",
            body="ShelveBody",
            body_text="For how many seconds it is not to be told, and why.",
        ),
    )
    kind: Literal["shelve-alarm"] = "shelve-alarm"
    reason: Why
    seconds: Annotated[float, Field(gt=0, le=LONGEST_SHELVING, strict=True)]


class UnshelveAlarm(AlarmCommand):
    """Be told of a shelved alarm again."""

    routes = (
        Route(
            "POST",
            "/alarms/unshelve",
            "unshelve_alarm",
            tag="alarms",
            body="AlarmBody",
            body_text="The key of an alarm.",
        ),
    )
    kind: Literal["unshelve-alarm"] = "unshelve-alarm"


class SuppressAlarm(AlarmCommand):
    """Take an alarm out of service until it is restored; 409 `alarm-too-urgent` for one of high priority."""

    routes = (
        Route(
            "POST",
            "/alarms/suppress",
            "suppress_alarm",
            tag="alarms",
            body="SuppressBody",
            body_text="Which alarm is taken out of service, and why.",
            role="engineer",
        ),
    )
    kind: Literal["suppress-alarm"] = "suppress-alarm"
    reason: Why


class RestoreAlarm(AlarmCommand):
    """Put an alarm back in service."""

    routes = (
        Route(
            "POST",
            "/alarms/restore",
            "restore_alarm",
            tag="alarms",
            body="AlarmBody",
            body_text="The key of an alarm.",
            role="engineer",
        ),
    )
    kind: Literal["restore-alarm"] = "restore-alarm"
