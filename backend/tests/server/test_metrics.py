"""Whether the station is ready, and its figures as Prometheus reads them."""

from __future__ import annotations

import contextlib
import dataclasses
import sqlite3
import time
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest
from prometheus_client import Metric
from prometheus_client.openmetrics.parser import text_string_to_metric_families as open_metrics
from prometheus_client.parser import text_string_to_metric_families
from prometheus_client.samples import Sample

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.commands.command import Query
from sequence_planner.controller.commands.queries import AskFigures
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.data_models import DataModel
from sequence_planner.db.location import SqliteFile
from sequence_planner.execution.vocabulary import Production
from sequence_planner.process.restarts import write_restarts
from sequence_planner.server import metrics
from sequence_planner.server.settings import Settings
from support.server import Controller, Loop, Server, listen
from support.waiting import until

from .bearers import key
from .example_answers import example_answer, example_figures
from .test_acting import problem


class Measured(Controller):
    """A controller that tells its figures, and whose views are of now."""

    of_now = True
    behind = False
    asked = 0

    async def answer(self, ask: Query[Any]) -> DataModel:
        if isinstance(ask, AskFigures):
            self.asked += 1
            return example_figures(behind=self.behind)
        return example_answer(ask)


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Measured]:
    controller = Measured(loop, settings.controller_socket)
    controller.link = ControllerLink(settings.controller_socket, controller.handle, controller.answer)
    controller.start()
    yield controller
    controller.stop()


def ready(server: Server) -> httpx.Response:
    return httpx.get(f"{server.address}/readyz")


def becomes(server: Server, *failing: str) -> None:
    """Wait until exactly these checks fail."""

    def so() -> bool:
        answer = ready(server)
        return set(answer.json().get("reasons", {})) == set(failing) and answer.status_code == (503 if failing else 200)

    until(so, seconds=10)


def scrape(server: Server) -> dict[str, Metric]:
    answer = httpx.get(f"{server.address}/metrics").raise_for_status()
    return {family.name: family for family in text_string_to_metric_families(answer.text)}


def value(families: dict[str, Metric], name: str, **labels: str) -> float:
    """The only sample of this name with these labels."""
    samples: list[Sample] = [each for family in families.values() for each in family.samples]
    (found,) = [each for each in samples if each.name == f"sequence_planner_{name}" and each.labels == labels]
    return found.value


def test_a_station_at_work_is_ready(server: Server) -> None:
    becomes(server)
    assert ready(server).json()["checks"] == ["controller", "prepared", "journal", "time", "database"]
    assert ready(server).headers["cache-control"] == "no-store"


@pytest.mark.parametrize(
    ("change", "check"),
    [
        (lambda view: view.model_copy(update={"production": Production.PREPARING}), "prepared"),
        (lambda view: view.model_copy(update={"time": view.time - 5}), "time"),
        (lambda view: view.model_copy(update={"time": view.time + 5}), "time"),
    ],
)
def test_what_a_view_tells_against_it(
    server: Server, controller: Measured, change: Callable[[StationView], StationView], check: str
) -> None:
    before = controller.view.model_copy(update={"time": time.time()})
    controller.of_now = False
    controller.show(change(before))
    becomes(server, check)
    assert ready(server).json()["type"] == "/problems/not-ready"
    controller.show(before)
    controller.of_now = True
    becomes(server)


def test_a_journal_that_falls_behind_is_told(server: Server, controller: Measured) -> None:
    controller.behind = True
    becomes(server, "journal")
    assert "nothing is started" in ready(server).json()["detail"]
    controller.behind = False
    becomes(server)


def test_a_silent_controller_is_neither_alive_nor_ready(server: Server, controller: Measured) -> None:
    controller.publishing = False
    becomes(server, "controller", "prepared", "journal", "time")
    assert httpx.get(f"{server.address}/healthz").status_code == 503
    assert value(scrape(server), "controller_up") == 0


