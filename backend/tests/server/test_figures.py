"""The figures of the day over REST, of what the run's journal and the orders say."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from journal.happened import with_writer
from mes.test_ledger import moment
from sequence_planner.controller.views.details import ShiftTimesView
from sequence_planner.controller.views.station import JobView
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.journal.writer import RunWriter
from sequence_planner.mes.figures import end_of_day, start_of_day
from support.example_view import example_view
from support.server import Server
from support.waiting import until

from .example_answers import SHIFTS, WORK_MASTERS
from .test_job_orders import controller, mes, store
from .test_looking import Telling

__all__ = ["controller", "mes"]

PLACE = "/api/v1/figures"


@pytest.fixture(autouse=True)
def _noon(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The station stands where it is noon."""
    monkeypatch.setenv("TZ", f"STN{int(time.time() // 3600 % 24) - 12}")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def figures(client: httpx.Client) -> dict[str, Any]:
    found: dict[str, Any] = client.get(PLACE).raise_for_status().json()
    return found


def write(server: Server, *records: tuple[str, float, dict[str, Any]]) -> None:
    async def writing(writer: RunWriter) -> None:
        for kind, at, content in records:
            writer.write(kind, at, json.dumps(content))

    with_writer(server.identity.database, writing)


def job(name: str, state: str, taken: float, ended: float | None = None) -> dict[str, Any]:
    its = {"id": name, "work_master": "truck_engine", "title": name, "taken": moment(taken), "state": state}
    return its if ended is None else {**its, "ended": moment(ended)}


def test_of_a_station_that_has_done_nothing_nothing_is_known(mes: httpx.Client) -> None:
    found = figures(mes)
    assert (found["in_work"], found["cycle"], found["availability"]) == ([], None, None)
    assert found["made"] == {"count": 0, "planned": None, "by_now": None, "by_order": 0, "to_make": 0}
    assert found["day"] <= found["time"]
    assert (found["shift"], found["next_shift"]) == (None, None), "it has no shifts"


def test_what_was_made_of_what_is_due_and_how_long_the_station_worked(
    mes: httpx.Client, server: Server, controller: Telling
) -> None:
    now, monotonic = time.time(), time.monotonic()
    for name, due in (("done", now - 1), ("late", now - 1), ("today", end_of_day(now) - 1), ("tomorrow", now + 90_000)):
        store(mes, name, id=name, due=due, start=True)
    begun = {"values": {}, "senses": {}, "memory": {}, "jobs": {}, "mode": "automatic", "by_order": True}
    write(
        server,
        ("begun", now - 100, begun),
        (
            "ticked",
            now - 100,
            {"now": [now - 100, monotonic - 100], "jobs": {"done": job("done", "running", now - 100)}},
        ),
        ("packml", now - 90, {"state": "execute", "since": now - 90, "monotonic": monotonic - 90}),
        (
            "ticked",
            now - 10,
            {"now": [now - 10, monotonic - 10], "jobs": {"done": job("done", "ended", now - 100, now - 10)}},
        ),
        ("packml", now - 10, {"state": "held", "since": now - 10, "monotonic": monotonic - 10}),
    )
    until(lambda: figures(mes)["made"]["count"] == 1, seconds=20)
    assert figures(mes)["made"] == {"count": 1, "planned": 3, "by_now": 2, "by_order": 1, "to_make": 3}
    availability = figures(mes)["availability"]
    assert availability["available"] == 80
    assert 90 <= availability["counted"] < 120
    assert availability["share"] == availability["available"] / availability["counted"]
    store(mes, "held back", id="held", due=now - 1, start=False)
    until(lambda: figures(mes)["made"]["planned"] == 4, seconds=20)
    assert figures(mes)["made"]["to_make"] == 3, "nobody has released it"
    until(lambda: figures(mes)["cycle"] is not None, seconds=20)
    cycle = figures(mes)["cycle"]
    assert (cycle["work_master"], cycle["last"], cycle["median"]) == ("truck_engine", [90.0], 90.0)
    controller.show(example_view(jobs={"late": shown(now - 5)}))
    until(lambda: len(figures(mes)["in_work"]) == 1)
    in_work = figures(mes)["in_work"][0]
    assert (in_work["job"], in_work["title"], in_work["began"]) == ("late", "Engine 4711", now - 5)


