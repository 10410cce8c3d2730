"""Webhooks, as an administrator or another system manages them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest
from sqlalchemy import select

from mes.receiver import Receiver, receiving, status
from sequence_planner.auth.roles import Scope
from sequence_planner.db.metadata import METADATA
from sequence_planner.mes import events
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.webhooks.tables import WEBHOOK_DELIVERIES
from sequence_planner.mes.webhooks.targets import Targets, network
from sequence_planner.server.settings import Settings
from support.server import Server, settings_in
from support.waiting import until

from .bearers import key
from .test_acting import problem
from .test_keys import bearing

WEBHOOKS = "/api/v1/webhooks"


@pytest.fixture(scope="module")
def receiver() -> Iterator[Receiver]:
    with receiving() as receiver:
        yield receiver


@pytest.fixture
def settings(tmp_path: Path, receiver: Receiver) -> Settings:
    receiver.received.clear()
    receiver.answers.clear()
    targets = Targets(frozenset({("127.0.0.1", receiver.port), ("localhost", 9)}), True, (network("10.1.2.0/24"),))
    return replace(settings_in(tmp_path), webhooks=targets)


@pytest.fixture
def client(lonely_server: Server) -> Iterator[httpx.Client]:
    """A system whose key is for webhooks."""
    secret, _ = key(lonely_server, Scope.WEBHOOKS)
    with httpx.Client(base_url=lonely_server.address, headers=bearing(secret)) as client:
        yield client


def happen(server: Server, number: int = 1) -> None:
    with server.identity.database.writing() as connection:
        for _ in range(number):
            events.append(connection, EventKind.ENDED, "order-1", 1.0, {})


def test_a_webhook_is_told_until_it_is_deleted(lonely_server: Server, client: httpx.Client, receiver: Receiver) -> None:
    happen(lonely_server, 2)
    answer = client.post(WEBHOOKS, json={"title": "MES", "url": receiver.url(), "after": 1})
    assert answer.status_code == 201, answer.text
    assert answer.headers["cache-control"] == "no-store"
    secret, webhook = answer.json()["secret"], answer.json()["webhook"]
    assert (webhook["title"], webhook["url"], webhook["kinds"], webhook["position"]) == ("MES", receiver.url(), [], 1)
    happen(lonely_server)
    until(lambda: len(receiver.received) == 2)
    assert [each.verified(secret)["number"] for each in receiver.received] == [2, 3]
    problem(client.get("/api/v1/events"), 403, "scope-missing")
    until(lambda: client.get(WEBHOOKS).json()["webhooks"][0]["delivered"] == 2)
    (listed,) = client.get(WEBHOOKS).json()["webhooks"]
    assert (listed["id"], listed["waiting"], listed["given_up"]) == (webhook["id"], 0, 0)
    assert client.delete(f"{WEBHOOKS}/{webhook['id']}").status_code == 204
    problem(client.delete(f"{WEBHOOKS}/{webhook['id']}"), 404, "no-webhook")
    hosts = [f"127.0.0.1:{receiver.port}", "localhost:9"]
    where = {"hosts": hosts, "networks": ["10.1.2.0/24"], "loopback": True}
    assert client.get(WEBHOOKS).json() == {"webhooks": [], "allowed": where}


def test_the_secret_is_told_once_and_is_not_in_the_database(
    lonely_server: Server, client: httpx.Client, receiver: Receiver
) -> None:
    made = client.post(WEBHOOKS, json={"title": "MES", "url": receiver.url()}).json()
    assert made["secret"].startswith("whsec_")
    assert "secret" not in made["webhook"]
    assert made["secret"] not in client.get(WEBHOOKS).text
    with lonely_server.identity.database.reading() as connection:
        rows = [str(row) for table in METADATA.sorted_tables for row in connection.execute(select(table))]
    assert not any(made["secret"].removeprefix("whsec_") in row for row in rows)


def test_nothing_is_sent_to_where_it_must_not(client: httpx.Client, receiver: Receiver) -> None:
    for url in (
        "https://other.example/",
        f"http://127.0.0.1:{receiver.port + 1}/",
        f"http://127.0.0.1:{receiver.port}@other.example/",
        "http://169.254.169.254/latest",
        "javascript:alert(1)",
        "\x00",
    ):
        problem(client.post(WEBHOOKS, json={"title": "MES", "url": url}), 422, "webhook-target-refused")
    assert client.get(WEBHOOKS).json()["webhooks"] == []


def test_what_is_wrong_with_a_webhook_is_said(client: httpx.Client, receiver: Receiver) -> None:
    body = {"title": "MES", "url": receiver.url()}
    for wrong in ({"title": ""}, {"kinds": ["no-such-kind"]}, {"after": -1}, {"after": "1"}, {"secret": "mine"}):
        problem(client.post(WEBHOOKS, json=body | wrong), 422, "invalid-request")


def test_what_was_given_up_is_listed_and_sent_again(
    lonely_server: Server, client: httpx.Client, receiver: Receiver
) -> None:
    receiver.answers.append(status(500))
    made = client.post(WEBHOOKS, json={"title": "MES", "url": receiver.url(), "kinds": ["job-order-ended"]}).json()
    place = f"{WEBHOOKS}/{made['webhook']['id']}"
    happen(lonely_server)
    until(lambda: client.get(WEBHOOKS).json()["webhooks"][0]["failures"] == 1)
    assert client.get(f"{place}/dead-letters").json() == {"dead_letters": [], "next": 0}
    with lonely_server.identity.database.writing() as connection:  # as after many attempts
        connection.execute(WEBHOOK_DELIVERIES.update().values(died=5.0, attempts=20))
    answer = client.get(f"{place}/dead-letters").json()
    (letter,) = answer["dead_letters"]
    assert (letter["event"]["number"], letter["attempts"], letter["trouble"]) == (
        1,
        20,
        "it was answered with status 500",
    )
    assert answer["next"] == 1
    assert client.get(f"{place}/dead-letters?after=1").json() == {"dead_letters": [], "next": 1}
    assert client.post(f"{place}/dead-letters/retry", json={"events": [7]}).json() == {"events": 0}
    assert client.post(f"{place}/dead-letters/retry", json={}).json() == {"events": 1}
    until(lambda: len(receiver.received) == 2)
    assert receiver.received[1].verified(made["secret"])["number"] == 1
    problem(client.get(f"{WEBHOOKS}/none/dead-letters"), 404, "no-webhook")
    problem(client.post(f"{WEBHOOKS}/none/dead-letters/retry", json={}), 404, "no-webhook")
