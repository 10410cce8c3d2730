"""Job orders over REST, as a MES and people give them; the station does not work on them here."""

from __future__ import annotations

import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from sequence_planner.auth.api_keys import revoke_key
from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.core.actor import SYSTEM
from sequence_planner.journal import audit
from sequence_planner.mes import idempotency, orders
from sequence_planner.mes.order import OrderRefused
from sequence_planner.server.services.orders import OrderService
from sequence_planner.server.settings import Settings
from support.example_view import example_view
from support.server import Loop, Server
from support.waiting import until

from .bearers import key
from .test_acting import problem
from .test_docs_curl import snippet, typed
from .test_looking import Telling

ORDERS = "/api/v1/job-orders"
ENGINE = {"work_master": "truck_engine", "priority": 3, "due": 2000.5, "description": "Engine 4711"}


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Telling]:
    """A controller that knows what jobs consist of; the station works freely, so orders wait."""
    controller = Telling(loop, settings.controller_socket)
    controller.view = example_view(by_order=False, jobs={})
    controller.link = ControllerLink(settings.controller_socket, controller.handle, controller.answer)
    controller.start()
    yield controller
    controller.stop()


@pytest.fixture
def mes(server: Server) -> Iterator[httpx.Client]:
    """A MES with a key that opens all that it needs."""
    secret, _ = key(server, Scope.READ, Scope.ORDERS_READ, Scope.ORDERS_WRITE)
    with httpx.Client(base_url=server.address, headers={"Authorization": f"Bearer {secret}"}) as client:
        yield client


def store(client: httpx.Client, name: str, **changes: object) -> dict[str, Any]:
    """A new order, stored under an idempotency key of its own."""
    answer = client.post(ORDERS, json=ENGINE | changes, headers={"Idempotency-Key": f"key of {name}".replace(" ", "-")})
    assert answer.status_code == 201, answer.text
    found: dict[str, Any] = answer.json()
    return found


def tell(client: httpx.Client, id: str, command: str, reason: str | None = None) -> httpx.Response:
    return client.post(f"{ORDERS}/{id}/commands", json={"command": command, "reason": reason})


def told(client: httpx.Client, after: int = 0) -> list[tuple[int, str, str]]:
    found = client.get("/api/v1/events", params={"after": after, "limit": 200}).json()["events"]
    return [(each["number"], each["kind"], each["job_order"]) for each in found]


def test_an_order_is_stored_started_and_told(mes: httpx.Client, server: Server) -> None:
    order = store(mes, "4711", id="engine-4711")
    assert {name: order[name] for name in ENGINE} == ENGINE
    assert (order["state"], order["allowed"]) == ("NotAllowedToStart", ["Start", "Abort", "Cancel"])
    assert (order["revision"], order["stored_by"], order["waits_for"]) == (1, "MES", [])
    started = tell(mes, "engine-4711", "Start", "the shift begins")
    assert (started.status_code, started.json()["state"]) == (200, "AllowedToStart")
    assert started.headers["etag"] == '"2"' == mes.get(f"{ORDERS}/engine-4711").headers["etag"]
    until(lambda: mes.get(f"{ORDERS}/engine-4711").json()["waits_for"] == ["the station works freely"])
    assert told(mes) == [(1, "job-order-stored", "engine-4711"), (2, "job-order-allowed", "engine-4711")]
    assert told(mes, 1) == [(2, "job-order-allowed", "engine-4711")]
    with server.identity.database.reading() as connection:
        newest = audit.read(connection, action="job-order-start")[0].entry
    assert (newest.actor.name, newest.subject, newest.reason) == ("MES", "job order engine-4711", "the shift begins")


def test_who_has_read_further_than_a_restored_station_is_told_so(mes: httpx.Client) -> None:
    store(mes, "4711")
    assert mes.get("/api/v1/events", params={"after": 1}).json() == {"events": [], "next": 1}
    told = problem(mes.get("/api/v1/events", params={"after": 2}), 409, "event-not-known")
    assert "the newest is 1" in told["detail"]


def test_without_an_id_an_order_is_given_one(mes: httpx.Client) -> None:
    one, two = store(mes, "one", start=True), store(mes, "two")
    assert one["id"] != two["id"]
    assert mes.get(f"{ORDERS}/{one['id']}").json()["state"] == "AllowedToStart"


