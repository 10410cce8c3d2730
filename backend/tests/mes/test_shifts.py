"""Shifts on the clock, also on days on which it is set, and what a station made in them."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, date, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mes.test_figures import MORNING, Station
from sequence_planner.controller.views.details import ShiftTimesView
from sequence_planner.mes.figures import DayFigures
from sequence_planner.mes.shifts import Shift, instant, seconds_within, shift_after, shift_at, with_span
from sequence_planner.mes.tracker import Ledger
from support.examples import examples

HOUR = 3600.0
DAY = 24 * 60  # minutes
ZONES = ("Europe/Stockholm", "America/New_York", "Australia/Lord_Howe", "Asia/Kolkata", "Pacific/Apia", "UTC")


@contextmanager
def standing_in(zone: str) -> Iterator[None]:
    """The station stands there."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TZ", zone)
        time.tzset()
        try:
            yield
        finally:
            patch.undo()
            time.tzset()


@pytest.fixture(autouse=True)
def _zone() -> Iterator[None]:
    with standing_in("Europe/Stockholm"):
        yield


def times(begin: float, end: float, *breaks: tuple[float, float], days: str = "0123456") -> ShiftTimesView:
    """A shift from and to hours since midnight, with its breaks."""
    return ShiftTimesView(
        title={"": "Early shift"},
        minutes=(round(begin * 60), round(end * 60)),
        days=[int(each) for each in days],
        breaks=[(round(first * 60), round(last * 60)) for first, last in breaks],
    )


THREE = {"early": times(6, 14), "late": times(14, 22), "night": times(22, 30)}
EARLY = {"early": times(6, 14, (9, 9.5), days="01234")}


def at(text: str) -> float:
    """An instant by the clock of Stockholm."""
    return datetime.fromisoformat(text).replace(tzinfo=ZoneInfo("Europe/Stockholm")).timestamp()


def name_at(shifts: dict[str, ShiftTimesView], text: str) -> str | None:
    found = shift_at(shifts, at(text))
    return None if found is None else found.name


def test_a_shift_is_on_from_its_beginning_until_its_end() -> None:
    assert [
        name_at(THREE, f"2026-06-01 {each}") for each in ("05:59", "06:00", "13:59", "14:00", "22:00", "23:59")
    ] == [
        "night",
        "early",
        "early",
        "late",
        "night",
        "night",
    ]
    assert name_at(EARLY, "2026-06-01 14:00") is None
    assert name_at(EARLY, "2026-05-31 09:00") is None, "a Sunday"


def test_a_shift_over_midnight_belongs_to_the_day_on_which_it_begins() -> None:
    night = {"night": times(22, 30, (26, 26.5), days="4")}  # Friday
    assert name_at(night, "2026-06-06 05:59") == "night", "on Saturday"
    assert name_at(night, "2026-06-05 05:59") is None, "on Friday itself"
    found = shift_at(night, at("2026-06-06 03:00"))
    assert found is not None
    assert (found.begin, found.end) == (at("2026-06-05 22:00"), at("2026-06-06 06:00"))
    assert found.planned == (
        (at("2026-06-05 22:00"), at("2026-06-06 02:00")),
        (at("2026-06-06 02:30"), at("2026-06-06 06:00")),
    )


def test_the_next_shift_may_be_a_week_away() -> None:
    monday = {"only": times(6, 14, days="0")}
    found = shift_after(monday, at("2026-06-01 06:00"))
    assert found is not None
    assert found.begin == at("2026-06-08 06:00")
    assert shift_after({}, MORNING) is None


@pytest.mark.parametrize(
    ("day", "spans"),
    # The break from 02:00 to 02:30 falls into the hour that no clock shows, or comes with the first of two.
    [("2026-03-28", [4, 3]), ("2026-10-24", [4, 4.5])],
    ids=["set forward", "set back"],
)
def test_a_night_on_which_the_clocks_are_set_is_shorter_or_longer(day: str, spans: list[float]) -> None:
    found = shift_at({"night": times(22, 30, (26, 26.5))}, at(f"{day} 23:00"))
    assert found is not None
    assert [(last - first) / HOUR for first, last in found.planned] == spans


