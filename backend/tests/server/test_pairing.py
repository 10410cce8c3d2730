"""Pairing watches: an operator's code, a watch that redeems it, and a confirmation."""

from __future__ import annotations

import threading
import time

import httpx
import pytest
from sqlalchemy import select
from websockets.exceptions import InvalidStatus

from sequence_planner.db.metadata import METADATA
from sequence_planner.server.http.credentials import watch_cookie
from support.server import Controller, Server
from support.waiting import patience, until

from .test_acting import problem
from .test_people import records
from .test_stream import hear
from .watching import DAY, OWN, WATCHES, Device, active, confirm, later, offer, paired, station


def test_a_watch_is_offered_paired_confirmed_and_shown_its_tasks(client: httpx.Client, device: Device) -> None:
    assert device.state() == "signed-out"
    made = offer(client)
    (listed,) = client.get(WATCHES).json()["offers"]
    assert (listed["id"], listed["name"], listed["resource"]) == (made["id"], "Watch 1", "operator")
    assert listed["expires"] == made["expires"] == pytest.approx(time.time() + 120, abs=30)
    answer = device.pair(made["code"])
    assert (answer.status_code, answer.headers["cache-control"]) == (201, "no-store")
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    assert answer.json() == {**answer.json(), "name": "Watch 1", "resource": "operator", "state": "waiting"}
    watch = answer.json()["id"]
    (waiting,) = client.get(WATCHES).json()["watches"]
    assert (waiting["id"], waiting["state"]) == (watch, "waiting")
    assert (waiting["agent"], waiting["address"]) == ("a watch", "127.0.0.1")
    assert client.get(WATCHES).json()["offers"] == []
    assert device.state() == "waiting"
    assert confirm(client, watch).status_code == 204
    assert device.state() == "active"
    (listed,) = client.get(WATCHES).json()["watches"]
    assert listed["expires"] == pytest.approx(time.time() + 90 * DAY, abs=30)
    with device.listen() as stream:
        message = hear(stream)
    assert message == {
        "kind": "watch",
        "time": message["time"],
        "age": pytest.approx(0.5, abs=patience(0.5)),
        "station": "Bolting",
        "mode": "automatic",
        "standing": "working",
        "silent": [],
        "failing": [],
        "alarm": None,
        "next": None,
        "progress": {"done": 0, "all": 1},
        "doing": [],
        "awaits_order": False,
        "tasks": {OWN: station().tasks[OWN].model_dump(mode="json")},
    }


def test_the_journal_names_who_paired_which_watch(server: Server, client: httpx.Client, device: Device) -> None:
    watch = active(client, device)
    client.delete(f"{WATCHES}/{watch}")
    told = {each.entry.action: each.entry for each in records(server)}
    for action in ("watch-offered", "watch-confirmed", "watch-revoked"):
        assert told[action].actor.name.startswith("Operator")
        assert told[action].subject == "watch Watch 1"
    assert told["watch-redeemed"].actor.address == "127.0.0.1"


def test_codes_and_credentials_are_told_once_and_kept_nowhere(
    server: Server, client: httpx.Client, device: Device
) -> None:
    made = offer(client)
    assert made["code"] not in client.get(WATCHES).text
    answer = device.pair(made["code"])
    token = device.cookies[watch_cookie(server.settings)]
    assert token not in answer.text
    assert token not in client.get(WATCHES).text
    with server.identity.database.reading() as connection:
        rows = [str(row) for table in METADATA.sorted_tables for row in connection.execute(select(table))]
    assert not any(secret in row for row in rows for secret in (made["code"], token))


def test_a_code_works_once(client: httpx.Client, device: Device, another: Device) -> None:
    code = offer(client)["code"]
    assert device.pair(code).status_code == 201
    problem(another.pair(code), 403, "wrong-code")
    assert another.state() == "signed-out"
    assert device.state() == "waiting"


def test_of_two_watches_that_use_a_code_at_the_same_time_one_is_paired(server: Server, client: httpx.Client) -> None:
    for attempt in range(4):
        code = offer(client, f"Watch {attempt}")["code"]
        ready = threading.Barrier(2)
        answers: list[httpx.Response] = []

        def ask(ready: threading.Barrier, code: str, answers: list[httpx.Response]) -> None:
            with Device(server) as device:
                ready.wait(5)
                answers.append(device.pair(code))

        asking = [threading.Thread(target=ask, args=(ready, code, answers)) for _ in range(2)]
        for thread in asking:
            thread.start()
        for thread in asking:
            thread.join(10)
        assert sorted(answer.status_code for answer in answers) == [201, 403]
    assert len(client.get(WATCHES).json()["watches"]) == 4


def test_whatever_is_wrong_with_a_code_the_answer_is_the_same(
    server: Server, client: httpx.Client, device: Device, another: Device
) -> None:
    used, withdrawn, expired = (offer(client, f"Watch {number}") for number in range(3))
    device.pair(used["code"])
    assert client.delete(f"{WATCHES}/offers/{withdrawn['id']}").status_code == 204
    known = {each["code"] for each in (used, withdrawn, expired)}
    never = next(code for number in range(4) if (code := f"{number:08}") not in known)
    later(server, 120)
    answers = [another.pair(code) for code in (never, used["code"], withdrawn["code"], expired["code"])]
    problem(answers[0], 403, "wrong-code")
    assert len({(answer.status_code, answer.text) for answer in answers}) == 1
    own = ("date", "x-request-id")  # of each answer
    assert {key: value for key, value in answers[0].headers.items() if key not in own} == {
        key: value for key, value in answers[3].headers.items() if key not in own
    }
    assert another.state() == "signed-out"


