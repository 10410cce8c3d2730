"""Modes, production, steps, service and forces over REST: each request is one command, or told what is wrong."""

from __future__ import annotations

from urllib.parse import quote

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.approvals import ForceVariable, ReleaseForce
from sequence_planner.controller.commands.command import Command
from sequence_planner.controller.commands.execution import (
    EnterRestart,
    LeaveRestart,
    RemoveBreakpoint,
    SetBreakpoint,
    SetCycleStop,
    SetMode,
    SetService,
    SetStepping,
    StartProduction,
    TakeStep,
)
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from support.server import Controller, Server

from .test_acting import problem

WHY = "the tool sticks"
MOVE = "robot.move_to_position(home)"


@pytest.mark.parametrize(
    ("method", "path", "body", "command"),
    [
        (
            "PUT",
            "/mode",
            {"mode": "automatic", "reason": WHY},
            SetMode.model_construct(mode=Mode.AUTOMATIC, reason=WHY),
        ),
        ("PUT", "/mode", {"mode": "paused"}, SetMode.model_construct(mode=Mode.PAUSED)),
        ("PUT", "/mode", {"mode": "hold"}, SetMode.model_construct(mode=Mode.HOLD)),
        ("POST", "/production/start", {}, StartProduction.model_construct()),
        ("POST", "/restart/enter", {"reason": WHY}, EnterRestart.model_construct(reason=WHY)),
        ("POST", "/restart/leave", {"reason": WHY}, LeaveRestart.model_construct(reason=WHY)),
        ("PUT", "/mode/cycle-stop", {"on": True}, SetCycleStop.model_construct(on=True)),
        ("DELETE", "/breakpoints/7", None, RemoveBreakpoint.model_construct(id="7")),
        ("PUT", "/stepping", {"on": True}, SetStepping.model_construct(on=True)),
        ("POST", "/stepping/step", {}, TakeStep.model_construct()),
        (
            "PUT",
            f"/availability/ability/{quote(MOVE)}",
            {"in_service": False, "reason": WHY},
            SetService.model_construct(of=ServiceKind.ABILITY, name=MOVE, in_service=False, reason=WHY),
        ),
        (
            "PUT",
            "/availability/resource/robot",
            {"in_service": True, "reason": WHY},
            SetService.model_construct(of=ServiceKind.RESOURCE, name="robot", in_service=True, reason=WHY),
        ),
        (
            "PUT",
            "/forces/robot.speed",
            {"value": 3, "seconds": 60, "reason": WHY},
            ForceVariable.model_construct(name="robot.speed", value=3, seconds=60.0, reason=WHY),
        ),
        (
            "PUT",
            "/forces/robot.on",
            {"value": True, "seconds": 0.5, "reason": WHY},
            ForceVariable.model_construct(name="robot.on", value=True, seconds=0.5, reason=WHY),
        ),
        ("DELETE", "/forces/robot.on", None, ReleaseForce.model_construct(name="robot.on")),
    ],
)
def test_each_request_is_a_command(
    server: Server, controller: Controller, method: str, path: str, body: object, command: Command
) -> None:
    with server.client(Role.ENGINEER) as client:
        answer = (
            client.request(method, f"/api/v1{path}", json=body) if body is not None else client.delete(f"/api/v1{path}")
        )
        assert answer.status_code == 204
    [given] = controller.commands
    assert given.actor.session
    assert type(given) is type(command)
    assert given.model_dump(exclude={"actor"}) == {"reason": None, **command.model_dump(exclude={"actor"})}
    value = getattr(given, "value", None)
    assert type(value) is type(getattr(command, "value", None))  # true is not 1


def test_a_breakpoint_that_is_set_is_answered_with_its_id(server: Server, controller: Controller) -> None:
    shown = controller.view.breakpoints["1"]
    with server.client(Role.ENGINEER) as client:
        answer = client.post("/api/v1/breakpoints", json={"condition": "robot.on"})
    assert answer.status_code == 201
    assert answer.json() == {"id": "7", **shown.model_dump(mode="json")}
    [given] = controller.commands
    assert isinstance(given, SetBreakpoint)
    assert given.condition == "robot.on"


@pytest.mark.parametrize(
    ("method", "path", "body", "field"),
    [
        ("PUT", "/mode", {"mode": "restart"}, "body.mode"),  # it has a way in of its own
        ("PUT", "/stepping", {}, "body.on"),
        ("PUT", "/availability/topic/robot", {"in_service": False, "reason": WHY}, "path.kind"),
        ("PUT", "/availability/resource/robot", {"in_service": False}, "body.reason"),
        ("PUT", "/availability/resource/robot", {"in_service": False, "reason": ""}, "body.reason"),
        ("PUT", "/forces/robot.on", {"value": True, "seconds": 60}, "body.reason"),
        ("PUT", "/forces/robot.on", {"value": True, "seconds": 0, "reason": WHY}, "body.seconds"),
        ("PUT", "/forces/robot.on", {"value": True, "seconds": 3601, "reason": WHY}, "body.seconds"),
        ("PUT", "/forces/robot.on", {"value": True, "reason": WHY}, "body.seconds"),
    ],
)
def test_what_is_wrong_with_a_request(
    server: Server, controller: Controller, method: str, path: str, body: object, field: str
) -> None:
    with server.client(Role.ENGINEER) as client:
        found = problem(client.request(method, f"/api/v1{path}", json=body), 422, "invalid-request")
    assert field in [error["field"] for error in found["errors"]]
    assert controller.commands == []


@pytest.mark.parametrize("value", [1.5, None, ["home"]])
def test_a_force_is_a_value_of_the_model(server: Server, controller: Controller, value: object) -> None:
    body = {"value": value, "seconds": 60, "reason": WHY}
    with server.client(Role.ENGINEER) as client:
        problem(client.put("/api/v1/forces/robot.on", json=body), 422, "invalid-request")
    assert controller.commands == []


def test_the_station_tells_what_people_have_asked_of_it(client: httpx.Client, controller: Controller) -> None:
    answer = client.get("/api/v1/station").json()
    view = controller.view
    for name in ("revision", "mode", "packml", "stepping", "production", "unconfirmed", "control", "errand"):
        assert answer[name] == getattr(view, name), name
    assert set(answer["forces"]) == set(view.forces)
    assert len(answer["out_of_service"]) == len(view.out_of_service)
