"""Keys of other systems, as an administrator manages them."""

from __future__ import annotations

import time

import httpx
import pytest
from sqlalchemy import select
from websockets.sync.client import connect

from sequence_planner.db.metadata import METADATA
from support.server import Server
from support.waiting import patience, until

from .test_acting import problem
from .test_people import closing_code, records

KEYS = "/api/v1/api-keys"
DAY = 86400.0  # seconds
BODY = {"name": "MES", "scopes": ["read"], "days": 30}


def make(administrator: httpx.Client, **changes: object) -> tuple[str, dict[str, object]]:
    """A new key: its secret, and what is said of it."""
    answer = administrator.post(KEYS, json=BODY | changes)
    assert answer.status_code == 201, answer.text
    assert answer.headers["cache-control"] == "no-store"
    return answer.json()["secret"], answer.json()["key"]


def bearing(secret: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {secret}"}


def ask(server: Server, secret: str, place: str = "station") -> httpx.Response:
    return httpx.get(f"{server.address}/api/v1/{place}", headers=bearing(secret))


def test_a_key_opens_what_its_scopes_say(server: Server, administrator: httpx.Client) -> None:
    reads, _ = make(administrator)
    audits, _ = make(administrator, scopes=["audit"])
    both, key = make(administrator, scopes=["audit", "read", "read"])
    assert key["scopes"] == ["read", "audit"]
    assert (ask(server, reads).status_code, ask(server, both).status_code) == (200, 200)
    assert (ask(server, audits, "audit").status_code, ask(server, both, "audit").status_code) == (200, 200)
    problem(ask(server, reads, "audit"), 403, "scope-missing")
    problem(ask(server, audits), 403, "scope-missing")
    for place in ("users", "api-keys", "wearables"):
        problem(ask(server, both, place), 403, "scope-missing")


def test_a_secret_is_told_once_and_kept_nowhere(server: Server, administrator: httpx.Client) -> None:
    secret, key = make(administrator)
    again = administrator.get(KEYS)
    assert again.json()["keys"] == [key]
    assert secret not in again.text
    assert "secret" not in key
    with server.identity.database.reading() as connection:
        rows = [str(row) for table in METADATA.sorted_tables for row in connection.execute(select(table))]
    assert not any(secret in row or secret.split("_", 2)[2] in row for row in rows)
    created = next(each for each in records(server) if each.entry.action == "key-created")
    assert created.entry.actor.name == key["created_by"]


def test_keys_are_listed_the_newest_first(administrator: httpx.Client) -> None:
    made = [make(administrator, name=name)[1]["name"] for name in ("MES", "ERP", "Historian")]
    listed = [key["name"] for key in administrator.get(KEYS).json()["keys"]]
    assert listed == made[::-1]


def test_a_key_expires_after_its_days(server: Server, administrator: httpx.Client) -> None:
    secret, key = make(administrator, days=2)
    assert key["expires"] == pytest.approx(time.time() + 2 * DAY, abs=30)
    server.identity.now = lambda: time.time() + 2 * DAY - 60
    assert ask(server, secret).status_code == 200
    server.identity.now = lambda: time.time() + 2 * DAY
    problem(ask(server, secret), 401, "signed-out")


def test_a_key_that_is_revoked_opens_nothing_any_more(server: Server, administrator: httpx.Client) -> None:
    secret, key = make(administrator)
    with connect(server.stream, additional_headers=bearing(secret)) as stream:
        stream.recv(patience(2))
        assert administrator.delete(f"{KEYS}/{key['id']}").status_code == 204
        problem(ask(server, secret), 401, "signed-out")
        assert closing_code(stream) == 4401
    (listed,) = administrator.get(KEYS).json()["keys"]
    assert listed["revoked"] == pytest.approx(time.time(), abs=30)
    assert administrator.delete(f"{KEYS}/{key['id']}").status_code == 204, "it is revoked already"
    assert administrator.get(KEYS).json()["keys"] == [listed]
    assert [each.entry.action for each in records(server)].count("key-revoked") == 1


def test_it_is_seen_that_a_key_is_used(server: Server, administrator: httpx.Client) -> None:
    secret, key = make(administrator)
    assert key["last_used"] is None
    ask(server, secret)
    until(lambda: administrator.get(KEYS).json()["keys"][0]["last_used"] is not None)


WRONG: list[tuple[dict[str, object], str]] = [
    ({"name": ""}, "body.name"),
    ({"name": "\u0000"}, "body.name"),
    ({"name": "x" * 101}, "body.name"),
    ({"scopes": []}, "body.scopes"),
    ({"scopes": ["write"]}, "body.scopes"),
    ({"scopes": "read"}, "body.scopes"),
    ({"days": 0}, "body.days"),
    ({"days": 731}, "body.days"),
    ({"days": 1.5}, "body.days"),
    ({"days": "30"}, "body.days"),
    ({"days": True}, "body.days"),
    ({"expires": 0}, "body.expires"),
]


def test_a_wrong_key_is_told_where_it_is_wrong(administrator: httpx.Client) -> None:
    for changes, field in WRONG:
        found = problem(administrator.post(KEYS, json=BODY | changes), 422, "invalid-request")
        assert found["errors"][0]["field"].startswith(field)
    assert administrator.get(KEYS).json() == {"keys": []}


def test_a_key_that_is_not_there_is_not_revoked(administrator: httpx.Client) -> None:
    for key in ("0123456789abcdef", "no one", "Ä"):
        problem(administrator.delete(f"{KEYS}/{key}"), 404, "no-key")


def rotate(administrator: httpx.Client, key: object, **body: object) -> httpx.Response:
    return administrator.post(f"{KEYS}/{key}/rotation", json={"overlap": 24, **body})


def test_a_key_gets_another_secret_and_the_one_before_ends_by_itself(
    server: Server, administrator: httpx.Client
) -> None:
    before, key = make(administrator, days=2)
    answer = rotate(administrator, key["id"])
    assert answer.status_code == 201
    after, rotated = answer.json()["secret"], answer.json()["key"]
    assert after != before
    assert {**rotated, "former_until": None} == key
    assert rotated["former_until"] == pytest.approx(time.time() + DAY, abs=30)
    assert [ask(server, each).status_code for each in (before, after)] == [200, 200]
    server.identity.now = lambda: time.time() + DAY + 1
    problem(ask(server, before), 401, "signed-out")
    assert ask(server, after).status_code == 200
    server.identity.now = lambda: time.time() + 2 * DAY
    problem(ask(server, after), 401, "signed-out")
    [entry] = [each.entry for each in records(server) if each.entry.action == "key-rotated"]
    assert entry.details["former_until"] == rotated["former_until"]
    assert before not in entry.model_dump_json()
    assert after not in entry.model_dump_json()


def test_a_stream_of_the_secret_before_ends_with_it(server: Server, administrator: httpx.Client) -> None:
    before, key = make(administrator)
    with connect(server.stream, additional_headers=bearing(before)) as stream:
        stream.recv(patience(2))
        assert rotate(administrator, key["id"], overlap=0, days=10).status_code == 201
        assert closing_code(stream) == 4401
    problem(ask(server, before), 401, "signed-out")


def test_a_rotation_ends_the_secret_before_the_present_one_and_revoking_ends_all(
    server: Server, administrator: httpx.Client
) -> None:
    first, key = make(administrator)
    second = rotate(administrator, key["id"]).json()["secret"]
    third = rotate(administrator, key["id"]).json()["secret"]
    assert [ask(server, each).status_code for each in (first, second, third)] == [401, 200, 200]
    administrator.delete(f"{KEYS}/{key['id']}")
    assert [ask(server, each).status_code for each in (first, second, third)] == [401, 401, 401]
    problem(rotate(administrator, key["id"]), 409, "key-expired")
    problem(rotate(administrator, "0123456789abcdef"), 404, "no-key")
    for wrong in ({"overlap": -1}, {"overlap": 721}, {"overlap": 0.5}, {"days": 0}, {"days": 731}):
        problem(rotate(administrator, key["id"], **wrong), 422, "invalid-request")
