"""Signing in and out, and what becomes of sessions that are stolen, replayed, planted or left alone."""

from __future__ import annotations

import time
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

import httpx
import pytest

from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.auth.users import Person
from sequence_planner.core.actor import SYSTEM
from sequence_planner.journal.audit import read
from sequence_planner.server.http.credentials import session_cookie
from support.server import Server

from .test_acting import problem

PASSWORD, OTHER = "seven green bolts", "eight green bolts"


@pytest.fixture
def person(server: Server) -> Person:
    """Somebody who knows a password."""
    hashed = server.loop.run(server.identity.passwords.hash(PASSWORD))
    with server.identity.database.writing() as connection:
        return users.create(connection, "Ada", Role.OPERATOR, hashed, SYSTEM, time.time(), temporary=False)


@pytest.fixture
def browser(server: Server) -> Iterator[httpx.Client]:
    with server.client() as browser:
        yield browser


def sign_in(browser: httpx.Client, name: str = "Ada", password: str = PASSWORD) -> httpx.Response:
    return browser.post("/api/v1/session", json={"name": name, "password": password})


def token_of(server: Server, browser: httpx.Client) -> str:
    return browser.cookies[session_cookie(server.settings)]


def works(server: Server, token: str) -> bool:
    """Whether a token, shown by anybody, opens anything."""
    answer = httpx.get(f"{server.address}/api/v1/station", headers=server.cookie(token))
    if answer.status_code == 200:
        return True
    problem(answer, 401, "signed-out")
    return False


def test_who_knows_the_password_is_signed_in(server: Server, browser: httpx.Client, person: Person) -> None:
    before = browser.get("/api/v1/session").json()
    assert (before["state"], before["people"]) == ("first-start", True), "nobody is an administrator"
    assert browser.get("/api/v1/session").json()["version"] is None
    answer = sign_in(browser, " ADA ")
    told = answer.json()
    assert answer.status_code == 200
    assert told["version"] == version("sequence-planner") == browser.get("/healthz").json()["version"]
    assert told["person"] == {"id": person.id, "name": "Ada", "role": "operator", "issuer": None}
    assert (told["state"], told["kind"], told["must_change_password"]) == ("signed-in", "person", False)
    assert 11 * 3600 < told["expires"] - time.time() <= 12 * 3600
    cookie = answer.headers["set-cookie"]
    assert cookie.startswith(f"sequence-planner-{server.settings.port}=")
    assert {"httponly", "path=/", "samesite=strict"} == {each.strip().lower() for each in cookie.split(";")[1:]}
    assert browser.get("/api/v1/session").json() == told
    assert PASSWORD not in answer.text


def test_a_wrong_name_and_a_wrong_password_are_one_answer(browser: httpx.Client, person: Person) -> None:
    answers = [sign_in(browser, password=OTHER), sign_in(browser, "Nobody")]
    texts = {answer.text for answer in answers}
    for answer in answers:
        problem(answer, 401, "wrong-name-or-password")
        assert "set-cookie" not in answer.headers
    assert len(texts) == 1


def test_too_many_attempts_are_told_when_to_come_back(browser: httpx.Client, person: Person) -> None:
    for _ in range(5):
        problem(sign_in(browser, password=OTHER), 401, "wrong-name-or-password")
    answer = sign_in(browser)
    problem(answer, 429, "too-many-attempts")
    assert 0 < int(answer.headers["retry-after"]) <= 60


def test_a_cookie_from_before_is_never_adopted(server: Server, browser: httpx.Client, person: Person) -> None:
    planted, _ = server.session(server.person(Role.VIEWER))
    for before in (planted, "x" * 43):
        browser.cookies.clear()
        browser.cookies.set(session_cookie(server.settings), before, domain="127.0.0.1", path="/")
        answer = sign_in(browser)
        assert answer.status_code == 200
        assert before not in answer.headers["set-cookie"]
        assert not works(server, before)


def test_what_was_signed_out_cannot_be_replayed(server: Server, browser: httpx.Client, person: Person) -> None:
    sign_in(browser)
    token = token_of(server, browser)
    answer = browser.delete("/api/v1/session")
    assert answer.status_code == 204
    assert "max-age=0" in answer.headers["set-cookie"].lower()
    assert not works(server, token)
    assert browser.get("/api/v1/session").json()["session"] is None


def test_two_browsers_are_two_sessions(server: Server, person: Person) -> None:
    with server.client() as one, server.client() as two:
        ids = {sign_in(each).json()["session"] for each in (one, two)}
        assert len(ids) == 2
        one.delete("/api/v1/session")
        assert works(server, token_of(server, two))


def test_another_password_ends_every_session_but_the_new_one(
    server: Server, browser: httpx.Client, person: Person
) -> None:
    elsewhere, _ = server.session(person)
    sign_in(browser)
    before = token_of(server, browser)
    change = {"old": OTHER, "new": OTHER}
    problem(browser.put("/api/v1/session/password", json=change), 422, "weak-password")
    change = {"old": "not this one at all", "new": OTHER}
    problem(browser.put("/api/v1/session/password", json=change), 403, "wrong-password")
    assert browser.put("/api/v1/session/password", json={"old": PASSWORD, "new": OTHER}).status_code == 200
    assert not works(server, before)
    assert not works(server, elsewhere)
    assert works(server, token_of(server, browser))
    problem(sign_in(browser), 401, "wrong-name-or-password")


def test_who_must_change_the_password_can_do_that_alone(server: Server, browser: httpx.Client) -> None:
    hashed = server.loop.run(server.identity.passwords.hash(PASSWORD))
    with server.identity.database.writing() as connection:
        users.create(connection, "Ben", Role.OPERATOR, hashed, SYSTEM, time.time(), temporary=True)
    assert sign_in(browser, "Ben").json()["must_change_password"] is True
    problem(browser.get("/api/v1/station"), 403, "password-must-change")
    changed = browser.put("/api/v1/session/password", json={"old": PASSWORD, "new": OTHER})
    assert changed.json()["must_change_password"] is False
    assert browser.get("/api/v1/station").status_code == 200


@pytest.mark.parametrize("headers", [{"Origin": "http://evil.example"}, {"Sec-Fetch-Site": "cross-site"}])
def test_a_foreign_page_signs_nobody_in(browser: httpx.Client, person: Person, headers: dict[str, str]) -> None:
    answer = browser.post("/api/v1/session", json={"name": "Ada", "password": PASSWORD}, headers=headers)
    problem(answer, 403, "foreign-origin")
    form = browser.post("/api/v1/session", data={"name": "Ada", "password": PASSWORD})
    assert form.status_code in (400, 415)
    assert "set-cookie" not in form.headers


def test_no_secret_is_written_anywhere(server: Server, browser: httpx.Client, person: Person) -> None:
    sign_in(browser)
    sign_in(browser, password=OTHER)
    token = token_of(server, browser)
    with server.identity.database.reading() as connection:
        records = "".join(record.model_dump_json() for record in read(connection, limit=200))
    file = Path(server.settings.database.removeprefix("sqlite:///"))
    kept = b"".join(file.with_name(f"{file.name}{end}").read_bytes() for end in ("", "-wal"))
    for secret in (PASSWORD, OTHER, token):
        assert secret not in records
        assert secret.encode() not in kept
