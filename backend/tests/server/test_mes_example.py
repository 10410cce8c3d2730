"""The example client and the simulator of `docs/examples` do what they say, and notice what does not agree."""

from __future__ import annotations

import json
import random
from collections import Counter
from collections.abc import Iterator
from contextlib import closing
from io import BytesIO
from typing import Any

import httpx
import pytest

from mes.receiver import receiving
from running.days import example
from sequence_planner.mes.webhooks.endpoints import new_secret, signed
from support.server import Server

from .test_job_orders import controller, mes

__all__ = ["controller", "mes"]

client = example("mes_client")
simulator = example("mes_simulator")
BODY = b'{"number":7}'


@pytest.fixture
def station(mes: httpx.Client, server: Server) -> Any:  # noqa: ANN401 - of a module that was found by its path
    return client.Mes(server.address, mes.headers["Authorization"].removeprefix("Bearer "), patience=5.0)


def test_the_client_orders_changes_commands_and_reads(station: Any) -> None:  # noqa: ANN401
    for _ in range(2):
        order = station.order("engine-1", "truck_engine", priority=1, start=False)
    assert (order["state"], order["revision"]) == ("NotAllowedToStart", 1)
    assert station.change("engine-1", priority=7)["priority"] == 7
    station.command("engine-1", "Abort", "not needed")
    with pytest.raises(client.Refused, match="Aborted") as refused:
        station.command("engine-1", "Start", "after all")
    assert (refused.value.status, refused.value.problem["allowed"]) == (409, ["Clear"])
    assert station.response("engine-1")["outcome"] == "aborted"
    kinds = [event["kind"] for event in station.events()]
    assert kinds == ["job-order-stored", "job-order-updated", "job-order-aborted"]
    assert (list(station.events()), station.last) == ([], 3)


def test_the_client_asks_again_what_was_not_answered() -> None:
    with receiving() as nobody:
        nobody.answers += [lambda handler: handler.connection.close()] * 2
        station = client.Mes(f"http://127.0.0.1:{nobody.port}", "k", patience=5.0)
        assert station.ask("POST", "job-orders", {"id": "1"}, {"Idempotency-Key": "order-1"}) is None
        assert [each.headers["idempotency-key"] for each in nobody.received] == ["order-1"] * 3


def test_the_client_believes_a_webhook_only_if_it_is_signed_lately() -> None:
    secret = new_secret()
    headers = signed(secret, "event-7", 1000.0, BODY)
    assert client.verified(secret, headers, BODY, 1299.0) == {"number": 7}
    assert client.verified(secret, {name.title(): each for name, each in headers.items()}, BODY, 701.0)
    for wrong in (
        (secret, headers, BODY, 1301.0),
        (secret, headers, BODY, 699.0),
        (secret, headers, BODY + b" ", 1000.0),
        (new_secret(), headers, BODY, 1000.0),
        (secret, headers | {"webhook-id": "event-8"}, BODY, 1000.0),
        (secret, headers | {"webhook-timestamp": "1001"}, BODY, 1000.0),
        (secret, headers | {"webhook-signature": "v1,é"}, BODY, 1000.0),
        (secret, {}, BODY, 1000.0),
    ):
        with pytest.raises(ValueError, match=r"too old|not signed"):
            client.verified(*wrong)


class Past:
    """A station at which two orders were worked."""

    def __init__(self) -> None:
        job = {"state": "running", "started": {"tighten": 1.0}}
        over = job | {"state": "ended", "completed": {"tighten": 2.0}}
        self.records = [
            {"number": 1, "kind": "ticked", "content": {"started": ["robot.home"]}},
            {"number": 2, "kind": "ticked", "content": {"jobs": {"day.0": job}, "started": ["nut.run"]}},
            {"number": 3, "kind": "ticked", "content": {"jobs": {"day.0": over}, "started": ["robot.home"]}},
        ]
        made = {"operation": "tighten", "ended": 2.0}
        start = {"record": 2, "ability": "nut.run"}
        self.answer: dict[str, Any] = {"job_order": "day.0", "operations": [made], "abilities": [start]}

    def response(self, id: str) -> dict[str, Any]:
        return self.answer

    def open(self, *_: object) -> closing[BytesIO]:
        return closing(BytesIO("".join(f"{json.dumps(each)}\n" for each in self.records).encode()))


def found(past: Past, made: Iterator[str] | tuple[str, ...] = ("day.0/tighten",)) -> list[str]:
    day = simulator.Day(past, "truck_engine", 1, 1.0, random.Random(1), name="day", over={"day.0"}, made=Counter(made))
    differences: list[str] = day.differences()
    return [each.partition(" differ")[0] for each in differences]


def test_the_simulator_finds_whatever_does_not_agree() -> None:
    assert found(Past()) == []
    assert found(Past(), ()) == ["completions in responses and events"]
    assert found(Past(), ("day.0/tighten",) * 2) == ["completions in responses and events"]
    lost, doubled, strange, unmade = Past(), Past(), Past(), Past()
    lost.answer["abilities"] = []
    doubled.answer["abilities"] *= 2
    strange.answer["abilities"] = [{"record": 3, "ability": "robot.home"}]
    for past in (lost, doubled, strange):
        assert found(past) == ["starts in responses and journal"]
    unmade.answer["operations"][0]["ended"] = None
    assert found(unmade, ()) == ["completions in responses and journal"]
