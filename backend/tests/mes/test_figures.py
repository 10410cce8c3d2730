"""The figures of the day, reckoned from records of the run as the controller writes them."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from journal.happened import with_writer
from mes.test_ledger import able, job
from sequence_planner.controller.views.details import WorkMastersView, WorkMasterView, WorkOperationView
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.journal.writer import RunWriter
from sequence_planner.mes import orders
from sequence_planner.mes.figures import CYCLES, DayFigures, end_of_day, first_operations, last_operation, start_of_day
from sequence_planner.mes.order import OrderContent
from sequence_planner.mes.tracker import Ledger, OrderTracker, read
from support.examples import examples

HOUR = 3600.0


@pytest.fixture(autouse=True)
def _zone(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The station stands in Stockholm."""
    monkeypatch.setenv("TZ", "Europe/Stockholm")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


MORNING = 1_780_293_600.0  # 08:00 in Stockholm, on 1 June 2026


def master(**after: list[str]) -> WorkMasterView:
    """Operations and which others each comes after."""
    operations = {name: WorkOperationView(title=name, after=before, goal_reads=[]) for name, before in after.items()}
    return WorkMasterView(title="", brings=[], brought=[], operations=operations, alternatives=[], arbitrary=[])


MASTERS = WorkMastersView(
    work_masters={
        "a": master(take=[], turn=["take"], give=["turn"]),
        "b": master(left=[], right=[], join=["left", "right"]),
        "c": master(one=[], other=[]),
    },
    abilities={"move": able("pose")},
)


class Station:
    """Writes records at times of its own, on a wall clock that can be set."""

    def __init__(self, at: float = MORNING, **whole: object) -> None:
        self.records: list[RunRecord] = []
        self.now, self.monotonic = at, 50.0
        self.begin(**whole)

    def add(self, kind: str, **content: object) -> None:
        number = len(self.records) + 1
        self.records.append(RunRecord(number, self.now, kind, json.dumps(content), ""))

    def begin(self, **whole: object) -> None:
        self.add("begun", **{"values": {}, "senses": {}, "memory": {}, "jobs": {}, "by_order": False, **whole})

    def after(self, seconds: float) -> Station:
        self.now += seconds
        self.monotonic += seconds
        return self

    def tick(self, **content: object) -> None:
        self.add("ticked", now=[self.now, self.monotonic], **content)

    def alarm(self, key: str, resource: str, ended: float | None = None) -> None:
        content = {"alarm": key, "kind": key.partition(":")[0], "resources": [resource], "ended": ended}
        self.records.append(RunRecord(len(self.records) + 1, self.now, "alarm", json.dumps(content), ""))

    def packml(self, state: str) -> None:
        self.add("packml", state=state, since=self.now, monotonic=self.monotonic)

    def ledger(self) -> Ledger:
        ledger = Ledger()
        for record in self.records:
            ledger.process(read(record), MASTERS)
        return ledger

    def figures(self) -> DayFigures:
        known = self.ledger().figures
        known.pass_to(self.now, self.monotonic)
        return known


def test_the_day_is_that_of_the_station() -> None:
    assert time.strftime("%H:%M", time.localtime(MORNING)) == "08:00"
    assert (MORNING - start_of_day(MORNING), end_of_day(MORNING) - MORNING) == (8 * HOUR, 16 * HOUR)
    summer_begins = 1_774_738_800.0  # 00:00 on 29 March 2026: a day of 23 hours
    assert end_of_day(summer_begins) - start_of_day(summer_begins) == 23 * HOUR
    assert end_of_day(summer_begins) == start_of_day(end_of_day(summer_begins))


def test_availability_is_the_time_in_execute_since_the_station_worked_first() -> None:
    station = Station()
    station.packml("idle")
    station.after(600).packml("execute")  # nobody had started production before
    station.after(900).packml("held")
    station.after(300).packml("execute")
    station.after(600)
    figures = station.figures()
    assert figures.since == MORNING + 600
    assert (figures.counted, figures.available) == (1800, 1500)
    assert figures.availability == pytest.approx(1500 / 1800)
    assert figures.trend[0] == (MORNING + 1500, 1.0)


def test_a_stop_is_not_available_though_the_state_is_execute() -> None:
    station = Station()
    station.packml("execute")
    station.tick(started=["nutrunner.run", "robot.move"])
    station.after(100).alarm("overdue:nutrunner.run", "nutrunner")
    station.after(50).tick(ended=["robot.move"])
    assert station.figures().available == 150, "the robot went on"
    stopped = station.after(300).figures()
    assert (stopped.counted, stopped.available) == (450, 150)
    assert sum(last - first for first, last in stopped.worked) == 150, "and so in a shift"
    station.alarm("overdue:nutrunner.run", "nutrunner", ended=station.now)
    station.after(50).tick(ended=["nutrunner.run"], started=["robot.move"])
    assert station.figures().available == 200
    station.alarm("silent:camera", "camera")
    assert station.after(60).figures().available == 260, "what is silent and not needed stops nothing"