def test_a_repeated_request_stores_nothing_more(mes: httpx.Client, server: Server) -> None:
    sent = {"Idempotency-Key": "4711"}
    first = mes.post(ORDERS, json=ENGINE, headers=sent)
    tell(mes, first.json()["id"], "Start")
    again = mes.post(ORDERS, json=dict(reversed(ENGINE.items())), headers=sent)
    assert (again.status_code, again.text, again.headers["etag"]) == (201, first.text, first.headers["etag"])
    other = mes.post(ORDERS, json={**ENGINE, "priority": 4}, headers=sent)
    problem(other, 422, "idempotency-key-reused")
    secret, _ = key(server, Scope.ORDERS_WRITE)
    stranger = {**sent, "Authorization": f"Bearer {secret}"}
    assert mes.post(ORDERS, json=ENGINE, headers=stranger).json()["id"] != first.json()["id"]
    assert len(mes.get(ORDERS).json()["job_orders"]) == 2


def test_a_key_is_kept_for_a_week(mes: httpx.Client, server: Server) -> None:
    first = store(mes, "4711")
    begun = server.identity.now()
    server.identity.now = lambda: begun + idempotency.KEPT - 60
    store(mes, "another")
    assert store(mes, "4711") == first
    server.identity.now = lambda: begun + idempotency.KEPT + 60
    store(mes, "a third")
    assert store(mes, "4711")["id"] != first["id"]