def test_a_code_expires_after_two_minutes(server: Server, client: httpx.Client, device: Device) -> None:
    code = offer(client)["code"]
    later(server, 121)
    problem(device.pair(code), 403, "wrong-code")
    assert client.get(WATCHES).json()["offers"] == []


def test_a_code_that_was_withdrawn_is_worth_nothing(client: httpx.Client, device: Device) -> None:
    made = offer(client)
    assert client.delete(f"{WATCHES}/offers/{made['id']}").status_code == 204
    problem(device.pair(made["code"]), 403, "wrong-code")
    problem(client.delete(f"{WATCHES}/offers/{made['id']}"), 404, "no-offer")


def test_guessing_is_limited_and_the_right_code_is_refused_then_too(
    server: Server, client: httpx.Client, device: Device
) -> None:
    code = offer(client)["code"]
    answers = [device.pair(f"{number:08}") for number in range(100) if f"{number:08}" != code]
    assert [answer.status_code for answer in answers[:6]] == [403] * 5 + [429]
    assert {answer.status_code for answer in answers[5:]} == {429}
    refused = device.pair(code)
    problem(refused, 429, "too-many-attempts")
    assert 0 < int(refused.headers["retry-after"]) <= 60
    later(server, 61)
    assert device.pair(code).status_code == 201


def test_a_watch_that_nobody_confirms_is_told_nothing_and_is_gone_after_two_minutes(
    server: Server, client: httpx.Client, device: Device
) -> None:
    watch = paired(client, device)
    problem(device.acknowledge(OWN), 403, "wearable-unconfirmed")
    with pytest.raises(InvalidStatus) as refused:
        device.listen()
    assert refused.value.response.status_code == 403
    later(server, 121)
    assert device.state() == "signed-out"
    problem(confirm(client, watch), 404, "no-wearable")
    assert client.get(WATCHES).json()["watches"] == []


def test_a_watch_that_is_refused_does_not_come_in(client: httpx.Client, device: Device) -> None:
    made = offer(client)
    watch = device.pair(made["code"]).json()["id"]
    assert client.delete(f"{WATCHES}/{watch}").status_code == 204
    assert device.state() == "signed-out"
    problem(confirm(client, watch), 409, "wearable-not-waiting")
    problem(device.pair(made["code"]), 403, "wrong-code")
    assert device.state() == "signed-out"


def test_the_resources_to_choose_from_are_those_with_tasks_for_people(
    client: httpx.Client, controller: Controller
) -> None:
    controller.show(station())
    until(lambda: len(client.get(WATCHES).json()["resources"]) == 2)
    assert client.get(WATCHES).json()["resources"] == [
        {"name": "inspector", "title": "Inspector"},
        {"name": "operator", "title": "Operator"},
    ]
    for resource in ("robot", "nobody", "\u0000"):
        answer = client.post(f"{WATCHES}/offers", json={"name": "Watch", "resource": resource})
        problem(answer, 422, "no-such-resource")


def test_a_wrong_offer_is_told_where_it_is_wrong(client: httpx.Client) -> None:
    wrong: list[tuple[dict[str, object], str]] = [
        ({"resource": "operator"}, "body.name"),
        ({"name": "", "resource": "operator"}, "body.name"),
        ({"name": "\u0000", "resource": "operator"}, "body.name"),
        ({"name": "x" * 101, "resource": "operator"}, "body.name"),
        ({"name": "Watch"}, "body.resource"),
        ({"name": "Watch", "resource": ""}, "body.resource"),
        ({"name": "Watch", "resource": "operator", "state": "active"}, "body.state"),
    ]
    for body, field in wrong:
        found = problem(client.post(f"{WATCHES}/offers", json=body), 422, "invalid-request")
        assert found["errors"][0]["field"] == field
    assert client.get(WATCHES).json()["offers"] == []


def test_what_is_no_code_is_not_counted(client: httpx.Client, device: Device) -> None:
    right = offer(client)["code"]
    wrong: list[object] = ["", "x" * 33, 12345678, None, ["1"], {}]
    for code in wrong:
        found = problem(device.post(f"{WATCHES}/pairing", json={"code": code}), 422, "invalid-request")
        assert found["errors"][0]["field"] == "body.code"
    assert device.pair(f"{right[:4]} {right[4:]}").status_code == 201, "blanks do not matter"


def test_two_watches_do_not_have_one_name(client: httpx.Client, device: Device) -> None:
    watch = active(client, device)
    body = {"name": "WATCH  1", "resource": "operator"}
    problem(client.post(f"{WATCHES}/offers", json=body), 409, "wearable-exists")
    client.delete(f"{WATCHES}/{watch}")
    assert offer(client, "Watch 1")


def test_a_watch_that_is_not_there_is_neither_confirmed_nor_revoked(client: httpx.Client) -> None:
    for watch in ("0123456789abcdef", "no one", "Ä", "self"):
        problem(confirm(client, watch), 404, "no-wearable")
        problem(client.delete(f"{WATCHES}/{watch}"), 404, "no-wearable")
        problem(client.delete(f"{WATCHES}/offers/{watch}"), 404, "no-offer")
