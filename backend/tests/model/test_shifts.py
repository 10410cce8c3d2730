"""`shifts.yaml`: what is wrong in it is told at its place, and what it says reaches who asks the controller."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.breaking import copy_of_cell, findings, write
from sequence_planner.controller.commands.queries import AboutShifts
from sequence_planner.controller.io.traffic import WrittenShifts
from sequence_planner.language.types import Place
from sequence_planner.model.shifts.documents import DAY, DAYS, WEEK, ShiftDocument, unfit_times
from sequence_planner.model.source import SourceText
from sequence_planner.station import prepare_station
from support.examples import examples

TWO = """\
early:
  title: {en: Early shift, sv: Förmiddag}
  from: "06:00"
  to: "14:00"
  days: [mon, tue, wed, thu, fri]
  breaks:
    - {from: "11:00", to: "11:30"}
    - {from: "09:00", to: "09:15"}
night_shift: {from: "22:00", to: "06:00", breaks: [{from: "02:00", to: "02:30"}]}
"""

WRONG = {
    "an unknown day": (
        'early: {from: "06:00", to: "14:00", days: [mon, ‹tues]}',
        "expected `mon`, `tue`, `wed`, `thu`, `fri`, `sat` or `sun`, found `tues`",
    ),
    "no day": ('early: {from: "06:00", to: "14:00", days: ‹[]}', "expected at least one entry, found an empty list"),
    "a number": (
        'early: {from: ‹1400, to: "22:00"}',
        '`1400` is no time: write a time of day as hours and minutes in quotes, from "00:00" to "23:59"',
    ),
    "an hour with one digit": (
        'early: {from: ‹"6:00", to: "14:00"}',
        '`6:00` is no time: write a time of day as hours and minutes in quotes, from "00:00" to "23:59"',
    ),
    "seconds": (
        'early: {from: ‹"06:00:00", to: "14:00"}',
        '`06:00:00` is no time: write a time of day as hours and minutes in quotes, from "00:00" to "23:59"',
    ),
    "24 o'clock": ('early: {from: "14:00", to: ‹"24:00"}', '`24:00` is no time: midnight is "00:00"'),
    "no end": ('‹early: {from: "14:00"}', "`to` is missing here"),
    "another key": (
        'early: {from: "06:00", to: "14:00", ‹pauses: []}',
        "`pauses` is not known here",
    ),
    "an overlap": (
        'early: {from: "06:00", to: "14:00"}\nlate: {from: ‹"13:59", to: "22:00", days: [wed]}',
        "`late`, 13:59 to 22:00, overlaps `early`, 06:00 to 14:00, on wed: one shift at a time",
    ),
    "an overlap from Sunday to Monday": (
        'night: {from: "22:00", to: "06:00", days: [sun]}\nearly: {from: ‹"05:00", to: "14:00", days: [mon]}',
        "`early`, 05:00 to 14:00, overlaps `night`, 22:00 to 06:00, on mon: one shift at a time",
    ),
    "a break outside": (
        'early: {from: "06:00", to: "14:00", breaks: [{from: ‹"05:30", to: "06:30"}]}',
        "the break 05:30 to 06:30 does not lie within `early`, 06:00 to 14:00",
    ),
    "a break that ends outside": (
        'early: {from: "06:00", to: "14:00", breaks: [{from: ‹"13:30", to: "14:30"}]}',
        "the break 13:30 to 14:30 does not lie within `early`, 06:00 to 14:00",
    ),
    "a break without a length": (
        'early: {from: "06:00", to: "14:00", breaks: [{from: "09:00", to: ‹"09:00"}]}',
        "this break ends when it begins, at 09:00: write when it is over",
    ),
    "breaks at the same time": (
        'early: {from: "06:00", to: "14:00", breaks: [{from: ‹"09:10", to: "09:30"}, {from: "09:00", to: "09:15"}]}',
        "this break begins at 09:10, and another lasts until 09:15: make one of them",
    ),
    "nothing but breaks": (
        'early: {from: ‹"06:00", to: "14:00", breaks: [{from: "06:00", to: "10:00"}, {from: "10:00", to: "14:00"}]}',
        "`early` is nothing but breaks: leave it out, or let the station work in it",
    ),
}


@pytest.mark.parametrize(("text", "message"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_told_at_its_place(tmp_path: Path, text: str, message: str) -> None:
    station = copy_of_cell(tmp_path)
    [place] = write(station, "shifts.yaml", text)
    assert findings(station) == [f"{place}: {message}"]


@pytest.mark.parametrize(
    "text",
    [
        TWO,
        "early: {from: 06:00, to: 14:00}\n",  # without quotes it is a text all the same
        'day: {from: "06:00", to: "06:00", breaks: [{from: "23:30", to: "00:30"}]}\n',
        'one: {from: "00:00", to: "12:00"}\nother: {from: "12:00", to: "00:00"}\n',
        "",
    ],
)
def test_what_goes_together_is_accepted(tmp_path: Path, text: str) -> None:
    station = copy_of_cell(tmp_path)
    write(station, "shifts.yaml", text)
    prepare_station(station)


def test_who_asks_is_told_the_shifts_in_minutes(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(station, "shifts.yaml", TWO)
    shifts = WrittenShifts(prepare_station(station)).shifts(AboutShifts()).shifts
    assert list(shifts) == ["early", "night_shift"]
    early, night = shifts["early"], shifts["night_shift"]
    assert early.title == {"en": "Early shift", "sv": "Förmiddag"}
    assert (early.minutes, early.days, early.breaks) == ((360, 840), [0, 1, 2, 3, 4], [(540, 555), (660, 690)])
    assert (night.title, night.minutes, night.days) == ({"": "night shift"}, (1320, 1800), [*range(7)])
    assert night.breaks == [(1560, 1590)], "on the next day"


def test_a_station_without_shifts_has_none(tmp_path: Path) -> None:
    assert WrittenShifts(prepare_station(copy_of_cell(tmp_path))).shifts(AboutShifts()).shifts == {}


TIMES = st.integers(0, 23).map(lambda hour: f"{hour:02}:00")
SHIFTS = st.lists(
    st.builds(lambda begin, to, days: (begin, to, days), TIMES, TIMES, st.lists(st.sampled_from(DAYS), min_size=1)),
    min_size=1,
    max_size=3,
)


@given(SHIFTS)
@examples(300)
def test_an_overlap_is_found_just_where_a_minute_of_the_week_has_two_shifts(
    written: list[tuple[str, str, list[str]]],
) -> None:
    def text(of: str) -> SourceText:
        return SourceText(of, Place("shifts.yaml", 1, 1), of)

    shifts = {
        text(f"shift{number}"): ShiftDocument.model_validate({"from": text(begin), "to": text(to), "days": days})
        for number, (begin, to, days) in enumerate(written)
    }
    taken: list[int] = []
    for each in shifts.values():
        begin, end = each.minutes
        for day in set(each.days):
            taken += [(DAYS.index(day) * DAY + minute) % WEEK for minute in range(begin, end, 60)]
    assert bool(list(unfit_times(shifts))) == (len(taken) > len(set(taken)))
