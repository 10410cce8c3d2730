"""What the server says to the controller of orders when things go wrong between the two."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.jobs import CommandJob, ForgetJob, TakeJob
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.controller.views.station import JobView
from sequence_planner.execution.vocabulary import JobState, Mode
from sequence_planner.mes import orders, responses
from sequence_planner.mes.order import OrderState
from sequence_planner.mes.responses import JobOutcome, JobResponse
from sequence_planner.server.services import orders as order_dispatch
from sequence_planner.server.settings import Settings
from support.example_view import example_job, example_view
from support.server import Loop, Server
from support.waiting import until

from .test_job_orders import ORDERS, mes, store, tell
from .test_looking import Telling

__all__ = ["mes"]
LOOKS = 1.0  # seconds in which the server looks some times


class Working(Telling):
    """A controller of a station that works by order; it refuses the kinds of commands that it is told to."""

    def __init__(self, loop: Loop, settings: Settings) -> None:
        super().__init__(loop, settings.controller_socket)
        self.view = example_view(by_order=True, mode=Mode.AUTOMATIC, jobs={})
        self.link = ControllerLink(settings.controller_socket, self.handle, self.answer)
        self.refuses: dict[type[Command], str] = {}

    async def handle(self, command: Command) -> None:
        self.commands.append(command)
        if (slug := self.refuses.get(type(command))) is not None:
            raise CommandRefused(slug, "Not now.")

    def said(self, kind: type[Command]) -> list[Any]:
        return [each for each in self.commands if isinstance(each, kind)]

    def shows(self, **jobs: JobState) -> None:
        self.show(self.view.model_copy(update={"jobs": {name: job(state) for name, state in jobs.items()}}))


@pytest.fixture
def controller(loop: Loop, settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Iterator[Working]:
    monkeypatch.setattr(order_dispatch, "SAY_AGAIN", 0.0)
    controller = Working(loop, settings)
    controller.start()
    yield controller
    controller.stop()


def job(state: JobState) -> JobView:
    return example_job(state=state)


def become(server: Server, id: str, state: OrderState) -> None:
    """As another server does that reads the same journal."""
    with server.identity.database.writing() as connection:
        orders.become(connection, orders.get(connection, id), state, server.identity.now(), {})


def handed_over(mes: httpx.Client, controller: Working, id: str) -> None:
    store(mes, id, id=id, start=True)
    until(lambda: bool(controller.said(TakeJob)))


def test_an_order_that_ended_unnoticed_is_not_given_again(
    mes: httpx.Client, controller: Working, server: Server
) -> None:
    handed_over(mes, controller, "engine")
    controller.shows(engine=JobState.ENDED)
    become(server, "engine", OrderState.ENDED)
    until(lambda: bool(controller.said(ForgetJob)))
    given = len(controller.said(TakeJob))
    controller.shows()
    time.sleep(LOOKS)
    assert len(controller.said(TakeJob)) == given


def test_a_job_whose_order_is_over_is_aborted(mes: httpx.Client, controller: Working, server: Server) -> None:
    handed_over(mes, controller, "engine")
    become(server, "engine", OrderState.ABORTED)
    store(mes, "another", id="another")  # the orders are read again
    controller.shows(engine=JobState.RUNNING)
    until(lambda: [(each.job, each.what) for each in controller.said(CommandJob)][:1] == [("engine", "abort")])


def test_a_job_whose_order_was_cancelled_is_aborted(mes: httpx.Client, controller: Working) -> None:
    controller.refuses = {TakeJob: "job-conflict"}  # and is taken all the same, as by an older word
    handed_over(mes, controller, "engine")
    until(lambda: tell(mes, "engine", "Cancel").status_code == 200)
    controller.shows(engine=JobState.RUNNING)
    until(lambda: [(each.job, each.what) for each in controller.said(CommandJob)][:1] == [("engine", "abort")])


def test_an_order_that_the_station_does_not_know_can_be_aborted(
    mes: httpx.Client, controller: Working, server: Server
) -> None:
    handed_over(mes, controller, "engine")
    become(server, "engine", OrderState.RUNNING)
    controller.refuses = {CommandJob: "unknown-job", TakeJob: "not-in-job-mode"}
    assert tell(mes, "engine", "Abort").json()["commanded"] == "Abort"
    until(lambda: mes.get(f"{ORDERS}/engine").json()["state"] == "Aborted")
    assert mes.get("/api/v1/job-responses/engine").json()["outcome"] == "aborted"


def test_an_order_that_may_be_on_its_way_is_aborted_there(mes: httpx.Client, controller: Working) -> None:
    handed_over(mes, controller, "engine")
    given = len(controller.said(TakeJob))
    tell(mes, "engine", "Abort")
    until(lambda: bool(controller.said(CommandJob)))
    time.sleep(LOOKS)
    assert mes.get(f"{ORDERS}/engine").json()["commanded"] == "Abort", "the journal has not told yet"
    assert len(controller.said(TakeJob)) <= given + 1


def test_what_is_refused_is_not_said_at_every_look(mes: httpx.Client, controller: Working, server: Server) -> None:
    handed_over(mes, controller, "engine")
    become(server, "engine", OrderState.RUNNING)
    controller.refuses = {TakeJob: "not-in-job-mode"}
    store(mes, "another", id="another")
    given = len(controller.said(TakeJob))
    time.sleep(LOOKS)
    assert len(controller.said(TakeJob)) <= given + 1


def test_when_orders_are_ready_is_told_by_what_was_made(mes: httpx.Client, controller: Working, server: Server) -> None:
    handed_over(mes, controller, "first")
    store(mes, "second", id="second", start=True)
    assert mes.get(f"{ORDERS}/second").json()["expected_end"] is None, "none was ever made"
    began = server.identity.now()
    engine = JobResponse(
        job_order="before",
        work_master="truck_engine",
        description="",
        outcome=JobOutcome.COMPLETED,
        began=1.0,
        ended=301.0,
        operations=[],
        abilities=[],
        deviations=[],
        corrections=[],
    )
    with server.identity.database.writing() as connection:
        responses.write(connection, engine, began)
        running = orders.get(connection, "first")
        orders.become(connection, running, OrderState.RUNNING, began, {"began": began})
    controller.shows(first=JobState.RUNNING)
    until(lambda: mes.get(f"{ORDERS}/first").json()["expected_end"] == began + 300)
    until(lambda: mes.get(f"{ORDERS}/second").json()["expected_start"] == began + 300)
    found = {each["id"]: each for each in mes.get(ORDERS).json()["job_orders"]}
    assert found["second"]["expected_end"] == began + 600
    assert found["second"]["expected_end_at"].endswith("Z")
    controller.shows(first=JobState.PAUSED)
    until(lambda: mes.get(f"{ORDERS}/second").json()["expected_end"] is None)
