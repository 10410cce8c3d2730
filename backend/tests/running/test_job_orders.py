"""A MES and the bolt tightening station: real processes, of which any may be killed at any moment.

What comes of the orders is held against the run's journal, read by a reader of this page alone.
"""

from __future__ import annotations

import contextlib
import json
import time
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest

from running.mortal import Mortal, mortal
from sequence_planner.auth import api_keys
from sequence_planner.auth.roles import Scope
from sequence_planner.core.actor import SYSTEM
from sequence_planner.journal import run_journal

Starts = list[tuple[int, str]]


class Mes:
    """A system that orders engines with its key, and reads events on from where it stopped."""

    def __init__(self, station: Mortal) -> None:
        self._station = station
        scopes = frozenset({Scope.READ, Scope.ORDERS_READ, Scope.ORDERS_WRITE})
        with station.database.writing() as connection:
            secret, _ = api_keys.make_key(connection, "MES", scopes, 1, SYSTEM, time.time())
        # A connection for each request: the server may die between two.
        self.client = httpx.Client(
            base_url=f"http://127.0.0.1:{station.port}/api/v1/",
            headers={"Authorization": f"Bearer {secret}"},
            limits=httpx.Limits(max_keepalive_connections=0),
        )
        self.events: list[dict[str, Any]] = []

    def order(self, id: str, **content: object) -> None:
        """Order an engine, and again, as if no answer had come."""
        body = {"id": id, "work_master": "truck_engine", "start": True, "description": f"Engine {id}", **content}
        sent = [self.client.post("job-orders", json=body, headers={"Idempotency-Key": id}) for _ in range(2)]
        assert [each.status_code for each in sent] == [201, 201], sent[0].text

    def tell(self, id: str, command: str) -> None:
        answer = self.client.post(f"job-orders/{id}/commands", json={"command": command, "reason": "as planned"})
        assert answer.is_success, answer.text

    def get(self, id: str) -> dict[str, Any]:
        found: dict[str, Any] = self.client.get(f"job-orders/{id}").raise_for_status().json()
        return found

    def response(self, id: str) -> dict[str, Any]:
        found: dict[str, Any] = self.client.get(f"job-responses/{id}").raise_for_status().json()
        return found

    def read_on(self) -> None:
        """Read what has happened since."""
        while True:
            after = self.events[-1]["number"] if self.events else 0
            found = self.client.get("events", params={"after": after, "limit": 5}).raise_for_status().json()["events"]
            if not found:
                return
            self.events += found

    def told(self, id: str, *kinds: str) -> list[str]:
        return [each["kind"] for each in self.events if each["job_order"] == id and each["kind"] in kinds]

    def wait(self, what: Callable[[], bool], why: str) -> None:
        """Do what people are asked to do until that is so; a server that is away is no reason to give up."""

        def so() -> bool:
            with contextlib.suppress(httpx.TransportError, httpx.HTTPStatusError, KeyError):
                self._station.acknowledge()
                return what()
            return False

        self._station.wait(so, f"{why}: {self.events[-5:]}")


@pytest.fixture(scope="module")
def station() -> Iterator[Mortal]:
    with mortal("job orders") as found:
        found.wait(lambda: found.production() == "waiting", "it is not up")
        yield found


def is_state(mes: Mes, id: str, state: str) -> Callable[[], bool]:
    return lambda: bool(mes.get(id)["state"] == state)


def starts_by_job(station: Mortal) -> tuple[dict[str, Starts], Starts]:
    """Of each job the starts while one of its operations was active, by record and ability; and all other starts."""
    jobs: dict[str, dict[str, Any]] = {}
    found: dict[str, Starts] = {}
    others: Starts = []
    number = 0
    while True:
        with station.database.reading() as connection:
            page = run_journal.after(connection, number, 1000)
        if not page:
            return found, others
        for record in page:
            content = json.loads(record.content)
            if record.kind in ("begun", "snapshot"):
                jobs = {}
            jobs |= content.get("jobs", {})
            active = [
                id
                for id, job in jobs.items()
                if job is not None
                and job.get("state") == "running"
                and set(job.get("started", {})) - set(job.get("completed", {}))
            ]
            assert len(active) <= 1, "two engines were worked at once"
            for name in content.get("started", ()) if record.kind == "ticked" else ():
                (found.setdefault(active[0], []) if active else others).append((record.number, name))
        number = page[-1].number


def kept_jobs(station: Mortal) -> set[str]:
    """The jobs that the controller has not forgotten, by its last record about each."""
    with station.database.reading() as connection:
        records = run_journal.after(connection, 0, 1_000_000)
    told = [json.loads(record.content).get("jobs", {}) for record in records]
    last = {id: job for jobs in told for id, job in jobs.items()}
    return {id for id, job in last.items() if job is not None}


