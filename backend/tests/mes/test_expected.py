"""When orders are expected to begin and to be ready."""

from __future__ import annotations

import itertools
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.controller.views.details import WorkMastersView, WorkMasterView, WorkOperationView
from sequence_planner.controller.views.station import JobView, PlanView, StationView
from sequence_planner.db.database import Database
from sequence_planner.execution.vocabulary import JobState, Mode, PlanStatus, Production
from sequence_planner.mes import expected as reckoning
from sequence_planner.mes import responses
from sequence_planner.mes.expected import CycleTimes, ExpectedTimes, expected
from sequence_planner.mes.order import JobOrder, OrderState, Wish
from sequence_planner.mes.queue import in_the_way
from sequence_planner.mes.responses import JobOutcome, JobResponse
from support.example_view import example_job, example_view
from support.examples import examples

NOW = 10_000.0


def master(*operations: str) -> WorkMasterView:
    each = {name: WorkOperationView(title=name, after=[], goal_reads=[]) for name in operations}
    return WorkMasterView(title="", brings=[], brought=[], operations=each, alternatives=[], arbitrary=[])


MASTERS = WorkMastersView(
    work_masters={
        "engine": master("bolt", "kit"),
        "cover": master("kit"),
        "pump": master("pump"),
        "valve": master("valve"),
    },
    abilities={},
)
MADE = {"engine": [400.0, 420.0, 900.0], "cover": [60.0], "pump": [100.0]}  # of a valve none was ever made


def times() -> CycleTimes:
    known = CycleTimes()
    for name, all_seconds in MADE.items():
        for seconds in all_seconds:
            known.add_response(made(name, seconds))
    return known


def made(work_master: str, seconds: float, **more: object) -> dict[str, Any]:
    times = {"began": 100.0, "ended": 100.0 + seconds}
    return {"work_master": work_master, "outcome": "completed", "operations": [], **times, **more}


def order(number: int, work_master: str = "engine", **more: object) -> JobOrder:
    fields = {
        "number": number,
        "id": f"o{number}",
        "work_master": work_master,
        "state": OrderState.ALLOWED_TO_START,
        "revision": 1,
        "stored": 0.0,
        "stored_by": "MES",
        "changed": 0.0,
        "handed_over": None,
        "began": None,
        "ended": None,
        "wish": None,
        "wished_by": None,
        "wished_because": None,
        "removed": None,
    }
    return JobOrder.model_validate(fields | more)


def worked(number: int, work_master: str = "engine", **more: object) -> JobOrder:
    return order(number, work_master, **{"state": OrderState.RUNNING, "handed_over": 1.0, "began": NOW - 100, **more})


def job(order: JobOrder, **more: object) -> JobView:
    return example_job(work_master=order.work_master, **more)


def station(*orders: JobOrder, **more: object) -> StationView:
    jobs = {each.id: job(each) for each in orders if each.is_at_station}
    return example_view(**{"by_order": True, "mode": Mode.AUTOMATIC, "jobs": jobs, **more})


def ends(*orders: JobOrder, view: StationView | None = None) -> list[float | None]:
    found = expected(orders, times(), MASTERS, view or station(*orders), NOW)
    return [found[each.id].end if each.id in found else None for each in orders]


def test_it_takes_as_long_as_the_median_of_what_was_completed() -> None:
    known = times()
    assert known.seconds("engine") == 420.0
    assert known.seconds("valve") is None
    known.add_response(made("engine", 1.0, outcome="aborted"))
    known.add_response(made("engine", 1.0, began=None))
    known.add_response(made("engine", -50.0))
    assert known.seconds("engine") == 420.0


def test_an_order_of_which_most_was_done_before_it_began_tells_nothing() -> None:
    found, done = {"started": None, "ended": 100.0}, {"started": 110.0, "ended": 120.0}
    known = CycleTimes()
    known.add_response(made("engine", 36.0, operations=[found, found, done]))
    assert known.seconds("engine") is None
    known.add_response(made("engine", 90.0, operations=[found, done]))
    assert known.seconds("engine") == 90.0


def test_it_follows_the_pace_of_the_last_ones() -> None:
    known = CycleTimes()
    for seconds in (900.0, *(100.0 for _ in range(reckoning.REMEMBERED))):
        known.add_response(made("engine", seconds))
    assert known.seconds("engine") == 100.0


def test_one_after_the_other_is_expected_where_they_are_in_each_others_way() -> None:
    found = expected(all_ := [worked(1), order(2), order(3)], times(), MASTERS, station(*all_), NOW)
    assert found["o1"] == ExpectedTimes(None, NOW + 320)
    assert found["o2"] == ExpectedTimes(NOW + 320, NOW + 740)
    assert found["o3"] == ExpectedTimes(NOW + 740, NOW + 1160)
    assert ends(worked(1), order(2, "pump")) == [NOW + 320, NOW + 100]


def test_one_that_takes_longer_is_expected_when_others_were_that_did() -> None:
    assert ends(worked(1, began=NOW - 500), order(2)) == [NOW + 400, NOW + 820]
    assert ends(worked(1, began=NOW - 950), order(2)) == [NOW + 40, NOW + 460], "a bit longer than any"


def test_of_one_that_takes_longer_than_any_nobody_knows_nor_of_what_follows() -> None:
    assert ends(worked(1, began=NOW - 5000), order(2), order(3, "pump")) == [None, None, NOW + 100]


