"""Why there is an alarm, and how urgent that is."""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.control.alarm_view import Priority

_URGENCY = (Priority.LOW, Priority.MEDIUM, Priority.HIGH)


@dataclass(frozen=True)
class Cause:
    """`key` stays the same as long as it is the same alarm; `parts` are what it consists of, where that is several.

    It is no alarm of its own but a part of another as long as one of those is there that it `follows` from.
    """

    key: str
    priority: Priority
    text: str  # what is wrong
    consequence: str  # what comes of it
    action: str  # what to do
    follows: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()


def urgency(priority: Priority) -> int:
    """The more, the more urgent."""
    return _URGENCY.index(priority)


def most_urgent(*priorities: Priority) -> Priority:
    """The most urgent of them."""
    return max(priorities, key=urgency)
