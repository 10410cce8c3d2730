"""What becomes of streams, of control and of screens when a session ends, or the database does not answer."""

from __future__ import annotations

import contextlib
import time
from contextlib import ExitStack
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from sequence_planner.auth import api_keys, sessions, users, watches
from sequence_planner.auth.roles import Role, Scope
from sequence_planner.auth.sessions import SignedIn
from sequence_planner.controller.commands.execution import WithdrawControl
from sequence_planner.controller.commands.tasks import AcknowledgeTask
from sequence_planner.controller.views.part import ControlView
from sequence_planner.core.actor import SYSTEM
from sequence_planner.server import metrics
from sequence_planner.server.http.credentials import watch_cookie
from support.example_view import example_view
from support.server import Controller, Server
from support.waiting import patience, until

from .bearers import key, watch
from .test_acting import problem

CLOSED_WITHIN = 2.0  # seconds


def control_of(signed_in: SignedIn) -> ControlView:
    person = signed_in.person
    return ControlView(session=signed_in.session, person=person.id, name=person.name, since=1.0, taken_from=None)


def code_of(stream: ClientConnection) -> int:
    """The code with which a stream is closed, in time."""
    deadline = time.monotonic() + patience(CLOSED_WITHIN)
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            stream.recv(max(0.0, deadline - time.monotonic()))
    assert closed.value.rcvd is not None
    return closed.value.rcvd.code


def test_the_streams_of_a_session_that_has_ended_are_closed(server: Server) -> None:
    for path in ("/stream", "/ros/stream", "/pipelines/stream"):
        token, signed_in = server.session(server.person())
        address = server.stream.replace("/stream", path)
        with connect(address, additional_headers=server.cookie(token)) as stream:
            stream.recv(patience(2))
            with server.identity.database.writing() as connection:
                sessions.end_session(connection, signed_in.session, SYSTEM, time.time())
            assert code_of(stream) == 4401


def test_the_streams_of_a_disabled_person_a_key_and_a_watch_are_closed(server: Server) -> None:
    person = server.person()
    secret, made = key(server, Scope.READ)
    worn, paired = watch(server, "Watch of Ada")
    shown = (
        (server.stream, server.cookie(server.session(person)[0])),
        (server.stream, {"Authorization": f"Bearer {secret}"}),
        (
            server.stream.replace("/stream", "/wearables/stream"),
            {"Cookie": f"{watch_cookie(server.settings)}={worn}"},
        ),
    )
    with ExitStack() as open_ones:
        streams = [open_ones.enter_context(connect(where, additional_headers=headers)) for where, headers in shown]
        now = time.time()
        with server.identity.database.writing() as connection:
            users.change(connection, person.id, person.revision, SYSTEM, now, disabled=True)
            api_keys.revoke_key(connection, made.id, SYSTEM, now)
            watches.revoke(connection, paired.id, SYSTEM, now)
        assert [code_of(stream) for stream in streams] == [4401, 4401, 4401]


def test_signing_out_gives_control_up_at_once(server: Server, controller: Controller) -> None:
    token, signed_in = server.session(server.person())
    controller.show(example_view(control=control_of(signed_in)))
    with server.client(token=token) as browser:
        until(lambda: server.app.state.controller.view.control is not None)
        browser.delete("/api/v1/session")
    assert controller.commands[0] == WithdrawControl(actor=SYSTEM, session=signed_in.session)


def test_control_is_taken_from_a_session_that_has_ended_and_from_no_other(
    server: Server, controller: Controller
) -> None:
    _, signed_in = server.session(server.person())
    controller.show(example_view(control=control_of(signed_in)))
    with pytest.raises(AssertionError):
        until(lambda: bool(controller.commands), seconds=1.5)
    begun = time.monotonic()
    with server.identity.database.writing() as connection:
        sessions.end_session(connection, signed_in.session, SYSTEM, time.time())
    until(lambda: bool(controller.commands))
    assert time.monotonic() - begun < patience(2)
    assert controller.commands[0] == WithdrawControl(actor=SYSTEM, session=signed_in.session)