def running(**more: object) -> PlanView:
    step = {"resource": "nutrunner", "ability": "robot.move", "started": NOW - 20, "expected_end": NOW - 1, **more}
    plan = example_view().plan
    return plan.model_copy(update={"steps": [plan.steps[0].model_copy(update=step)]})


@pytest.mark.parametrize(
    ("kind", "since", "resource", "ended", "known"),
    [
        ("overdue", NOW - 5, "nutrunner", None, False),
        ("still", NOW - 5, "nutrunner", None, False),
        ("silent", NOW - 50, "nutrunner", None, False),
        ("given-up", NOW - 50, "nutrunner", None, True),  # and yet something else was begun there
        ("overdue", NOW - 5, "nutrunner", NOW - 1, True),
        ("overdue", NOW - 5, "robot", None, True),
        ("forced", NOW - 5, "nutrunner", None, True),
    ],
)
def test_while_all_that_runs_is_stopped_nobody_knows(
    kind: str, since: float, resource: str, ended: float | None, known: bool
) -> None:
    told = {"kind": kind, "since": since, "resources": [resource], "ended": ended}
    alarm = example_view().alarms["slow"].model_copy(update=told)
    view = station(worked(1), plan=running(), alarms={f"{kind}:x": alarm})
    assert ends(worked(1), order(2), view=view) == ([NOW + 320, NOW + 740] if known else [None, None])


def test_while_a_person_takes_longer_than_people_do_nobody_knows() -> None:
    def waiting(since: float) -> StationView:
        plan = running(ability="operator.place", resource="operator", started=since - 5, expected_end=since)
        return station(worked(1), plan=plan)

    assert ends(worked(1), view=waiting(NOW - 8)) == [NOW + 320]
    assert ends(worked(1), view=waiting(NOW - 12)) == [None]


def test_without_a_plan_for_what_is_to_be_done_nobody_knows() -> None:
    plan = example_view().plan.model_copy(update={"status": PlanStatus.NONE, "steps": []})
    assert ends(worked(1), order(2), view=station(worked(1), plan=plan)) == [None, None]
    idle = {name: each.model_copy(update={"active": False}) for name, each in example_view().operations.items()}
    assert ends(order(1), view=station(plan=plan, operations=idle)) == [NOW + 420]


def test_nothing_is_expected_where_nobody_knows() -> None:
    assert ends(worked(1, "valve"), order(2, "valve"), order(3)) == [None, None, NOW + 420]
    interrupted = worked(1, state=OrderState.INTERRUPTED)
    assert ends(interrupted, order(2)) == [None, None]
    assert ends(worked(1, wish=Wish.STOP), order(2)) == [None, None]
    paused = station(running := worked(1), jobs={"o1": job(running, state=JobState.PAUSED)})
    assert ends(running, order(2), view=paused) == [None, None]
    assert ends(order(1, state=OrderState.NOT_ALLOWED_TO_START)) == [None]
    strange = station(jobs={"strange": job(order(9))})
    assert ends(order(1), order(2, "pump"), view=strange) == [None, NOW + 100]
    for still in ({"by_order": False}, {"mode": Mode.HOLD}, {"production": Production.WAITING}):
        assert ends(worked(1), order(2), view=station(worked(1), **still)) == [None, None]
    assert expected([order(1)], times(), MASTERS, None, NOW) == {}


def test_what_may_begin_only_later_is_passed_by() -> None:
    late = order(1, earliest=NOW + 500)
    assert ends(late, order(2), order(3)) == [NOW + 1260, NOW + 420, NOW + 840]


ORDERS = st.lists(
    st.tuples(st.sampled_from([*MASTERS.work_masters]), st.none() | st.integers(-100, 900), st.booleans()), max_size=8
)


@examples(200)
@given(ORDERS)
def test_no_two_in_each_others_way_are_expected_at_the_same_time(drawn: list[tuple[str, int | None, bool]]) -> None:
    all_ = [
        order(number, name, earliest=None if wait is None else NOW + wait)
        for number, (name, wait, _) in enumerate(drawn)
    ]
    found = expected(all_, times(), MASTERS, station(*all_), NOW)
    known = [(each, found[each.id]) for each in all_ if each.id in found]
    for each, its in known:
        assert its.start is not None
        assert its.start >= max(NOW, each.earliest or NOW)
        seconds = times().seconds(each.work_master)
        assert its.end == (None if seconds is None else its.start + seconds)
    for (one, first), (other, second) in itertools.combinations(known, 2):
        if in_the_way(MASTERS, one.work_master, other.work_master):
            spans = sorted((first, second), key=lambda each: (each.start or 0.0, each.end is None))
            assert spans[0].end is not None
            assert spans[1].start is not None
            assert spans[0].end <= spans[1].start
    # What can be told is: all but what comes after a valve.
    assert {each.id for each in all_ if each.work_master != "valve"} <= found.keys()


def test_what_was_made_is_read_on_also_of_cleared_orders(database: Database) -> None:
    known = CycleTimes()
    with database.writing() as connection:
        known.read_on(connection)
        assert known.seconds("engine") is None
        for number, seconds in enumerate((100.0, 300.0)):
            response = JobResponse(
                job_order=f"o{number}",
                work_master="engine",
                description="",
                outcome=JobOutcome.COMPLETED,
                began=50.0,
                ended=50.0 + seconds,
                operations=[],
                abilities=[],
                deviations=[],
                corrections=[],
            )
            responses.write(connection, response, NOW)
            responses.remove(connection, response.job_order, NOW)
            known.read_on(connection)
            known.read_on(connection)
            assert known.seconds("engine") == (100.0, 200.0)[number]