def test_what_was_made_in_the_shift_that_is_on(
    mes: httpx.Client, server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a station that works freely, at noon; it was first heard of in the shift before."""
    now, monotonic = time.time(), time.monotonic()
    began = start_of_day(now) + (int(now - start_of_day(now)) // 60 - 10) * 60  # ten minutes ago and a bit
    minute = round(began - start_of_day(now)) // 60
    title = {"en": "Early shift", "sv": "Förmiddag"}
    shifts = {
        "early": ShiftTimesView(
            title=title, minutes=(minute, minute + 300), days=[*range(7)], breaks=[(minute, minute + 5)]
        ),
        "before": ShiftTimesView(title={}, minutes=(minute - 60, minute), days=[*range(7)], breaks=[]),
    }
    monkeypatch.setitem(SHIFTS.shifts, "early", shifts["early"])
    monkeypatch.setitem(SHIFTS.shifts, "before", shifts["before"])
    begun = {"values": {}, "senses": {}, "memory": {}, "jobs": {}, "mode": "automatic", "by_order": False}

    def ticked(at: float, **content: object) -> tuple[str, float, dict[str, Any]]:
        return "ticked", at, {"now": [at, monotonic - now + at], **content}

    def packml(at: float, state: str) -> tuple[str, float, dict[str, Any]]:
        return "packml", at, {"state": state, "since": at, "monotonic": monotonic - now + at}

    write(
        server,
        ("begun", began - 400, begun),
        packml(began - 300, "execute"),
        ticked(began - 200, activated=["tighten"]),
        ticked(began - 100, completed=["tighten"]),
        ticked(began + 100, activated=["tighten"]),
        ticked(began + 200, completed=["tighten"]),
        packml(began + 450, "held"),
    )
    until(lambda: figures(mes)["made"]["count"] == 2, seconds=20)
    found = figures(mes)
    assert (found["shift"]["name"], found["shift"]["title"], found["shift"]["made"]) == ("early", title, 1)
    assert (found["shift"]["begins"], found["shift"]["ends"]) == (began, began + 300 * 60)
    availability = found["shift"]["availability"]
    assert availability["available"] == pytest.approx(150), "after the break"
    assert availability["counted"] == pytest.approx(found["time"] - began - 300)
    assert availability["share"] == availability["available"] / availability["counted"]
    assert availability["since"] == began
    assert (found["next_shift"]["name"], found["next_shift"]["begins"]) == ("before", began - 3600 + 86_400)

    monkeypatch.delitem(SHIFTS.shifts, "early")
    until(lambda: figures(mes)["shift"] is None, seconds=20)
    assert figures(mes)["next_shift"]["name"] == "before"
    assert figures(mes)["availability"] is not None, "that of the day"


def shown(taken: float) -> JobView:
    return JobView(
        title="Engine 4711",
        work_master="truck_engine",
        state=JobState.RUNNING,
        stopping=False,
        taken=taken,
        begun=taken,
        ended=None,
        waits_for=[],
        waits_for_messages=[],
        sentence=None,
        steps={},
    )


def test_without_orders_the_products_are_counted_where_the_model_tells(mes: httpx.Client, server: Server) -> None:
    now, monotonic = time.time(), time.monotonic()
    begun = {"values": {}, "senses": {}, "memory": {}, "jobs": {}, "mode": "automatic", "by_order": False}

    def ticked(ago: float, **content: object) -> tuple[str, float, dict[str, Any]]:
        return "ticked", now - ago, {"now": [now - ago, monotonic - ago], **content}

    write(
        server,
        ("begun", now - 100, begun),
        ticked(90, activated=["tighten"]),
        ticked(60, completed=["tighten"]),
        ticked(50, activated=["tighten"]),
    )
    until(lambda: figures(mes)["made"]["count"] == 1, seconds=20)
    found = figures(mes)
    assert found["made"]["planned"] is None
    assert (found["cycle"]["median"], found["cycle"]["last"]) == (30.0, [30.0])
    assert [(each["job"], each["began"]) for each in found["in_work"]] == [(None, now - 50)]


def test_where_the_model_does_not_tell_what_a_product_is_no_number_is_made_up(
    mes: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine = WORK_MASTERS.work_masters["truck_engine"]
    monkeypatch.setitem(WORK_MASTERS.work_masters, "truck_engine", engine.model_copy(update={"operations": {}}))
    until(lambda: figures(mes)["made"]["count"] is None, seconds=20)


def test_a_silent_controller_has_no_figures(mes: httpx.Client, controller: Telling) -> None:
    controller.stop()
    until(lambda: mes.get(PLACE).status_code == 503, seconds=10)
