"""Flood protection: one cause, one alarm. What follows from a cause is a part of its alarm.

What follows can outlast its cause for a moment: when a network comes back, its devices speak one after the other. So
an alarm lasts until nothing of what followed is left, but not much longer than its cause.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace

from sequence_planner.control.alarming.cause import Cause, most_urgent, urgency

LINGERS = 10.0  # seconds that an alarm lasts longer than its cause at most, for what followed from it


@dataclass(frozen=True)
class Folded:
    """`alarms` by key, each with all its parts; `folded` are the keys of those that are parts."""

    alarms: Mapping[str, Cause]
    folded: frozenset[str]


class Folding:
    """Remembers which alarms had parts, and since when their causes are over."""

    def __init__(self) -> None:
        self._had_parts: dict[str, Cause] = {}
        self._over: dict[str, float] = {}
        self._part_of: dict[str, str] = {}

    def fold(self, causes: Iterable[Cause], alone: Collection[str], monotonic: float) -> Folded:
        """What is an alarm now. To those that stand `alone` nothing is added."""
        present = {cause.key: cause for cause in causes}
        lingering = self._lingering(present, monotonic)
        present = {key: self._as_before(cause, lingering) for key, cause in present.items()}
        bearing = {key: cause for key, cause in {**present, **lingering}.items() if key not in alone}
        parts: dict[str, list[Cause]] = {}
        folded: set[str] = set()
        for key, cause in present.items():
            top = _top(cause, bearing)
            # Of causes that follow from one another one is told.
            if top != key and top not in folded and key not in parts:
                parts.setdefault(top, []).append(cause)
                folded.add(key)
        self._part_of = {cause.key: top for top, every in parts.items() for cause in every}
        alarms = {key: _with(cause, parts.get(key, ())) for key, cause in present.items() if key not in folded}
        over = {key: _with(_over(cause, parts[key]), parts[key]) for key, cause in lingering.items() if key in parts}
        told = {**alarms, **over}
        # What followed, and is over before the alarm is, is told once it is over too.
        self._had_parts = {key: replace(bearing[key], past_parts=told[key].past_parts) for key in parts}
        return Folded(told, frozenset(folded))

    def _as_before(self, cause: Cause, lingering: Collection[str]) -> Cause:
        """The cause, which still follows from what is over: of that nobody says any more what follows from it."""
        before = self._part_of.get(cause.key)
        return cause if before is None or before not in lingering else replace(cause, follows=(*cause.follows, before))

    def _lingering(self, present: Mapping[str, Cause], monotonic: float) -> dict[str, Cause]:
        gone = {key: cause for key, cause in self._had_parts.items() if key not in present}
        self._over = {key: self._over.get(key, monotonic) for key in gone}
        return {key: cause for key, cause in gone.items() if monotonic - self._over[key] < LINGERS}


def _top(cause: Cause, bearing: Mapping[str, Cause]) -> str:
    """The key of the cause from which this one follows in the end; its own where it follows from none that is there."""
    seen = {cause.key}
    while (above := next((key for key in cause.follows if key in bearing and key not in seen), None)) is not None:
        seen.add(above)
        cause = bearing[above]
    return cause.key


def _with(cause: Cause, parts: Iterable[Cause]) -> Cause:
    """The alarm with what follows from its cause. It is as urgent as the most urgent of it."""
    every = list(parts)
    texts = [text for part in every for text in (part.parts or (part.text,))]
    past = [text for part in every for text in (part.past_parts or (part.past,))]
    return replace(
        cause,
        priority=most_urgent(cause.priority, *(part.priority for part in every)),
        parts=tuple(dict.fromkeys((*cause.parts, *texts))),
        past_parts=tuple(dict.fromkeys((*cause.past_parts, *past))),
    )


def _over(cause: Cause, left: Iterable[Cause]) -> Cause:
    """The cause as it is told when it is over and what followed is not: what is `left` says what comes of it."""
    worst = max(left, key=lambda part: urgency(part.priority))
    return replace(
        cause,
        priority=worst.priority,
        text=f"{cause.past}. This is over, but not all that followed",
        consequence=worst.consequence,
        action=worst.action,
        parts=(),
    )
