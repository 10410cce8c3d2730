"""The order of work of orders: found, shown, and kept to, though the station does not work on them here."""

from __future__ import annotations

import time
from itertools import pairwise

import httpx
import pytest

from sequence_planner.controller.commands.jobs import SequenceJobs, TakeJob
from sequence_planner.controller.views.details import WorkMasterView, WorkOperationView
from sequence_planner.controller.views.station import JobStepState, JobStepView, JobView
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.mes.scheduling.problem import KnownTimes
from sequence_planner.server.api import job_orders
from support.example_view import example_job
from support.server import Server
from support.waiting import until

from .example_answers import WORK_MASTERS
from .test_job_orders import ORDERS, controller, mes, store, tell
from .test_looking import Telling

__all__ = ["controller", "mes"]

PLACE = "/api/v1/schedule"


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(job_orders, "LOOK_EVERY", 0.05)
    monkeypatch.setattr(job_orders, "ASK_EVERY", 0.2)
    monkeypatch.setattr(job_orders, "LIMIT", 20.0)
    for name in ("left", "right"):  # before the server asks what there is
        monkeypatch.setitem(WORK_MASTERS.work_masters, name, master(name))


def master(title: str) -> WorkMasterView:
    operation = WorkOperationView(title=title, after=[], goal_reads=["robot.pose"])
    return WorkMasterView(
        title=title,
        brings=[],
        brought=[],
        operations={f"work {title}": operation},
        alternatives=[],
        arbitrary=[],
    )


def job(title: str, state: JobStepState, started: float | None) -> JobView:
    step = JobStepView(state=state, waits_for=[], started=started, ended=None)
    return example_job(title=title, work_master=title, steps={f"work {title}": step})


def test_orders_are_to_begin_as_they_are_due(mes: httpx.Client) -> None:
    assert mes.get(PLACE).json()["time"] is None
    now = time.time()
    for name, due in (("late", 300), ("early", 100), ("never", None), ("middle", 200)):
        store(mes, name, id=name, due=None if due is None else now + due, priority=0, start=True)

    def found() -> list[str]:
        answer = mes.get(PLACE).raise_for_status().json()
        return [] if answer["fallback"] else [each["id"] for each in answer["job_orders"]]

    until(lambda: found()[:3] == ["early", "middle", "late"], seconds=30)
    answer = mes.get(PLACE).json()
    assert answer["optimal"]
    assert answer["tardiness"] == answer["bound"] == 0
    times = [each["operations"][0] for each in answer["job_orders"]]
    assert all(one["end"] <= other["start"] + 0.01 for one, other in pairwise(times))
    store(mes, "urgent", id="urgent", due=now + 1, priority=9, start=True)
    until(lambda: len(found()) == 5, seconds=30)
    assert mes.get(PLACE).json()["job_orders"][0]["late"] > 0
    assert [each["id"] for each in mes.get(PLACE, params={"limit": 2}).json()["job_orders"]] == ["urgent", "early"]
    shown: dict[str, str | int] = {"state": "AllowedToStart", "sort": "work", "limit": 2}
    first = mes.get(ORDERS, params=shown).json()
    assert [each["id"] for each in first["job_orders"]] == ["urgent", "early"]
    rest = mes.get(ORDERS, params=shown | {"cursor": first["next"], "limit": 3}).json()
    assert ([each["id"] for each in rest["job_orders"]], rest["next"]) == (["middle", "late", "never"], None)
    for name in ("late", "early", "never", "middle", "urgent"):
        assert tell(mes, name, "Abort").status_code == 200


def waits_told(controller: Telling) -> list[tuple[str, str]]:
    """Which job waits for which, as the controller was told last."""
    said = [each for each in controller.commands if isinstance(each, SequenceJobs)]
    return [(wait.job, each.job) for wait in said[-1].waits for each in wait.for_] if said else []


def test_what_cannot_be_put_into_an_order_leaves_the_order_there_was(
    mes: httpx.Client, controller: Telling, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("left", "right"):
        store(mes, name, id=name, work_master=name, due=None, start=True)
    until(lambda: mes.get(PLACE).json()["time"] is not None, seconds=30)
    monkeypatch.setattr(KnownTimes, "seconds", lambda *_: 1e9)
    store(mes, "endless", id="endless", work_master="left", due=None, start=True)
    steps = {"left": JobStepState.ACTIVE, "right": JobStepState.ELIGIBLE, "endless": JobStepState.ELIGIBLE}
    jobs = {name: job(name, state, 1.0 if name == "left" else None) for name, state in steps.items()}
    controller.show(controller.view.model_copy(update={"jobs": jobs}))
    until(lambda: waits_told(controller) == [("right", "left")], seconds=20)


def test_the_station_is_told_which_operation_waits_for_which(
    mes: httpx.Client, controller: Telling, server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    controller.show(controller.view.model_copy(update={"jobs": {}, "mode": Mode.AUTOMATIC, "by_order": True}))
    for name in ("left", "right"):
        store(mes, name, id=name, work_master=name, due=None, start=True)
    until(lambda: {each.job for each in controller.commands if isinstance(each, TakeJob)} >= {"left", "right"})
    jobs = {
        "left": job("left", JobStepState.ACTIVE, time.time()),
        "right": job("right", JobStepState.ELIGIBLE, None),
    }
    controller.show(controller.view.model_copy(update={"jobs": jobs}))

    until(lambda: waits_told(controller) == [("right", "left")], seconds=30)
    monkeypatch.setattr(job_orders, "HELD_UP", 0.0)  # as after a while in which it was not begun
    controller.show(
        controller.view.model_copy(update={"jobs": jobs | {"left": job("left", JobStepState.ELIGIBLE, None)}})
    )
    until(lambda: waits_told(controller) == [], seconds=20)
