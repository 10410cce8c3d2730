"""What a program reads over REST."""

from __future__ import annotations

import httpx
import pytest

from sequence_planner.auth.roles import Role
from support.server import Controller, Server
from support.waiting import until

from .test_acting import problem

PARTS = ["resources", "operations", "abilities", "plan", "tasks", "topics", "overrides", "alarms"]


@pytest.mark.parametrize("part", PARTS)
def test_each_part_of_the_view_has_its_address(client: httpx.Client, controller: Controller, part: str) -> None:
    answer = client.get(f"/api/v1/{part}").json()
    assert answer[part] == controller.view.model_dump(mode="json")[part]
    assert answer["tick"] == 1
    assert answer["time"] > 1000


def test_the_state_is_every_variable(client: httpx.Client) -> None:
    variables = client.get("/api/v1/state").json()["variables"]
    assert variables["robot.pose"]["value"] == "home"
    assert variables["bolts[bolt_pair_1]"]["resource"] is None


def test_the_station_tells_what_runs_and_how(client: httpx.Client) -> None:
    answer = client.get("/api/v1/station").json()
    assert answer["station"]["title"] == "Bolting"
    assert (answer["mode"], answer["production"]) == ("automatic", "started")


@pytest.mark.parametrize("part", ["station", "state", *PARTS])
def test_nothing_is_told_before_the_controller_was_heard(lonely_server: Server, part: str) -> None:
    with lonely_server.client(Role.VIEWER) as client:
        answer = client.get(f"/api/v1/{part}")
    assert answer.status_code == 503
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["type"] == "/problems/controller-unavailable"


def test_old_values_are_not_told_and_return_with_the_controller(client: httpx.Client, controller: Controller) -> None:
    controller.publishing = False
    until(lambda: client.get("/api/v1/state").status_code == 503, seconds=2.5)
    lost = problem(client.get("/healthz"), 503, "not-alive")
    assert (lost["controller"], lost["reasons"].keys()) == ("lost", {"controller"})
    controller.publishing = True
    until(lambda: client.get("/api/v1/state").status_code == 200)


def test_a_new_controller_is_found_again(client: httpx.Client, controller: Controller) -> None:
    controller.stop()
    until(lambda: client.get("/api/v1/state").status_code == 503, seconds=3)
    controller.link = type(controller.link)(controller.link.path, controller.handle)
    controller.start()
    until(lambda: client.get("/api/v1/state").status_code == 200)


def test_answers_are_never_kept_by_a_browser(client: httpx.Client) -> None:
    assert client.get("/api/v1/state").headers["cache-control"] == "no-store"
