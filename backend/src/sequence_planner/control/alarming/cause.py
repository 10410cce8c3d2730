"""Why there is an alarm, and how urgent that is."""

from __future__ import annotations

from dataclasses import dataclass, field

from sequence_planner.control.alarm_view import Priority

_URGENCY = (Priority.LOW, Priority.MEDIUM, Priority.HIGH)


@dataclass(frozen=True)
class Cause:
    """`key` stays the same as long as it is the same alarm; `parts` are what it consists of, where that is several.

    It is no alarm of its own but a part of another as long as one of those is there that it `follows` from. `past` is
    its `text` once it is over, `past_parts` are its parts then, `of` the resources whose devices fail with it, and
    `about` the variables of which it is doubted what is believed. A device that `waits` has nothing to do itself.
    """

    key: str
    priority: Priority
    text: str  # what is wrong
    consequence: str  # what comes of it
    action: str  # what to do
    follows: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()
    past: str = field(kw_only=True)
    past_parts: tuple[str, ...] = field(default=(), kw_only=True)
    of: frozenset[str] = field(default=frozenset(), kw_only=True)
    about: frozenset[str] = field(default=frozenset(), kw_only=True)
    waits: bool = field(default=False, kw_only=True)


def urgency(priority: Priority) -> int:
    """The more, the more urgent."""
    return _URGENCY.index(priority)


def most_urgent(*priorities: Priority) -> Priority:
    """The most urgent of them."""
    return max(priorities, key=urgency)