def test_control_is_taken_away_after_whatever_went_wrong_before(server: Server, controller: Controller) -> None:
    _, signed_in = server.session(server.person())
    controller.show(example_view(control=control_of(signed_in)))
    asked: list[None] = []

    def no_clock() -> float:
        asked.append(None)
        raise RuntimeError("no clock")

    server.identity.now = no_clock
    until(lambda: bool(asked))
    server.identity.now = time.time
    with server.identity.database.writing() as connection:
        sessions.end_session(connection, signed_in.session, SYSTEM, time.time())
    until(lambda: bool(controller.commands))
    assert controller.commands[0] == WithdrawControl(actor=SYSTEM, session=signed_in.session)


def test_a_watch_acknowledges_what_is_asked_of_its_resource_alone(server: Server, controller: Controller) -> None:
    for resource, status in (("operator", 204), ("robot", 403)):
        token, made = watch(server, f"Watch at {resource}", resource=resource)
        headers = {"Cookie": f"{watch_cookie(server.settings)}={token}"}
        address = f"{server.address}/api/v1/tasks/7/acknowledgement"
        answer = httpx.post(address, json={"revision": 3}, headers=headers)
        assert answer.status_code == status
        if status == 204:
            acknowledged = AcknowledgeTask(actor=made.actor("127.0.0.1"), task="7", revision=3)
            assert controller.commands == [acknowledged]
            gone = httpx.post(address.replace("tasks/7", "tasks/8"), json={"revision": 3}, headers=headers)
            problem(gone, 409, "task-gone")
            changed = httpx.post(address, json={"revision": 4}, headers=headers)
            problem(changed, 409, "task-changed")  # by the server itself: it is no command
        else:
            problem(answer, 403, "not-your-task")
    assert len(controller.commands) == 1


def take_away(server: Server) -> Path:
    """Let the database be gone; it is put back by renaming what is returned."""
    file = Path(server.settings.database.removeprefix("sqlite:///"))
    away = file.with_name("away.sqlite")
    server.identity.database.close()
    file.rename(away)
    server.identity.database.close()
    return away


def test_while_the_database_is_away_who_was_there_goes_on_and_nobody_else_comes_in(server: Server) -> None:
    token, _ = server.session(server.person())
    secret, _ = key(server, Scope.READ)
    stranger, _ = server.session(server.person(Role.ADMINISTRATOR))
    with (
        server.client(token=token) as browser,
        server.client(token=stranger) as other,
        httpx.Client(base_url=server.address, headers={"Authorization": f"Bearer {secret}"}) as system,
        connect(server.stream, additional_headers=server.cookie(token)) as stream,
    ):
        assert (browser.get("/api/v1/state").status_code, system.get("/api/v1/state").status_code) == (200, 200)
        away = take_away(server)
        assert system.get("/api/v1/state").status_code == 200
        for _ in range(3):
            assert browser.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204
        begun = time.monotonic()
        while time.monotonic() - begun < 2.5:
            stream.recv(patience(1))
        found = problem(other.get("/api/v1/state"), 503, "storage-unavailable")
        assert str(away.parent) not in found["detail"]
        for refused in (
            browser.delete("/api/v1/session"),
            browser.get("/api/v1/wearables"),
            other.post("/api/v1/session", json={"name": "Ada", "password": "seven green bolts"}),
            httpx.get(f"{server.address}/api/v1/session", headers=server.cookie(stranger)),
        ):
            problem(refused, 503, "storage-unavailable")
        away.rename(away.with_name("station.sqlite"))
        assert other.get("/api/v1/state").status_code == 200


def test_what_cannot_be_written_keeps_nobody_from_pausing(server: Server) -> None:
    token, _ = server.session(server.person())
    onlooker, _ = server.session(server.person(Role.VIEWER))
    with server.client(token=token) as browser, server.client(token=onlooker) as other:
        assert (browser.get("/api/v1/state").status_code, other.get("/api/v1/state").status_code) == (200, 200)
        take_away(server)
        problem(other.delete("/api/v1/session"), 503, "storage-unavailable")
        assert browser.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204