def test_a_database_that_cannot_be_written_to_is_told(
    server: Server, monkeypatch: pytest.MonkeyPatch, controller: Measured
) -> None:
    place = server.identity.database.place
    assert isinstance(place, SqliteFile)
    monkeypatch.setattr(metrics, "PATIENCE", 0.3)
    with contextlib.closing(sqlite3.connect(place.path, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")  # another program holds it
        becomes(server, "database")
        assert str(place.path) not in ready(server).text
        assert value(scrape(server), "ready", check="database") == 0
        assert httpx.get(f"{server.address}/healthz").status_code == 200
        other.execute("ROLLBACK")
    becomes(server)


def test_prometheus_reads_all_figures(server: Server, client: httpx.Client) -> None:
    write_restarts(server.settings.controller_socket.parent, {"controller": 2, "server": 0})
    assert client.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204
    assert client.get("/api/v1/api-keys").status_code == 403
    assert client.get("/somewhere/else").status_code in (404, 503)
    with listen(server) as stream:
        stream.recv()
        found = scrape(server)
    assert value(found, "ticks_total") == value(found, "tick_duration_seconds_count") == 4
    assert value(found, "tick_duration_seconds_bucket", le="0.001") == 2
    assert value(found, "tick_duration_seconds_bucket", le="+Inf") == 4
    assert value(found, "tick_duration_seconds_sum") == pytest.approx(2.0515)
    assert value(found, "journal_waiting_records") == 2
    assert value(found, "journal_latency_seconds_count") == 3
    assert value(found, "planner_duration_seconds_count", question="plan", outcome="found") == 2
    assert value(found, "worker_replacements_total", worker="planner") == 1
    assert value(found, "part_restarts_total", part="controller") == 2
    assert value(found, "alarms", priority="low", state="unacknowledged") == 1
    assert value(found, "alarms", priority="high", state="shelved") == 0
    assert sum(each.value for each in found["sequence_planner_mode"].samples) == 1
    assert value(found, "mode", state="automatic") == 1
    assert value(found, "packml_state", state="execute") == 1
    assert value(found, "stream_clients", route="/api/v1/stream") == 1
    assert value(found, "http_requests_total", method="PUT", route="/api/v1/mode", status="204") == 1
    assert value(found, "http_requests_total", method="GET", route="/api/v1/api-keys", status="403") == 1
    assert value(found, "http_request_duration_seconds_count", route="/api/v1/mode") == 1
    assert any(each.labels["route"] == "none" for each in found["sequence_planner_http_requests"].samples)
    assert "/somewhere/else" not in httpx.get(f"{server.address}/metrics").text
    (build,) = found["sequence_planner_build_info"].samples
    assert build.labels.keys() == {"version", "python"}
    until(lambda: value(scrape(server), "stream_clients", route="/api/v1/stream") == 0)


def test_names_keep_to_the_conventions(server: Server) -> None:
    for family in scrape(server).values():
        assert family.name.startswith("sequence_planner_")
        assert family.documentation
        assert family.type in ("counter", "gauge", "histogram")
        assert family.type != "histogram" or family.name.endswith("_seconds")
        assert "millisecond" not in family.name
    accept = {"Accept": "application/openmetrics-text;version=1.0.0"}
    answer = httpx.get(f"{server.address}/metrics", headers=accept)
    assert answer.headers["content-type"].startswith("application/openmetrics-text")
    assert [family.name for family in open_metrics(answer.text)]  # type: ignore[no-untyped-call]


def test_however_many_ask_the_controller_is_asked_once_a_second(server: Server, controller: Measured) -> None:
    scrape(server)
    controller.asked = 0
    for _ in range(20):
        scrape(server)
    assert controller.asked <= 3


def test_from_elsewhere_it_takes_a_key_of_its_own(loop: Loop, controller: Measured, settings: Settings) -> None:
    name, proxy, client = "station.example", "127.0.0.2", "203.0.113.7"
    server = Server(loop, dataclasses.replace(settings, proxies=(proxy,), names=(name,)))
    server.start()
    forwarded = {"Host": name, "X-Forwarded-Proto": "https", "X-Forwarded-For": client}
    bearing = {scope: {"Authorization": f"Bearer {key(server, scope)[0]}"} for scope in Scope}
    try:
        with httpx.Client(base_url=server.address, transport=httpx.HTTPTransport(local_address=proxy)) as outside:
            problem(outside.get("/metrics", headers=forwarded), 401, "signed-out")
            session = server.cookie(server.session(server.person(Role.ADMINISTRATOR))[0])
            problem(outside.get("/metrics", headers=forwarded | session), 401, "signed-out")
            problem(outside.get("/metrics", headers=forwarded | bearing[Scope.READ]), 403, "scope-missing")
            problem(outside.get("/api/v1/state", headers=forwarded | bearing[Scope.METRICS]), 403, "scope-missing")
            assert outside.get("/metrics", headers=forwarded | bearing[Scope.METRICS]).status_code == 200
        with httpx.Client(base_url=server.address) as beside:
            assert beside.get("/metrics").status_code == beside.get("/readyz").status_code == 200
            # What somebody has sent on, whatever name it gives for this machine, did not begin here.
            problem(beside.get("/metrics", headers={"X-Forwarded-For": client}), 401, "signed-out")
    finally:
        server.stop()


def test_each_answer_has_the_number_of_its_request(client: httpx.Client) -> None:
    first, second = (client.get("/healthz").headers["x-request-id"] for _ in range(2))
    assert first != second
    assert (
        client.get("/healthz", headers={"X-Request-Id": "of-the.proxy_7"}).headers["x-request-id"] == "of-the.proxy_7"
    )
    unfit = client.get("/healthz", headers={"X-Request-Id": "a b"}).headers["x-request-id"]
    assert unfit != "a b"
