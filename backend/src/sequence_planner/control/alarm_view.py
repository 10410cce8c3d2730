"""Alarms, as they are shown."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.control.view_part import View


class Priority(StrEnum):
    """Urgency of an alarm, after ISA-18.2."""

    HIGH = "high"
    MEDIUM = "medium"
    LOW = "low"


class AlarmState(StrEnum):
    """Where an alarm stands in its life (ISA-18.2, figure 4.2)."""

    UNACKNOWLEDGED = "unacknowledged"
    ACKNOWLEDGED = "acknowledged"
    RETURNED = "returned"  # its cause has gone, and nobody has acknowledged it yet
    SHELVED = "shelved"
    OUT_OF_SERVICE = "out-of-service"


class AlarmView(View):
    """Something that wants a person's attention. `ended` is when its cause has gone, null while it lasts.

    One that was acknowledged goes with its cause. `by` is who acknowledged or shelved it or took it out of service,
    `until` when it is shelved no more, `why` the reason that was given. `count` is how often it came since it was
    last acknowledged; `part_of` lists what else the same cause has brought about.
    """

    priority: Priority
    state: AlarmState
    text: str  # what is wrong
    consequence: str  # what comes of it
    action: str  # what to do
    since: float
    ended: float | None
    by: str | None
    until: float | None
    why: str | None
    count: int
    parts: list[str]