def test_many_at_once_with_one_key_store_one_order(mes: httpx.Client) -> None:
    answered: list[httpx.Response] = []

    def send() -> None:
        answered.append(mes.post(ORDERS, json=ENGINE, headers={"Idempotency-Key": "4711"}))

    threads = [threading.Thread(target=send) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {(each.status_code, each.text) for each in answered} == {(201, answered[0].text)}
    assert len(answered) == 8
    assert len(mes.get(ORDERS).json()["job_orders"]) == 1
    assert len(told(mes)) == 1


def test_the_key_is_needed(mes: httpx.Client) -> None:
    problem(mes.post(ORDERS, json=ENGINE), 422, "invalid-request")
    problem(mes.post(ORDERS, json=ENGINE, headers={"Idempotency-Key": ""}), 422, "invalid-request")


def test_a_time_that_is_none_is_told_what_it_has_to_be(mes: httpx.Client) -> None:
    answer = mes.post(ORDERS, json=ENGINE | {"due": "tomorrow"}, headers={"Idempotency-Key": "1"})
    (told,) = problem(answer, 422, "invalid-request")["errors"]
    assert told["field"] == "body.due"
    assert told["expected"].startswith("this has to be a time: seconds since 1970-01-01 00:00 UTC")


def test_an_id_is_used_once(mes: httpx.Client) -> None:
    store(mes, "4711", id="4711")
    again = {"Idempotency-Key": "another"}
    problem(mes.post(ORDERS, json=ENGINE | {"id": "4711"}, headers=again), 409, "job-order-exists")
    assert tell(mes, "4711", "Cancel").status_code == 200
    problem(mes.post(ORDERS, json=ENGINE | {"id": "4711"}, headers=again), 409, "job-order-exists")
    problem(mes.get(f"{ORDERS}/4711"), 404, "no-job-order")
    assert mes.post(ORDERS, json=ENGINE | {"id": "4712"}, headers=again).status_code == 201  # refusals are not kept


def test_what_is_no_order_is_refused(mes: httpx.Client) -> None:
    for changes in (
        {"work_master": ""},
        {"work_master": "a\x00b"},
        {"priority": -1},
        {"priority": "high"},
        {"priority": 1.5},
        {"due": "tomorrow"},
        {"due": -1},
        {"id": "a b"},
        {"id": "x" * 65},
        {"start": "yes"},
        {"colour": "red"},
    ):
        problem(mes.post(ORDERS, json=ENGINE | changes, headers={"Idempotency-Key": "k"}), 422, "invalid-request")
    assert told(mes) == []


def test_a_change_names_the_revision_that_was_seen(mes: httpx.Client) -> None:
    store(mes, "4711", id="4711")
    place, body = f"{ORDERS}/4711", {"work_master": "truck_engine", "priority": 9}
    problem(mes.put(place, json=body), 428, "revision-needed")
    changed = mes.put(place, json=body, headers={"If-Match": '"1"'})
    assert (changed.status_code, changed.headers["etag"], changed.json()["priority"]) == (200, '"2"', 9)
    assert changed.json()["due"] is None  # what is left out is as if it was new
    problem(mes.put(place, json=body, headers={"If-Match": '"1"'}), 412, "job-order-changed")
    tell(mes, "4711", "Abort")
    problem(mes.put(place, json=body, headers={"If-Match": '"3"'}), 409, "job-order-started")
    problem(mes.put(f"{ORDERS}/4712", json=body, headers={"If-Match": '"1"'}), 404, "no-job-order")


def test_a_command_that_is_not_allowed_says_which_are(mes: httpx.Client) -> None:
    store(mes, "4711", id="4711", start=True)
    refused = problem(tell(mes, "4711", "Pause"), 409, "command-not-allowed")
    assert refused["allowed"] == ["RevokeStart", "Abort", "Cancel"]
    problem(tell(mes, "4712", "Start"), 404, "no-job-order")
    problem(tell(mes, "4711", "Explode"), 422, "invalid-request")
    aborted = tell(mes, "4711", "Abort").json()
    assert (aborted["state"], aborted["allowed"]) == ("Aborted", ["Clear"])
    response = mes.get("/api/v1/job-responses/4711").json()
    assert (response["outcome"], response["operations"], response["abilities"]) == ("aborted", [], [])
    assert [each["job_order"] for each in mes.get("/api/v1/job-responses").json()["job_responses"]] == ["4711"]
    assert tell(mes, "4711", "Clear").json()["allowed"] == []
    problem(mes.get("/api/v1/job-responses/4711"), 404, "no-job-response")


def test_what_was_cancelled_and_aborted_is_told_with_the_reason(mes: httpx.Client) -> None:
    for name in ("kept", "first", "second", "given-up", "cleared"):
        store(mes, name, id=name, due=1000.0)
    assert tell(mes, "first", "Cancel").json()["reason"] is None
    tell(mes, "second", "Cancel", "ordered twice")
    tell(mes, "given-up", "Abort", "no parts")
    tell(mes, "cleared", "Abort")
    tell(mes, "cleared", "Clear")
    found = mes.get(f"{ORDERS}?cancelled=true").json()
    told = [(each["id"], each["reason"], each["allowed"]) for each in found["job_orders"]]
    assert (told, found["next"]) == ([("second", "ordered twice", []), ("first", None, [])], None)
    response = mes.get("/api/v1/job-responses/given-up").json()
    assert (response["outcome"], response["reason"], response["due"]) == ("aborted", "no parts", 1000.0)


def test_pages_stay_as_they_are_while_orders_come(mes: httpx.Client) -> None:
    for number in range(7):
        store(mes, str(number), id=str(number), start=number % 2 == 0)
    seen, cursor = list[str](), 0
    for late in range(3):
        page = mes.get(ORDERS, params={"cursor": cursor, "limit": 3}).json()
        seen += [each["id"] for each in page["job_orders"]]
        cursor = page["next"]
        store(mes, f"late {late}", id=f"late-{late}")
        tell(mes, seen[0], "Abort")
    assert seen == ["0", "1", "2", "3", "4", "5", "6", "late-0", "late-1"]
    states = mes.get(ORDERS, params={"state": "AllowedToStart"}).json()
    assert [each["id"] for each in states["job_orders"]] == ["2", "4", "6"]
    assert states["next"] is None
    problem(mes.get(ORDERS, params={"state": "Gone"}), 422, "invalid-request")


def test_a_key_needs_the_scope_and_a_person_the_role(server: Server, mes: httpx.Client) -> None:
    order = store(mes, "4711")
    for scopes, reads, writes in (((Scope.READ,), 403, 403), ((Scope.ORDERS_READ,), 200, 403)):
        secret, _ = key(server, *scopes)
        headers = {"Authorization": f"Bearer {secret}"}
        assert httpx.get(f"{server.address}{ORDERS}", headers=headers).status_code == reads
        place, body = f"{server.address}{ORDERS}/{order['id']}/commands", {"command": "Start"}
        assert httpx.post(place, json=body, headers=headers).status_code == writes
    with server.client(Role.VIEWER) as viewer, server.client(Role.OPERATOR) as operator:
        assert viewer.get(ORDERS).json()["job_orders"] == [order]
        problem(tell(viewer, order["id"], "Start"), 403, "role-too-low")
        assert tell(operator, order["id"], "Start").status_code == 200


def test_what_a_key_asks_for_while_it_is_revoked_is_not_done(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    secret, made = key(server, Scope.READ, Scope.ORDERS_READ, Scope.ORDERS_WRITE)
    known = OrderService.unknown_work_master

    async def revoked_meanwhile(desk: OrderService, name: str) -> OrderRefused | None:
        with server.identity.database.writing() as connection:
            revoke_key(connection, made.id, SYSTEM, server.identity.now())
        return await known(desk, name)

    monkeypatch.setattr(OrderService, "unknown_work_master", revoked_meanwhile)
    with httpx.Client(base_url=server.address, headers={"Authorization": f"Bearer {secret}"}) as stolen:
        problem(stolen.post(ORDERS, json=ENGINE, headers={"Idempotency-Key": "late"}), 401, "signed-out")
    with server.identity.database.reading() as connection:
        assert orders.count_open(connection) == 0


def test_a_person_who_lets_something_go_on_is_in_control(mes: httpx.Client, client: httpx.Client) -> None:
    order = store(mes, "4711")
    problem(tell(client, order["id"], "Resume"), 409, "control-needed")
    problem(tell(mes, order["id"], "Resume"), 409, "command-not-allowed")


def test_what_can_be_ordered_is_told_and_nothing_else_is_taken(mes: httpx.Client) -> None:
    able = mes.get("/api/v1/capabilities").json()
    assert list(able["work_masters"]) == ["truck_engine"]
    assert "robot" in able["equipment"]
    assert list(able["personnel"]) == ["operator"]
    assert able["job_orders"]["now"] == 0
    wrong = mes.post(ORDERS, json={"work_master": "motor"}, headers={"Idempotency-Key": "k"})
    assert "truck_engine" in problem(wrong, 422, "unknown-work-master")["detail"]
    store(mes, "4711")
    assert mes.get("/api/v1/capabilities").json()["job_orders"]["now"] == 1


def test_orders_are_taken_while_the_controller_is_away(mes: httpx.Client, controller: Telling) -> None:
    controller.publishing = False
    until(lambda: mes.get("/api/v1/station").status_code == 503)
    problem(mes.get("/api/v1/capabilities"), 503, "controller-unavailable")
    assert store(mes, "4711", start=True)["state"] == "AllowedToStart"
    controller.publishing = True


@pytest.mark.skipif(shutil.which("curl") is None, reason="there is no curl here")
def test_what_the_documentation_types_orders_an_engine(mes: httpx.Client, server: Server, tmp_path: Path) -> None:
    lines = snippet("docs/mes.md", "job-orders/4711")
    secret = mes.headers["Authorization"].removeprefix("Bearer ")
    printed = typed(lines, tmp_path, STATION=server.address, STATION_KEY=secret)
    assert '"outcome":"aborted"' in printed
    assert [kind for _, kind, _ in told(mes)] == ["job-order-stored", "job-order-aborted", "job-order-cleared"]


def test_every_answer_says_what_the_order_waits_for_as_it_is_read_right_after(mes: httpx.Client) -> None:
    def same(answer: httpx.Response, waits_for: list[str]) -> None:
        assert answer.is_success, answer.text
        read = mes.get(f"{ORDERS}/engine").json()
        [listed] = mes.get(ORDERS).json()["job_orders"]
        assert answer.json()["waits_for"] == read["waits_for"] == listed["waits_for"] == waits_for

    freely = ["the station works freely"]
    order = {**ENGINE, "id": "engine", "start": True}
    same(mes.post(ORDERS, json=order, headers={"Idempotency-Key": "1"}), freely)
    same(tell(mes, "engine", "RevokeStart"), [])
    same(tell(mes, "engine", "Start"), freely)
    later = ENGINE | {"earliest": "2126-01-15T06:00:00Z"}
    same(
        mes.put(f"{ORDERS}/engine", json=later, headers={"If-Match": "*"}),
        [*freely, "not before 2126-01-15 06:00:00 UTC"],
    )
    told = mes.get(f"{ORDERS}/engine").json()["waits_for_messages"]
    assert [each["id"] for each in told] == ["order-waits.freely", "order-waits.earliest"]
    assert told[1]["arguments"] == {"time": "2126-01-15 06:00:00"}
    same(tell(mes, "engine", "Abort"), [])