def test_who_has_signed_out_stays_out_and_others_pause_as_long_as_their_sessions_would_last(server: Server) -> None:
    token, _ = server.session(server.person())
    late, _ = server.session(server.person())
    with server.client(token=token) as browser, server.client(token=late) as other:
        assert other.get("/api/v1/state").status_code == 200
        assert browser.get("/api/v1/state").status_code == 200
        assert browser.delete("/api/v1/session").status_code == 204
        take_away(server)  # the other has asked for nothing since
        problem(browser.put("/api/v1/mode", json={"mode": "paused"}), 503, "storage-unavailable")
        began = server.identity.now()
        for minutes in (6, 60, 119):
            server.identity.now = lambda minutes=minutes: began + 60.0 * minutes  # type: ignore[misc]
            assert other.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204
        server.identity.now = lambda: began + 60.0 * 180  # an hour without a request
        problem(other.put("/api/v1/mode", json={"mode": "paused"}), 503, "storage-unavailable")


def test_that_a_colleague_has_just_signed_in_keeps_nobody_from_holding_while_the_database_is_away(
    server: Server,
) -> None:
    token, _ = server.session(server.person())
    hashed = server.loop.run(server.identity.passwords.hash("seven green bolts"))
    with server.identity.database.writing() as connection:
        users.create(connection, "Ada", Role.OPERATOR, hashed, SYSTEM, time.time(), temporary=False)
    with server.client(token=token) as browser, server.client() as colleague:
        assert browser.get("/api/v1/state").status_code == 200
        signing_in = {"name": "Ada", "password": "seven green bolts"}
        assert colleague.post("/api/v1/session", json=signing_in).status_code == 200
        take_away(server)
        assert browser.put("/api/v1/mode", json={"mode": "hold"}).status_code == 204
        problem(colleague.post("/api/v1/session", json=signing_in), 503, "storage-unavailable")
        assert browser.put("/api/v1/mode", json={"mode": "hold"}).status_code == 204


def test_who_loses_the_right_or_is_signed_out_by_another_stays_out_while_the_database_is_away(server: Server) -> None:
    administrator, _ = server.session(server.person(Role.ADMINISTRATOR))
    person = server.person()
    token, _ = server.session(person)
    kept, _ = server.session(server.person())
    with (
        server.client(token=administrator) as browser,
        server.client(token=token) as other,
        server.client(token=kept) as third,
    ):
        for each in (browser, other, third):
            assert each.get("/api/v1/state").status_code == 200
        assert browser.delete(f"/api/v1/users/{person.id}/sessions").is_success
        take_away(server)
        problem(other.put("/api/v1/mode", json={"mode": "paused"}), 503, "storage-unavailable")
        assert third.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204


def test_whoever_decides_on_restarts_is_told_whether_one_helps(
    server: Server, client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the database is away none does; where the server's own connections are stuck, it does."""
    for name in ("EVERY", "PATIENCE", "SHUT_AFTER"):
        monkeypatch.setattr(metrics, name, 0.5)

    def answers(status: int, seconds: float = 20.0) -> None:
        until(lambda: client.get("/healthz").status_code == status, seconds=seconds)

    answers(200)
    with contextlib.ExitStack() as stuck:
        for _ in range(15):  # all that there are
            stuck.enter_context(server.identity.database.reading())
        answers(503)
        found = problem(client.get("/healthz"), 503, "not-alive")
        assert "Start the station again" in found["reasons"]["database"]
    answers(200)
    away = take_away(server)
    end = time.monotonic() + 3.0
    while time.monotonic() < end:
        assert client.get("/healthz").status_code == 200
        time.sleep(0.1)
    assert client.get("/readyz").status_code == 503
    away.rename(away.with_name("station.sqlite"))
