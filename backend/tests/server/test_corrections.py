"""Corrections and decisions over REST: each request is one command or one question, or told what is wrong."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.queries import AskCorrection
from sequence_planner.controller.commands.recovery import (
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    UndoCorrection,
)
from sequence_planner.server.settings import Settings
from support.server import Loop, Server

from .example_answers import CORRECTION
from .test_acting import problem
from .test_operator_plans import Asked

WHY = "seen with my own eyes"
VALUES: dict[str, bool | int | str] = {"bolts[left]": "placed", "count": 1, "ready": True}


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Asked]:
    controller = Asked(loop, settings)
    controller.start()
    yield controller
    controller.stop()


@pytest.fixture
def operator(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.OPERATOR) as client:
        client.base_url = httpx.URL(f"{server.address}/api/v1/")
        yield client


@pytest.mark.parametrize(
    ("method", "path", "body", "command"),
    [
        (
            "POST",
            "corrections",
            {"values": VALUES, "revision": 7, "reason": WHY},
            CorrectEstimates.model_construct(values=VALUES, revision=7, reason=WHY),
        ),
        (
            "POST",
            "corrections/undo",
            {"revision": 3, "reason": WHY},
            UndoCorrection.model_construct(revision=3, reason=WHY),
        ),
        (
            "POST",
            "corrections/confirm",
            {"values": VALUES, "reason": WHY},
            ConfirmEstimates.model_construct(values=VALUES, reason=WHY),
        ),
        (
            "PUT",
            "restored-outputs",
            {"values": VALUES, "reason": WHY},
            DecideOutputs.model_construct(values=VALUES, reason=WHY),
        ),
    ],
)
def test_each_request_is_a_command(
    operator: httpx.Client, controller: Asked, method: str, path: str, body: object, command: Command
) -> None:
    assert operator.request(method, path, json=body).status_code == 204
    [given] = controller.commands
    assert type(given) is type(command)
    assert given.model_dump(exclude={"actor"}) == command.model_dump(exclude={"actor"})
    values = getattr(given, "values", {})
    assert [type(value) for value in values.values()] == [type(VALUES[name]) for name in values]  # true is not 1


def test_a_preview_is_asked_for_and_commands_nothing(operator: httpx.Client, controller: Asked) -> None:
    answer = operator.post("corrections/preview", json={"values": VALUES})
    assert answer.status_code == 200
    assert answer.json() == CORRECTION.model_dump(mode="json")
    assert controller.asked == [AskCorrection(values=VALUES)]
    assert controller.commands == []


@pytest.mark.parametrize(
    ("status", "slug"),
    [(404, "unknown-variable"), (422, "not-in-domain"), (422, "not-estimated"), (504, "advisor-timeout")],
)
def test_a_refused_preview_is_a_problem(operator: httpx.Client, controller: Asked, status: int, slug: str) -> None:
    controller.refusal = CommandRefused(slug, "Because.", status)
    problem(operator.post("corrections/preview", json={"values": VALUES}), status, slug)


@pytest.mark.parametrize(
    ("method", "path", "body", "field"),
    [
        ("POST", "corrections", {"values": VALUES, "reason": WHY}, "body.revision"),
        ("POST", "corrections", {"values": VALUES, "revision": -1, "reason": WHY}, "body.revision"),
        ("POST", "corrections", {"values": VALUES, "revision": 7}, "body.reason"),
        ("POST", "corrections", {"values": VALUES, "revision": 7, "reason": ""}, "body.reason"),
        ("POST", "corrections", {"values": {}, "revision": 7, "reason": WHY}, "body.values"),
        ("POST", "corrections/preview", {}, "body.values"),
        ("POST", "corrections/undo", {"revision": 7}, "body.reason"),
        ("POST", "corrections/undo", {"reason": WHY}, "body.revision"),
        ("POST", "corrections/confirm", {"values": VALUES}, "body.reason"),
        ("PUT", "restored-outputs", {"values": VALUES}, "body.reason"),
    ],
)
def test_what_is_wrong_with_a_request(
    operator: httpx.Client, controller: Asked, method: str, path: str, body: object, field: str
) -> None:
    found = problem(operator.request(method, path, json=body), 422, "invalid-request")
    assert field in [error["field"] for error in found["errors"]]
    assert controller.commands == []
    assert controller.asked == []
