"""The demonstration, which is for emulated devices at this machine alone; and the first administrator."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

import httpx
import pytest

from sequence_planner.auth import first_start
from sequence_planner.core.actor import ActorKind
from sequence_planner.server.http.credentials import session_cookie
from sequence_planner.server.settings import Settings
from support.example_view import example_view
from support.network import free_port
from support.server import Controller, Loop, Server
from support.waiting import until

from .test_acting import problem

PASSWORD = "seven green bolts"


@pytest.fixture
def shown(loop: Loop, settings: Settings, controller: Controller) -> Iterator[Server]:
    """A server at which a demonstration may be opened."""
    server = Server(loop, replace(settings, demonstration=True))
    server.start()
    server.hear_controller()
    yield server
    server.stop()


def opened(browser: httpx.Client) -> httpx.Response:
    return browser.post("/api/v1/session/demonstration", json={})


def show_devices(server: Server, controller: Controller, *, emulated: bool) -> None:
    """Let the server hear whether the devices are emulated."""
    station = example_view().station.model_copy(update={"emulated": emulated})
    controller.show(example_view(station=station))
    until(lambda: server.app.state.controller.view.station.emulated == emulated)


def test_a_demonstration_acts_and_says_what_it_is(shown: Server, controller: Controller) -> None:
    with shown.client() as browser:
        assert browser.get("/api/v1/session").json()["demonstration"] is True
        told = opened(browser).json()
        assert (told["state"], told["kind"], told["person"]["name"]) == ("signed-in", "demonstration", "Demonstration")
        assert browser.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204
        assert controller.commands[0].actor.kind is ActorKind.DEMONSTRATION
        problem(browser.get("/api/v1/users"), 403, "role-too-low")
        change = {"old": PASSWORD, "new": PASSWORD}
        problem(browser.put("/api/v1/session/password", json=change), 403, "no-password")
        assert browser.delete("/api/v1/session").status_code == 204


def test_who_is_not_signed_in_is_told_the_title_of_the_station_and_nothing_else_of_it(shown: Server) -> None:
    with shown.client() as browser:
        answer = browser.get("/api/v1/session").json()
        assert answer["station"] == {"en": "Bolting", "sv": "Skruvning"}
        assert not {"view", "description", "name"} & answer.keys()
        assert [answer[each] for each in ("person", "session", "version")] == [None, None, None]


def test_where_the_station_was_never_heard_its_title_is_not_known(loop: Loop, settings: Settings) -> None:
    server = Server(loop, settings)
    server.start()
    try:
        with server.client() as browser:
            assert browser.get("/api/v1/session").json()["station"] is None
    finally:
        server.stop()


def test_there_is_no_demonstration_where_none_was_asked_for(client: httpx.Client) -> None:
    assert client.get("/api/v1/session").json()["demonstration"] is False
    problem(opened(client), 403, "no-demonstration")


def test_real_devices_end_a_demonstration(shown: Server, controller: Controller) -> None:
    with shown.client() as browser, shown.client() as late:
        opened(browser)
        show_devices(shown, controller, emulated=False)
        problem(browser.get("/api/v1/station"), 401, "signed-out")
        problem(opened(late), 403, "no-demonstration")
        show_devices(shown, controller, emulated=True)
        assert opened(late).status_code == 200


def test_a_silent_controller_opens_no_demonstration(shown: Server, controller: Controller) -> None:
    controller.publishing = False
    with shown.client() as browser:
        until(lambda: opened(browser).status_code == 403, seconds=4)


@pytest.mark.parametrize("header", ["Forwarded", "X-Forwarded-For", "X-Real-IP"])
def test_who_comes_through_somebody_else_gets_no_demonstration(shown: Server, header: str) -> None:
    with shown.client() as browser:
        opened(browser)
        headers = {header: "192.0.2.1"}
        problem(browser.get("/api/v1/station", headers=headers), 401, "signed-out")
        browser.cookies.clear()
        answer = browser.post("/api/v1/session/demonstration", json={}, headers=headers)
        problem(answer, 403, "no-demonstration")


def test_a_server_without_demonstration_does_not_know_sessions_of_one(
    loop: Loop, settings: Settings, controller: Controller, shown: Server
) -> None:
    plain = Server(loop, replace(settings, port=free_port()))
    plain.start()
    with shown.client() as browser, plain.client() as same:
        opened(browser)
        token = browser.cookies[session_cookie(shown.settings)]
        same.headers.update(plain.cookie(token))
        problem(same.get("/api/v1/station"), 401, "signed-out")
    plain.stop()


def test_the_first_administrator_comes_by_a_link_that_works_once(server: Server) -> None:
    with server.identity.database.writing() as connection:
        token = first_start.new_link_token(connection, time.time())
    body = {"token": token, "name": "Ada", "password": PASSWORD}
    with server.client() as browser, server.client() as late:
        assert browser.get("/api/v1/session").json()["state"] == "first-start"
        problem(browser.post("/api/v1/setup", json=body | {"token": "x" * 43}), 403, "setup-link-invalid")
        problem(browser.post("/api/v1/setup", json=body | {"password": "short"}), 422, "weak-password")
        answer = browser.post("/api/v1/setup", json=body)
        assert answer.status_code == 201
        assert answer.json()["person"]["role"] == "administrator"
        assert browser.get("/api/v1/users").status_code == 200
        problem(late.post("/api/v1/setup", json=body | {"name": "Eve"}), 403, "setup-link-invalid")
        assert late.get("/api/v1/session").json()["state"] == "signed-out"
