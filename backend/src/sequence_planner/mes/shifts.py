"""Shifts on the clock: which one is on at an instant, when the next begins, and which time of one is to be worked."""

from __future__ import annotations

import time as clock
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime, time, timedelta
from functools import cached_property
from itertools import pairwise
from typing import Final

from sequence_planner.controller.views.details import ShiftTimesView

# The clock is that of the machine's time zone. A time of day that comes twice, as clocks are set back, is the first of
# the two; one that does not come, as they are set forward, is when they are. So the shifts of such a day are longer or
# shorter, none of them overlap, and where one follows another it still does.

Span = tuple[float, float]  # from when to when, in seconds since the epoch

_WEEK: Final = 7
_HOUR: Final = 60  # minutes
_DAY: Final = 24 * _HOUR


@dataclass(frozen=True)
class Shift:
    """A shift of a certain day: from when to when it lasts, with its breaks."""

    name: str
    title: Mapping[str, str]
    begin: float
    end: float
    breaks: tuple[Span, ...] = ()

    @cached_property
    def planned(self) -> tuple[Span, ...]:
        """The time of it that is to be worked: the planned busy time."""
        edges = [self.begin, *(edge for each in self.breaks for edge in each), self.end]
        return tuple((begin, end) for begin, end in zip(edges[::2], edges[1::2], strict=True) if begin < end)


def shift_at(shifts: Mapping[str, ShiftTimesView], now: float) -> Shift | None:
    """The shift that is on; None where none is."""
    today = date(*clock.localtime(now)[:3])
    for each in _beginning(shifts, (today, today - timedelta(days=1), today - timedelta(days=2))):
        if each.begin <= now < each.end:
            return each
    return None


def shift_after(shifts: Mapping[str, ShiftTimesView], now: float) -> Shift | None:
    """The shift that begins next; None where there are no shifts."""
    today = date(*clock.localtime(now)[:3])
    # A week has them all, and one more day or two those that were on already, or that clocks have skipped.
    coming = _beginning(shifts, (today + timedelta(days=days) for days in range(2 * _WEEK + 1)))
    return min((each for each in coming if each.begin > now), key=lambda each: each.begin, default=None)


def _beginning(shifts: Mapping[str, ShiftTimesView], days: Iterable[date]) -> Iterator[Shift]:
    """The shifts that begin on these days."""
    for day in days:
        for name, written in shifts.items():
            if day.weekday() in written.days:
                begin, end = (instant(day, minutes) for minutes in written.minutes)
                breaks = tuple((instant(day, first), instant(day, last)) for first, last in sorted(written.breaks))
                if begin < end:
                    yield Shift(name, written.title, begin, end, breaks)


def instant(day: date, minutes: int) -> float:
    """When it is so many minutes after midnight of a day, or of the next one, by the clock on the wall."""
    days, rest = divmod(minutes, _DAY)
    local = datetime.combine(day + timedelta(days=days), time(*divmod(rest, _HOUR)))
    first, second = local.timestamp(), local.replace(fold=1).timestamp()
    if first <= second:
        return first
    # No clock shows it: from `second`, before the clocks are set, to `first`, after that, they are so once.
    before, after = int(second), int(first)
    offset = clock.localtime(after).tm_gmtoff
    while after - before > 1:
        middle = (before + after) // 2
        before, after = (before, middle) if clock.localtime(middle).tm_gmtoff == offset else (middle, after)
    return float(after)


def seconds_within(spans: Iterable[Span], begin: float, end: float) -> float:
    """How much of some time that does not overlap lies between two instants."""
    return sum(max(0.0, min(last, end) - max(first, begin)) for first, last in spans)


# What was worked is kept as spans of time, one after the other, so that shifts may be others at any time: what was
# worked in one that has begun before it was written is known as well.


def with_span(spans: Sequence[Span], begin: float, end: float, *, joined: float, most: int) -> list[Span]:
    """The spans with one more at their end, and without what they have after its beginning: the clock was set back.

    What is `joined` seconds apart at most becomes one. Where there are more than `most`, those two become one that are
    the least apart, with all the time that both have.
    """
    kept = [(first, min(last, begin)) for first, last in spans if first < begin]
    if begin < end:
        if kept and begin - kept[-1][1] <= joined:
            begin = kept.pop()[0]
        kept.append((begin, end))
    while len(kept) > most:
        gaps = [after[0] - before[1] for before, after in pairwise(kept)]
        at = gaps.index(min(gaps))
        (first, _), (_, until) = kept[at : at + 2]
        kept[at : at + 2] = [(first + gaps[at], until)]
    return kept