def test_what_no_clock_shows_is_when_the_clocks_are_set() -> None:
    forward = date(2026, 3, 29)
    change = datetime(2026, 3, 29, 1, tzinfo=UTC).timestamp()
    assert [instant(forward, minutes) for minutes in (120, 150, 179, 180)] == [change] * 4
    assert instant(forward, 181) == change + 60
    back = date(2026, 10, 25)
    assert instant(back, 150) == datetime(2026, 10, 25, 0, 30, tzinfo=UTC).timestamp(), "the first of two"


DATES = st.dates(date(2011, 12, 25), date(2037, 12, 31))  # from before Apia left out a day


@given(st.sampled_from(ZONES), DATES, st.lists(st.integers(0, 2 * DAY), min_size=2, max_size=6))
@examples(300)
def test_a_later_time_of_day_never_comes_earlier(zone: str, day: date, minutes: list[int]) -> None:
    with standing_in(zone):
        found = [instant(day, each) for each in sorted(minutes)]
        assert found == sorted(found)
        for minute, when in zip(sorted(minutes), found, strict=True):
            local = datetime.fromtimestamp(when, ZoneInfo(zone)).replace(tzinfo=None)
            wanted = datetime.combine(day, datetime.min.time()) + timedelta(minutes=minute)
            assert local >= wanted, "it is that time then, or the clocks have passed it just now"
            if local != wanted:
                before = datetime.fromtimestamp(when - 1, ZoneInfo(zone)).replace(tzinfo=None)
                assert before < wanted


@given(st.sampled_from(ZONES), DATES, st.lists(st.integers(0, DAY - 1), min_size=1, max_size=5, unique=True), st.data())
@examples(300)
def test_shifts_that_follow_each_other_leave_no_instant_out(
    zone: str, day: date, edges: list[int], data: st.DataObject
) -> None:
    """On any day, be it one on which the clocks are set: exactly one is on, and the next begins when it ends."""
    edges.sort()
    ends = [*edges[1:], edges[0] + DAY]
    shifts = {
        str(begin): ShiftTimesView(title={}, minutes=(begin, end), days=[*range(7)], breaks=[])
        for begin, end in zip(edges, ends, strict=True)
    }
    with standing_in(zone):
        now = instant(day, 0) + data.draw(st.floats(0, 26 * HOUR))
        found = shift_at(shifts, now)
        assert found is not None
        assert found.begin <= now < found.end
        then = shift_after(shifts, now)
        assert then is not None
        assert then.begin == found.end
        assert shift_at(shifts, found.end) == then


SPANS = st.lists(st.tuples(st.integers(0, 50), st.integers(0, 20)), max_size=40)


@given(SPANS, st.integers(1, 8))
@examples(300)
def test_spans_stay_apart_and_keep_what_was_worked(steps: list[tuple[int, int]], most: int) -> None:
    kept: list[tuple[float, float]] = []
    now = 0.0
    for pause, length in steps:
        now += pause + length
        kept = with_span(kept, now - length, now, joined=0.5, most=most)
    assert len(kept) <= most
    assert sum(last - first for first, last in kept) == sum(length for _, length in steps)
    edges = [edge for each in kept for edge in each]
    assert edges == sorted(edges)
    assert not edges or edges[-1] <= now


@given(SPANS, st.integers(0, 500))
@examples(200)
def test_after_the_clock_was_set_back_nothing_lies_ahead(steps: list[tuple[int, int]], back: int) -> None:
    kept: list[tuple[float, float]] = []
    now = 0.0
    for pause, length in steps:
        now += pause + length
        kept = with_span(kept, now - length, now, joined=0.5, most=100)
    assume(back < now)
    before = seconds_within(kept, 0, now - back)
    after = with_span(kept, now - back, now - back, joined=0.5, most=100)
    assert all(last <= now - back for _, last in after)
    assert seconds_within(after, 0, now) == before


# What a station made in a shift.


def early(now: float = MORNING) -> Shift:
    found = shift_at(EARLY, now)
    assert found is not None
    return found


