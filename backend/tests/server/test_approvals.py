"""Requests for a second person over REST: each is one command, or told what is wrong."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.approvals import (
    Act,
    ApproveRequest,
    CorrectionAct,
    DeclineRequest,
    ForceAct,
    OutputsAct,
    RequestApproval,
)
from sequence_planner.controller.commands.command import Command
from support.server import Controller, Server

from .test_acting import problem

WHY = "seen with my own eyes"
CORRECTS = CorrectionAct(values={"bolts[left]": "placed", "count": 1, "ready": True})
DECIDES = OutputsAct(values={"robot.go": False})
FORCES = ForceAct(name="robot.on", value=True, seconds=60)


@pytest.fixture
def engineer(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.base_url = httpx.URL(f"{server.address}/api/v1/approvals/")
        yield client


@pytest.mark.parametrize(
    ("path", "act"), [("corrections", CORRECTS), ("restored-outputs", DECIDES), ("forces", FORCES)]
)
def test_a_request_is_one_command(engineer: httpx.Client, controller: Controller, path: str, act: Act) -> None:
    body = {"act": act.model_dump(), "revision": 7, "reason": WHY}
    assert engineer.post(path, json=body).status_code == 204
    expected = RequestApproval.model_construct(act=act, revision=7, reason=WHY)
    assert given(controller) == expected.model_dump(exclude={"actor"})
    for other in {"corrections", "restored-outputs", "forces"} - {path}:
        problem(engineer.post(other, json=body), 422, "invalid-request")
    for wrong in ({"revision": -1}, {"revision": 1.0}, {"reason": ""}, {"reason": None}, {"act": None}):
        problem(engineer.post(path, json=body | wrong), 422, "invalid-request")
    assert len(controller.commands) == 1


@pytest.mark.parametrize("act", [CORRECTS, DECIDES, FORCES], ids=lambda act: act.kind)
def test_an_answer_is_one_command(client: httpx.Client, controller: Controller, act: Act) -> None:
    body = {"act": act.model_dump(), "revision": 7}
    assert client.post("/api/v1/approvals/a-1/approve", json=body).status_code == 204
    approval = ApproveRequest.model_construct(request="a-1", act=act, revision=7, reason=None)
    assert given(controller) == approval.model_dump(exclude={"actor"})
    declined = {"act": act.model_dump(), "reason": "it is empty"}
    assert client.post("/api/v1/approvals/a-1/decline", json=declined).status_code == 204
    refusal = DeclineRequest.model_construct(request="a-1", act=act, reason="it is empty")
    assert given(controller) == refusal.model_dump(exclude={"actor"})
    problem(client.post(f"/api/v1/approvals/{'x' * 41}/approve", json=body), 422, "invalid-request")


def test_who_forces_nothing_asks_for_no_force_and_may_approve_one(client: httpx.Client, controller: Controller) -> None:
    body = {"act": FORCES.model_dump(), "revision": 7, "reason": WHY}
    problem(client.post("/api/v1/approvals/forces", json=body), 403, "role-too-low")
    assert controller.commands == []
    del body["reason"]
    assert client.post("/api/v1/approvals/a-1/approve", json=body).status_code == 204


def test_what_waits_is_told(client: httpx.Client) -> None:
    [(id_, waits)] = client.get("/api/v1/station").json()["approvals"].items()
    assert (id_, waits["by"], waits["state"]) == ("a-1", "Eva", "waiting")
    assert waits["act"] == {"kind": "correction", "values": {"bolts[bolt_pair_1]": "placed"}}


def given(controller: Controller) -> dict[str, object]:
    """The last command, but for who gave it."""
    last: Command = controller.commands[-1]
    return last.model_dump(exclude={"actor"})