def test_what_was_called_off_as_the_station_was_held_runs_no_more() -> None:
    station = Station()
    station.packml("execute")
    station.tick(started=["robot.move"])
    station.after(60).packml("stopped")
    station.packml("execute")
    station.tick(started=["nutrunner.run"])
    station.alarm("still:nutrunner", "nutrunner")
    assert station.after(60).figures().available == 60
    station.begin()
    station.packml("execute")
    station.tick(started=["nutrunner.run"])
    assert station.after(60).figures().available == 120, "alarms of before are none any more"


def test_nothing_is_known_before_the_station_worked() -> None:
    station = Station()
    station.packml("idle")
    assert station.after(HOUR).figures().availability is None
    assert DayFigures().availability is None


def test_time_without_an_order_does_not_count_while_it_works_by_order() -> None:
    station = Station(by_order=True)
    station.packml("suspended")
    assert station.after(HOUR).figures().since is None, "the day begins with the first order"
    station.tick(jobs={"a": job("a")})
    station.packml("execute")
    station.after(600).tick(jobs={"a": job("a", "ended", ended={"epoch": station.now, "monotonic": 0.0})})
    station.packml("suspended")
    figures = station.after(HOUR).figures()
    assert (figures.counted, figures.available) == (600, 600)
    freely = Station(by_order=False)
    freely.packml("execute")
    freely.after(600).packml("suspended")
    assert freely.after(600).figures().availability == 0.5, "nobody says that there is nothing to do"


def test_while_the_controller_is_away_nothing_is_available() -> None:
    station = Station()
    station.packml("execute")
    station.after(600).tick()
    station.after(600).begin()
    station.packml("execute")
    figures = station.after(600).figures()
    assert (figures.counted, figures.available) == (1800, 1200)


def test_a_new_day_begins_at_midnight() -> None:
    station = Station()
    station.packml("execute")
    station.after(600).packml("held")
    station.tick(activated=["take"])
    station.after(60).tick(completed=["give"])
    station.after(14 * HOUR).packml("execute")
    station.after(2 * HOUR).tick()
    figures = station.after(HOUR).figures()
    midnight = start_of_day(station.now)
    assert (figures.day, figures.since) == (midnight, midnight)
    assert figures.counted == figures.available == station.now - midnight
    assert (figures.count, figures.made) == (0, [])
    assert figures.cycles == {"a": [60.0]}, "how long a product takes does not begin anew"


def test_what_stands_at_midnight_is_not_counted_until_it_works() -> None:
    station = Station()
    station.packml("execute")
    station.after(600).packml("held")
    station.after(22 * HOUR).packml("execute")
    figures = station.after(60).figures()
    assert (figures.since, figures.availability) == (station.now - 60, 1.0)


@pytest.mark.parametrize("step", [-7200.0, -2.0, 5400.0])
def test_a_clock_that_is_set_changes_no_duration(step: float) -> None:
    station = Station(at=MORNING + 4 * HOUR)
    station.packml("execute")
    station.after(300).tick()
    station.now += step
    station.tick()
    station.after(300).packml("held")
    station.after(600)
    figures = station.figures()
    assert (figures.counted, figures.available) == (1200, 600)


def test_a_clock_that_is_set_to_another_day_begins_that_day() -> None:
    station = Station()
    station.packml("execute")
    station.after(600).tick()
    station.now -= 48 * HOUR
    station.tick()
    figures = station.after(60).figures()
    assert figures.day == start_of_day(station.now)
    assert figures.counted <= 60


def test_of_jobs_those_count_that_were_completed() -> None:
    station = Station(by_order=True)
    for number, (name, state) in enumerate([("a", "ended"), ("b", "stopped"), ("c", "aborted"), ("a2", "ended")]):
        station.after(60).tick(jobs={name: job(name)})
        over = {"ended": {"epoch": station.now, "monotonic": 0.0}}
        station.after(60).tick(jobs={name: job(name, state, **over)})
        assert number < len(station.records)
    figures = station.figures()
    assert (figures.count, [each.job for each in figures.made]) == (2, ["a", "a2"])


def test_a_product_that_is_made_freely_ends_with_the_last_operation() -> None:
    station = Station()
    for seconds in (100.0, 120.0, 110.0):
        station.tick(activated=["take"])
        station.after(seconds / 2).tick(completed=["take"], activated=["turn"])
        station.after(seconds / 2).tick(completed=["give"])
    figures = station.figures()
    assert figures.cycles == {"a": [100.0, 120.0, 110.0]}
    assert (figures.count, figures.open) == (3, {"a": None})


def test_the_time_in_which_the_station_is_paused_is_not_that_of_the_next_product() -> None:
    station = Station()
    station.packml("execute")
    station.tick(activated=["take"], started=["move"])
    station.after(100).tick(completed=["give"], activated=["take"])  # then it pauses, as somebody has asked for it
    station.packml("held")
    assert station.after(600).figures().in_work() == {}
    station.tick(started=["move"])
    begun = station.now
    station.after(1).packml("execute")
    assert station.figures().in_work() == {"a": begun}
    station.after(89).tick(completed=["give"])
    assert station.figures().cycles == {"a": [100.0, 90.0]}


