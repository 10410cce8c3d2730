"""Document schema of `shifts.yaml`: when a station is to work, and the check that its times go together."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import combinations, pairwise
from typing import Annotated, Final, Literal, get_args

from pydantic import BeforeValidator, Field, WithJsonSchema

from sequence_planner.model.fields import DocumentPart, Given, Words
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.texts.message import Message, message

Day = Literal["mon", "tue", "wed", "thu", "fri", "sat", "sun"]

DAYS: Final[tuple[Day, ...]] = get_args(Day)
DAY: Final = 24 * 60  # minutes
WEEK: Final = 7 * DAY
_TIME: Final = r"^([01][0-9]|2[0-3]):[0-5][0-9]$"


def _time(value: object) -> object:
    if isinstance(value, SourceText) and re.fullmatch(_TIME, value):
        return value
    if value == "24:00":
        raise ValueError(message("form.midnight"))
    if isinstance(value, str | int | float):
        raise ValueError(message("form.no-time", value=str(value)))
    raise ValueError(message("form.time"))


ClockTime = Annotated[SourceText, BeforeValidator(_time), WithJsonSchema({"type": "string", "pattern": _TIME})]


class BreakDocument(DocumentPart):
    """A break of a shift."""

    begin: ClockTime = Field(alias="from")
    """When it begins, such as `"09:00"`."""
    to: ClockTime
    """When it ends."""


class ShiftDocument(DocumentPart):
    """A shift: from when to when the station is to work."""

    title: Given[Words] = None
    """For people; without it the name in plain words."""
    begin: ClockTime = Field(alias="from")
    """When it begins, such as `"06:00"`, by the clock of the machine that the station runs on."""
    to: ClockTime
    """When it ends. Earlier than `from` it is on the next day; the same time is a whole day later."""
    days: Annotated[list[Day], Field(min_length=1)] = Field(default_factory=lambda: [*DAYS])
    """The days on which it begins; without it every day."""
    breaks: list[BreakDocument] = Field(default_factory=list)
    """Times within it in which the station need not work."""

    @property
    def minutes(self) -> tuple[int, int]:
        """From when to when it lasts, in minutes since midnight of the day on which it begins."""
        begin, end = minutes_of(self.begin), minutes_of(self.to)
        return begin, end if end > begin else end + DAY

    def minutes_of_break(self, pause: BreakDocument) -> tuple[int, int]:
        """The same of a break: the first time in the shift at which it can begin, and the end after that."""
        begin, end = minutes_of(pause.begin), minutes_of(pause.to)
        begin += DAY if begin < self.minutes[0] else 0
        return begin, end + -(-(begin - end) // DAY) * DAY


def minutes_of(time: str) -> int:
    """How many minutes after midnight a time of day is."""
    hours, minutes = time.split(":")
    return 60 * int(hours) + int(minutes)


def unfit_times(shifts: Mapping[SourceText, ShiftDocument]) -> Iterator[Finding]:
    """Yield what does not go together: shifts at the same time, and breaks that are none of their shift."""
    for name, shift in shifts.items():
        yield from _unfit_breaks(name, shift)
    for (name, one), (other_name, other) in combinations(shifts.items(), 2):
        if (day := _common_day(one, other)) is not None:
            yield Finding(
                other.begin.place,
                message(
                    "wrong.shifts-overlap",
                    name=str(other_name),
                    span=_span(other),
                    other=str(name),
                    other_span=_span(one),
                    day=day,
                ),
            )


def _unfit_breaks(name: SourceText, shift: ShiftDocument) -> Iterator[Finding]:
    begin, end = shift.minutes
    found: list[tuple[int, int, BreakDocument]] = []
    for pause in shift.breaks:
        first, last = shift.minutes_of_break(pause)
        if first == last:
            yield Finding(pause.to.place, message("wrong.empty-break", time=str(pause.to)))
        elif first >= end or last > end:
            said = message(
                "wrong.break-outside", begin=str(pause.begin), end=str(pause.to), name=str(name), span=_span(shift)
            )
            yield Finding(pause.begin.place, said)
        else:
            found.append((first, last, pause))
    found.sort(key=lambda each: each[:2])
    for (_, last, before), (first, _, pause) in pairwise(found):
        if first < last:
            said = message("wrong.breaks-overlap", begin=str(pause.begin), end=str(before.to))
            yield Finding(pause.begin.place, said)
    if sum(last - first for first, last, _ in found) >= end - begin:
        yield Finding(shift.begin.place, message("wrong.only-breaks", name=str(name)))


def _common_day(one: ShiftDocument, other: ShiftDocument) -> Day | None:
    """The first day on which one begins while the other is on, as the weeks go round."""
    begin, end = one.minutes
    others_begin, others_end = other.minutes
    for day in sorted(set(one.days), key=DAYS.index):
        for others_day in sorted(set(other.days), key=DAYS.index):
            from_first = (DAYS.index(others_day) - DAYS.index(day)) * DAY + others_begin - begin
            if from_first % WEEK < end - begin:
                return others_day
            if -from_first % WEEK < others_end - others_begin:
                return day
    return None


def _span(shift: ShiftDocument) -> Message:
    return message("wrong.shift-span", begin=str(shift.begin), end=str(shift.to))