def test_orders_are_worked_and_nothing_is_lost_or_doubled(station: Mortal) -> None:
    mes = Mes(station)
    mes.order("late", due=time.time() + 9000)
    mes.order("early", due=time.time() + 5000)
    mes.order("urgent", priority=7)
    mes.order("tomorrow", priority=9, earliest=time.time() + 86400)
    mes.wait(lambda: bool(mes.get("urgent")["waits_for"]), "nobody says why nothing is done")
    assert mes.get("urgent")["waits_for"] == ["the station works freely", "production is not started"]
    by_order = {"on": True, "reason": "the shift begins"}
    station.wait(lambda: station.ask("PUT", "settings/job-mode", by_order).is_success, "it does not work by order")
    station.begin_production()

    mes.wait(is_state(mes, "urgent", "Running"), "the most urgent is not begun")
    mes.wait(lambda: mes.get("early")["waits_for"] == ["urgent is in work"], "it is not said what it waits for")
    assert mes.get("tomorrow")["waits_for"][0].startswith("not before ")
    assert mes.client.put("mode", json={"mode": "paused"}).status_code == 403  # whatever it orders

    mes.tell("urgent", "Pause")
    mes.wait(is_state(mes, "urgent", "Interrupted"), "it is not interrupted")
    station.kill("server")
    station.start("server")
    mes.wait(is_state(mes, "urgent", "Interrupted"), "it does not stay interrupted")
    mes.tell("urgent", "Resume")
    mes.wait(is_state(mes, "urgent", "Running"), "it does not go on")
    mes.wait(lambda: _completed(mes, "urgent") >= 1, "nothing is completed")
    station.kill("controller")
    station.kill("server")
    station.start("controller")
    station.start("server")
    station.begin_production()
    mes.wait(is_state(mes, "urgent", "Ended"), "the most urgent does not end")

    mes.wait(is_state(mes, "early", "Running"), "what is due first is not begun next")
    mes.wait(lambda: _completed(mes, "early") >= 1, "nothing is completed")
    mes.tell("early", "Abort")
    mes.wait(is_state(mes, "early", "Aborted"), "it is not aborted")
    mes.wait(is_state(mes, "late", "Running"), "the last is not begun")
    mes.tell("late", "Stop")
    mes.wait(is_state(mes, "late", "Ended"), "it is not stopped")
    mes.tell("tomorrow", "RevokeStart")
    mes.wait(lambda: not kept_jobs(station), "jobs are not forgotten")
    mes.read_on()

    _require_events(mes)
    _require_responses(mes, station)


def _completed(mes: Mes, id: str) -> int:
    mes.read_on()
    return len(mes.told(id, "operation-completed"))


def _require_events(mes: Mes) -> None:
    assert [each["number"] for each in mes.events] == list(range(1, len(mes.events) + 1))
    states = ("job-order-stored", "job-order-running", "job-order-interrupted", "job-order-ended", "job-order-aborted")
    assert mes.told("urgent", *states) == [states[0], states[1], states[2], states[1], states[3]]
    assert mes.told("early", *states) == [states[0], states[1], states[4]]
    assert mes.told("late", *states) == [states[0], states[1], states[3]]
    for kind in ("operation-started", "operation-completed"):
        of_urgent = Counter(
            each["content"]["operation"]
            for each in mes.events
            if each["kind"] == kind and each["job_order"] == "urgent"
        )
        assert len(of_urgent) == 7
        assert set(of_urgent.values()) == {1}


def _require_responses(mes: Mes, station: Mortal) -> None:
    made, _ = starts_by_job(station)
    responses = {id: mes.response(id) for id in ("urgent", "early", "late")}
    assert {id: each["outcome"] for id, each in responses.items()} == {
        "urgent": "completed",
        "early": "aborted",
        "late": "stopped",
    }
    for id, each in responses.items():
        assert [(start["record"], start["ability"]) for start in each["abilities"]] == made.pop(id, [])
    assert made == {}
    urgent = responses["urgent"]
    assert all(operation["ended"] is not None for operation in urgent["operations"])
    tightened = next(each for each in urgent["operations"] if each["operation"] == "tighten_bolt_pair(bolt_pair_2)")
    assert tightened["actuals"] == {"bolts[bolt_pair_2]": "tightened"}
    assert tightened["started"] < tightened["ended"]
    assert any(each["ability"].startswith("nutrunner.run_nut") for each in urgent["abilities"])
