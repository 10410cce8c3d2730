"""Causes of alarms that say what a test wants them to."""

from __future__ import annotations

from sequence_planner.controller.alarms.kinds import AlarmKind, Cause
from sequence_planner.controller.views.station import AlarmGroup, Priority
from sequence_planner.texts.message import as_it_was


def cause(key: str, *follows: str, priority: Priority = Priority.MEDIUM, text: str = "") -> Cause:
    """One of a kind that has no texts of its own."""
    kind = AlarmKind(key, priority, AlarmGroup.DEVICE)
    now, past = text or f"{key} is wrong", f"{key} was wrong"
    said = (as_it_was(each) for each in (now, "nothing", "look", past))
    return Cause(key, kind, "", priority, *said, follows=follows)