def test_availability_of_a_shift_is_what_was_worked_of_it_without_its_breaks() -> None:
    station = Station(MORNING - 3 * HOUR)  # 05:00
    station.packml("execute")
    station.after(2 * HOUR).packml("held")  # 07:00
    station.after(HOUR).packml("execute")  # 08:00
    station.after(2 * HOUR)  # 10:00, with a break of half an hour
    figures = station.figures()
    counted, available = figures.seconds_of(early(), station.now)
    assert (counted, available) == (3.5 * HOUR, 2.5 * HOUR)
    trend = figures.trend_of(early(), station.now)
    assert [share for _, share in trend[:6]] == [1.0] * 6, "until 07:00"
    assert trend[11] == (MORNING, 0.5)
    assert trend[-1][1] == pytest.approx(2.5 / 3.5)


def test_work_in_a_break_is_not_counted() -> None:
    station = Station(MORNING + HOUR)
    station.packml("execute")
    station.after(0.5 * HOUR)
    assert station.figures().seconds_of(early(), station.now) == (0, 0)


def test_a_station_that_stands_still_in_its_shift_is_not_available() -> None:
    """Also where it never worked, or has no order: somebody has planned that it works."""
    station = Station(MORNING - 2 * HOUR, by_order=True)
    station.packml("suspended")
    station.after(HOUR)
    assert station.figures().seconds_of(early(), station.now) == (HOUR, 0)


def test_a_station_is_not_blamed_for_the_time_before_it_was_known() -> None:
    station = Station(MORNING)
    station.packml("execute")
    station.after(HOUR)
    figures = station.figures()
    assert figures.seconds_of(early(), station.now) == (HOUR, HOUR)
    assert figures.counted_from(early()) == MORNING


def test_while_the_controller_was_away_nothing_was_worked() -> None:
    station = Station(MORNING - 2 * HOUR)
    station.packml("execute")
    station.after(HOUR).tick()
    station.after(HOUR).begin()
    station.monotonic = 5.0
    assert station.figures().seconds_of(early(), station.now) == (2 * HOUR, HOUR)


def test_products_are_those_that_were_done_in_the_shift_also_over_midnight() -> None:
    night = {"night": times(22, 30)}
    station = Station(MORNING + 13.5 * HOUR)  # 21:30
    for minutes in (0, 20, 20, 120, 120, 120):  # done at 21:30, 21:50, 22:10, 00:10, 02:10, 04:10
        station.after(minutes * 60).tick(activated=["take"])
        station.tick(completed=["give"])
    figures = station.figures()
    found = shift_at(night, station.now)
    assert found is not None
    assert figures.made_in(found) == 4
    assert figures.count == 3, "today"


def test_figures_that_were_kept_before_there_were_shifts_go_on() -> None:
    station = Station(MORNING - 2 * HOUR)
    station.packml("execute")
    station.after(HOUR).tick()
    kept = station.figures().model_dump()
    for new in ("watched", "worked", "done"):
        del kept[new]
    figures = DayFigures.model_validate(kept)
    station.after(HOUR)
    figures.pass_to(station.now, station.monotonic)
    assert figures.counted == 2 * HOUR
    assert figures.seconds_of(early(), station.now) == (HOUR, HOUR)


def test_a_server_started_anew_goes_on_with_the_shift() -> None:
    station = Station(MORNING - 2 * HOUR)
    station.packml("execute")
    for _ in range(5):
        station.after(600).tick(activated=["take"])
        station.tick(completed=["give"])
    ledger = station.ledger()
    again = Ledger.model_validate_json(ledger.model_dump_json())
    assert again.figures.seconds_of(early(), station.now) == ledger.figures.seconds_of(early(), station.now)
    assert again.figures.made_in(early()) == 5


def test_a_shift_written_while_it_is_on_is_counted_from_its_beginning() -> None:
    """What was worked is known; what it is to be compared with may change at any time."""
    station = Station(MORNING - 2 * HOUR)
    station.packml("execute")
    station.after(HOUR).packml("held")
    station.after(HOUR)
    figures = station.figures()
    written = shift_at({"short": times(7, 9)}, station.now)
    assert written is not None
    assert figures.seconds_of(early(), station.now) == (2 * HOUR, HOUR)
    assert figures.seconds_of(written, station.now) == (HOUR, 0)