def test_a_pause_within_a_product_is_of_its_time() -> None:
    station = Station()
    station.packml("execute")
    station.tick(activated=["take"], started=["move"])
    station.after(10).packml("held")
    station.after(600).packml("execute")
    station.tick(started=["move"])
    station.after(10).tick(completed=["give"])
    assert station.figures().cycles == {"a": [620.0]}


def test_where_the_begin_was_not_seen_the_product_counts_and_has_no_time() -> None:
    station = Station()
    station.after(60).tick(activated=["give"])
    station.after(60).tick(completed=["give"])
    station.tick(activated=["right"])  # whether the left part was there already nobody knows
    station.after(60).tick(completed=["join"])
    station.tick(activated=["left"])
    station.after(5).tick(activated=["right"])
    station.after(60).tick(completed=["join"])
    station.tick(completed=["one", "other"])  # neither of the two comes last
    figures = station.figures()
    assert (figures.count, figures.cycles) == (3, {"b": [65.0]})


def test_an_operation_is_counted_once_for_its_job() -> None:
    station = Station()
    station.tick(jobs={"a": job("a")})
    over = {"ended": {"epoch": station.now + 60, "monotonic": 0.0}}
    station.after(60).tick(completed=["give"], jobs={"a": job("a", "ended", **over)})
    assert station.figures().count == 1


def test_the_ends_of_a_work_master_are_what_comes_last_and_first() -> None:
    assert (last_operation(MASTERS.work_masters["a"]), [*first_operations(MASTERS.work_masters["a"])]) == (
        "give",
        ["take"],
    )
    assert last_operation(MASTERS.work_masters["c"]) is None


def test_the_last_cycles_are_remembered() -> None:
    station = Station()
    for number in range(CYCLES + 5):
        station.tick(activated=["take"])
        station.after(10.0 + number).tick(completed=["give"])
    assert station.figures().cycles == {"a": [10.0 + number for number in range(5, CYCLES + 5)]}


ACTS = st.lists(
    st.one_of(
        st.sampled_from(["execute", "suspended", "held", "aborted", "idle"]).map(lambda state: ("packml", state)),
        st.sampled_from([(what, "") for what in ("take", "give", "begin")]),
        st.floats(-5 * HOUR, 30 * HOUR).map(lambda seconds: ("set", seconds)),
        st.floats(0, 9 * HOUR).map(lambda seconds: ("after", seconds)),
    ),
    max_size=25,
)


@examples(200)
@given(ACTS)
def test_whatever_happens_the_figures_can_be(acts: list[tuple[str, Any]]) -> None:
    """No share is beyond all, no figure is larger than the day and the time that has passed."""
    station, passed = Station(), 0.0
    for what, how in acts:
        match what:
            case "packml":
                station.packml(how)
            case "set":
                station.now += how
                passed += abs(how)  # where the controller begins anew, no other clock tells
            case "after":
                station.after(how).tick()
                passed += how
            case "begin":
                station.begin()
            case "take":
                station.tick(activated=["take"])
            case _:
                station.tick(completed=["give"])
    figures = station.figures()
    assert 0 <= figures.available <= figures.counted <= passed + 1e-3
    assert figures.availability is None or 0 <= figures.availability <= 1
    assert all(0 <= share <= 1 for _, share in figures.trend)
    assert all(seconds > 0 for each in figures.cycles.values() for seconds in each)
    assert figures.count == len(figures.made) <= sum(what == "give" for what, _ in acts)


@pytest.mark.parametrize("each_time_anew", [True, False])
def test_however_often_the_server_is_killed_the_figures_are_the_same(database: Database, each_time_anew: bool) -> None:
    """What was counted is kept with how far the journal was read, and nothing is counted twice."""
    station = Station(by_order=True)
    station.packml("execute")
    station.after(60).tick(jobs={"a": job("a")})
    over = {"ended": {"epoch": station.now + 60, "monotonic": 0.0}}
    station.after(60).tick(jobs={"a": job("a", "ended", **over)})
    station.after(60).packml("held")
    station.after(60).tick()
    with database.writing() as connection:
        stored = orders.store(connection, OrderContent(work_master="a", due=7.5), SYSTEM, 1.0, id="a", start=True)
        orders.hand_over(connection, stored, 1.0)
    follower = OrderTracker(database)
    for record in station.records:

        async def write(writer: RunWriter, record: RunRecord = record) -> None:
            writer.write(record.kind, record.time, record.content)

        with_writer(database, write)
        follower = OrderTracker(database) if each_time_anew else follower
        follower.read_on(MASTERS)
    assert follower.figures == station.ledger().figures
    assert (follower.figures.count, follower.figures.available, follower.figures.counted) == (1, 180, 240)
    with database.reading() as connection:
        assert orders.due_times(connection, ["a", "nobody"]) == [7.5]
