"""The people of the station, as an administrator manages them."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Mapping

import httpx
import pytest
from sqlalchemy import select
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.metadata import METADATA
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Record
from support.server import Server, listen
from support.waiting import patience

from .test_acting import problem

PEOPLE = "/api/v1/users"
TEMPORARY = "a temporary password"
BODY = {"name": "Eva Lund", "role": "operator", "password": TEMPORARY}


def enter(administrator: httpx.Client, **changes: object) -> dict[str, object]:
    """A new person."""
    answer = administrator.post(PEOPLE, json=BODY | changes)
    assert answer.status_code == 201, answer.text
    found: dict[str, object] = answer.json()
    return found


def listed(administrator: httpx.Client) -> dict[str, dict[str, object]]:
    """Everybody, by name."""
    return {each["name"]: each for each in administrator.get(PEOPLE).json()["people"]}


def change(
    administrator: httpx.Client, person: Mapping[str, object], body: Mapping[str, object], revision: object = None
) -> httpx.Response:
    headers = {"If-Match": f'"{person["revision"] if revision is None else revision}"'}
    return administrator.patch(f"{PEOPLE}/{person['id']}", json=body, headers=headers)


def closing_code(stream: ClientConnection, within: float = 2.0) -> int:
    """Why the server closes `stream`, in so many seconds."""
    deadline = time.monotonic() + patience(within)
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            stream.recv(max(0.0, deadline - time.monotonic()))
    assert closed.value.rcvd is not None
    return closed.value.rcvd.code


def records(server: Server) -> list[Record]:
    with server.identity.database.reading() as connection:
        return audit.read(connection)


@pytest.fixture
def browser(server: Server) -> Iterator[httpx.Client]:
    """The browser of somebody who has not signed in yet."""
    with server.client() as browser:
        yield browser


def sign_in(browser: httpx.Client, password: str, name: str = "eva lund") -> httpx.Response:
    return browser.post("/api/v1/session", json={"name": name, "password": password})


def test_a_person_is_entered_and_has_to_choose_another_password(
    server: Server, administrator: httpx.Client, browser: httpx.Client
) -> None:
    answer = administrator.post(PEOPLE, json=BODY)
    assert (answer.status_code, answer.headers["etag"]) == (201, '"1"')
    assert answer.json()["name"] == "Eva Lund"
    assert listed(administrator)["Eva Lund"] == answer.json()
    assert sign_in(browser, TEMPORARY).json()["must_change_password"]
    assert listed(administrator)["Eva Lund"]["sessions"] == 1
    problem(browser.get("/api/v1/wearables"), 403, "password-must-change")
    changed = browser.put("/api/v1/session/password", json={"old": TEMPORARY, "new": "a password of her own"})
    assert not changed.json()["must_change_password"]
    assert browser.get("/api/v1/wearables").status_code == 200
    created = next(each for each in records(server) if each.entry.action == "person-created")
    assert created.entry.actor.name.startswith("Administrator")
    assert created.entry.actor.address == "127.0.0.1"
    assert created.entry.subject == "person Eva Lund"


def test_a_password_is_kept_nowhere(server: Server, administrator: httpx.Client) -> None:
    person = enter(administrator)
    another = "another temporary one"
    assert administrator.put(f"{PEOPLE}/{person['id']}/password", json={"password": another}).status_code == 204
    weak = administrator.post(PEOPLE, json=BODY | {"name": "Olle", "password": "hunter2"})
    assert "hunter2" not in weak.text
    with server.identity.database.reading() as connection:
        rows = [str(row) for table in METADATA.sorted_tables for row in connection.execute(select(table))]
    assert rows
    assert not any(secret in row for row in rows for secret in (TEMPORARY, another, "hunter2"))


def test_people_are_listed_by_name(administrator: httpx.Client) -> None:
    for name in ("ölle", "Zoe", "anna", "Berta"):
        enter(administrator, name=name)
    names = [each["name"] for each in administrator.get(PEOPLE).json()["people"]]
    assert [name for name in names if not name.startswith("Administrator")] == ["anna", "Berta", "Zoe", "ölle"]
    assert administrator.get(PEOPLE).json() == administrator.get(PEOPLE).json()


def test_two_people_do_not_have_one_name(administrator: httpx.Client) -> None:
    enter(administrator)
    for name in ("eva lund", " EVA  LUND ", "Ｅva Lund", "Eva-Lund"):
        problem(administrator.post(PEOPLE, json=BODY | {"name": name}), 409, "name-taken")


WRONG: list[tuple[dict[str, object], str]] = [
    ({"name": ""}, "body.name"),
    ({"name": "  "}, "body.name"),
    ({"name": "x" * 101}, "body.name"),
    ({"name": "Eva\u0000"}, "body.name"),
    ({"name": "Eva\u202e"}, "body.name"),
    ({"name": 7}, "body.name"),
    ({"role": "boss"}, "body.role"),
    ({"role": None}, "body.role"),
    ({"password": ""}, "body.password"),
    ({"password": "x" * 257}, "body.password"),
    ({"password": None}, "body.password"),
    ({"disabled": True}, "body.disabled"),
]


def test_a_wrong_person_is_told_where_it_is_wrong(administrator: httpx.Client) -> None:
    before = listed(administrator)
    for changes, field in WRONG:
        found = problem(administrator.post(PEOPLE, json=BODY | changes), 422, "invalid-request")
        assert found["errors"][0]["field"] == field
    assert listed(administrator) == before


def test_a_weak_password_is_refused(administrator: httpx.Client) -> None:
    person = enter(administrator)
    for password in ("short", "xxxxxxxxxxxxxxxx", "my name is eva lund"):
        problem(administrator.post(PEOPLE, json=BODY | {"password": password}), 422, "weak-password")
        answer = administrator.put(f"{PEOPLE}/{person['id']}/password", json={"password": password})
        problem(answer, 422, "weak-password")


def test_a_change_names_the_revision_that_was_seen(administrator: httpx.Client) -> None:
    person = enter(administrator)
    place = f"{PEOPLE}/{person['id']}"
    problem(administrator.patch(place, json={"role": "engineer"}), 428, "revision-needed")
    for odd in ("1", '"one"', 'W/"1"', '"1", "2"', '""', '"99999999999999999999"'):
        answer = administrator.patch(place, json={"role": "engineer"}, headers={"If-Match": odd})
        assert problem(answer, 422, "invalid-request")["errors"][0]["field"] == "header.if-match"
    problem(change(administrator, person, {"role": "engineer"}, revision=7), 412, "user-changed")
    assert listed(administrator)["Eva Lund"] == person
    answer = change(administrator, person, {"role": "engineer"})
    assert (answer.status_code, answer.headers["etag"]) == (200, '"2"')
    assert answer.json() == listed(administrator)["Eva Lund"] == person | {"role": "engineer", "revision": 2}
    problem(change(administrator, person, {"disabled": True}), 412, "user-changed")
    whichever = administrator.patch(place, json={"role": "viewer"}, headers={"If-Match": "*"})
    assert (whichever.status_code, whichever.headers["etag"]) == (200, '"3"')
    assert administrator.patch(place, json={"role": "engineer"}, headers={"If-Match": '"3"'}).status_code == 200


def test_a_wrong_change_changes_nothing(administrator: httpx.Client) -> None:
    person = enter(administrator)
    wrong: list[dict[str, object]] = [{}, {"role": None}, {"role": "boss"}, {"disabled": "perhaps"}, {"name": "Eve"}]
    for body in wrong:
        found = problem(change(administrator, person, body), 422, "invalid-request")
        assert found["errors"][0]["field"].startswith("body")
    assert listed(administrator)["Eva Lund"] == person


def test_of_two_changes_at_the_same_time_one_is_refused(server: Server, administrator: httpx.Client) -> None:
    person = enter(administrator)
    for role in ("engineer", "viewer", "operator"):
        answers: list[httpx.Response] = []
        ready = threading.Barrier(2)

        def ask(ready: threading.Barrier, answers: list[httpx.Response], person: dict[str, object], role: str) -> None:
            with server.client(Role.ADMINISTRATOR) as another:
                ready.wait(5)
                answers.append(change(another, person, {"role": role}))

        asking = [threading.Thread(target=ask, args=(ready, answers, person, role)) for _ in range(2)]
        for thread in asking:
            thread.start()
        for thread in asking:
            thread.join(10)
        assert sorted(answer.status_code for answer in answers) == [200, 412]
        person = listed(administrator)["Eva Lund"]
        assert person["role"] == role


def test_a_change_of_what_somebody_may_do_ends_their_sessions(server: Server, administrator: httpx.Client) -> None:
    changes: list[dict[str, object]] = [{"role": "viewer"}, {"disabled": True}]
    for number, body in enumerate(changes):
        person = server.person(name=f"Olle {number}")
        with server.client(token=server.session(person)[0]) as browser:
            assert browser.get("/api/v1/wearables").status_code == 200
            assert change(administrator, person.model_dump(), body).status_code == 200
            problem(browser.get("/api/v1/wearables"), 401, "signed-out")


def test_whoever_is_disabled_cannot_sign_in_until_enabled_again(
    administrator: httpx.Client, browser: httpx.Client
) -> None:
    person = enter(administrator)
    disabled = change(administrator, person, {"disabled": True}).json()
    problem(sign_in(browser, TEMPORARY), 401, "wrong-name-or-password")
    assert change(administrator, disabled, {"disabled": False}).json()["revision"] == 3
    assert sign_in(browser, TEMPORARY).status_code == 200


def test_the_last_administrator_stays(server: Server, administrator: httpx.Client) -> None:
    (last,) = listed(administrator).values()
    changes: list[dict[str, object]] = [{"role": "engineer"}, {"disabled": True}]
    for body in changes:
        problem(change(administrator, last, body), 409, "last-administrator")
    server.person(Role.ADMINISTRATOR)
    assert change(administrator, last, {"role": "engineer"}).status_code == 200
    problem(administrator.get(PEOPLE), 401, "signed-out")


def test_a_password_that_an_administrator_gives_is_temporary_and_ends_all_sessions(
    administrator: httpx.Client, browser: httpx.Client
) -> None:
    person = enter(administrator)
    sign_in(browser, TEMPORARY)
    answer = administrator.put(f"{PEOPLE}/{person['id']}/password", json={"password": "another temporary one"})
    assert (answer.status_code, answer.content) == (204, b"")
    assert browser.get("/api/v1/session").json()["state"] == "signed-out"
    problem(sign_in(browser, TEMPORARY), 401, "wrong-name-or-password")
    assert sign_in(browser, "another temporary one").json()["must_change_password"]


def test_somebody_is_signed_out_everywhere(server: Server, administrator: httpx.Client) -> None:
    person = server.person(name="Olle")
    tokens = [server.session(person)[0] for _ in range(3)]
    assert listed(administrator)["Olle"]["sessions"] == 3
    with listen(server, headers=server.cookie(tokens[0])) as stream:
        stream.recv(patience(2))
        assert administrator.delete(f"{PEOPLE}/{person.id}/sessions").status_code == 204
        assert closing_code(stream) == 4401
    for token in tokens:
        with server.client(token=token) as browser:
            problem(browser.get("/api/v1/wearables"), 401, "signed-out")
    assert listed(administrator)["Olle"]["sessions"] == 0


def test_who_is_not_there_is_not_changed(administrator: httpx.Client) -> None:
    for person in ("0123456789abcdef", "no one", "Ä", "'; drop table people; --"):
        place = f"{PEOPLE}/{person}"
        headers = {"If-Match": '"1"'}
        problem(administrator.patch(place, json={"role": "viewer"}, headers=headers), 404, "no-user")
        problem(administrator.put(f"{place}/password", json={"password": TEMPORARY}), 404, "no-user")
        problem(administrator.delete(f"{place}/sessions"), 404, "no-user")


def test_a_form_is_not_read(administrator: httpx.Client) -> None:
    problem(administrator.post(PEOPLE, data={"name": "Eva"}), 415, "not-json")


def test_who_is_disabled_while_a_hash_is_made_has_done_nothing(
    server: Server, administrator: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    outcast = server.person(Role.ADMINISTRATOR)
    passwords, database = server.identity.passwords, server.identity.database
    hashed_by = passwords.hash

    async def hash_meanwhile(password: str) -> str:
        with database.writing() as connection:
            users.change(connection, outcast.id, outcast.revision, SYSTEM, time.time(), disabled=True)
        return await hashed_by(password)

    monkeypatch.setattr(passwords, "hash", hash_meanwhile)
    with server.client(token=server.session(outcast)[0]) as browser:
        problem(browser.post(PEOPLE, json=BODY | {"role": "administrator"}), 401, "signed-out")
    assert "Eva Lund" not in listed(administrator)
