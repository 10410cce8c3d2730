"""What a person or a system asks for over REST, and how it is refused."""

from __future__ import annotations

import asyncio
import json
import threading
from typing import Any

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.command import Command
from sequence_planner.controller.commands.execution import ReleaseControl, TakeControl
from sequence_planner.controller.commands.tasks import AcknowledgeTask, ProblemKind, ReportProblem, SolveProblem
from sequence_planner.core.actor import ActorKind
from support.example_view import example_view
from support.server import Controller, Server
from support.waiting import until


def problem(answer: httpx.Response, status: int, slug: str) -> dict[str, Any]:
    """The problem that `answer` is: its parts agree, and it shows nothing of the inside."""
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    found: dict[str, Any] = answer.json()
    assert (found["status"], found["type"]) == (status, f"/problems/{slug}")
    assert found["title"]
    assert found["detail"]
    for inside in ("Traceback", "Value error", "Assertion failed", "pydantic"):
        assert inside not in answer.text
    return found


def test_each_action_is_a_command_with_its_actor(client: httpx.Client, controller: Controller) -> None:
    assert client.post("/api/v1/tasks/7/acknowledgement", json={"revision": 3}).status_code == 204
    assert client.put("/api/v1/control-lock", json={"over": None, "reason": "my shift"}).status_code == 204
    assert client.delete("/api/v1/control-lock").status_code == 204
    actor = controller.commands[0].actor
    assert controller.commands == [
        AcknowledgeTask(actor=actor, task="7", revision=3),
        TakeControl(actor=actor, over=None, reason="my shift"),
        ReleaseControl(actor=actor),
    ]
    session = client.get("/api/v1/session").json()
    assert (actor.kind, actor.address) == (ActorKind.PERSON, "127.0.0.1")
    assert (actor.session, actor.id, actor.name) == (
        session["session"],
        session["person"]["id"],
        session["person"]["name"],
    )


def test_a_refusal_comes_in_the_controllers_words(client: httpx.Client, controller: Controller) -> None:
    for task, revision in (("7", 2), ("8", 3)):
        answer = client.post(f"/api/v1/tasks/{task}/acknowledgement", json={"revision": revision})
        assert problem(answer, 409, "task-gone")["detail"] == "Look at what is asked for now."
    for path in ("problem", "problem/solved"):
        problem(client.post(f"/api/v1/tasks/7/{path}", json={"revision": 2}), 409, "task-gone")
    assert controller.commands == []


def test_a_person_says_what_is_in_the_way_of_a_task_and_that_it_is_solved(
    client: httpx.Client, controller: Controller
) -> None:
    told = {"revision": 3, "what": "missing", "reason": "the bolts are used up"}
    assert client.post("/api/v1/tasks/7/problem", json=told).status_code == 204
    assert client.post("/api/v1/tasks/7/problem", json={"revision": 3}).status_code == 204
    problem(client.post("/api/v1/tasks/7/problem", json={"revision": 3, "what": "tired"}), 422, "invalid-request")
    assert client.post("/api/v1/tasks/7/problem/solved", json={"revision": 3}).status_code == 204
    actor = controller.commands[0].actor
    assert controller.commands == [
        ReportProblem(actor=actor, task="7", revision=3, what=ProblemKind.MISSING, reason="the bolts are used up"),
        ReportProblem(actor=actor, task="7", revision=3),
        SolveProblem(actor=actor, task="7", revision=3),
    ]


def test_a_fault_of_the_controller_is_a_problem_and_it_goes_on(client: httpx.Client, controller: Controller) -> None:
    controller.show(example_view(tasks={"broken": example_view().tasks["7"]}))
    problem(client.post("/api/v1/tasks/broken/acknowledgement", json={"revision": 3}), 500, "controller-error")
    assert client.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({}, "body.mode"),
        ({"mode": "fast"}, "body.mode"),
        ({"mode": "restart"}, "body.mode"),
        ({"mode": None}, "body.mode"),
        ({"mode": "paused", "force": True}, "body.force"),
        ({"mode": "paused", "\ud800": 1}, "body"),
        ([], "body"),
    ],
)
def test_a_wrong_body_is_told_where_it_is_wrong(
    client: httpx.Client, controller: Controller, body: object, field: str
) -> None:
    text = json.dumps(body)  # in ASCII, so that it can say what UTF-8 cannot
    answer = client.put("/api/v1/mode", content=text, headers={"Content-Type": "application/json"})
    found = problem(answer, 422, "invalid-request")
    assert found["errors"][0]["field"] == field
    assert found["errors"][0]["expected"]
    assert controller.commands == []


@pytest.mark.parametrize("revision", ["3", 3.5, True, -1, 2**53, None])
def test_a_revision_is_a_whole_number(client: httpx.Client, revision: object) -> None:
    answer = client.post("/api/v1/tasks/7/acknowledgement", json={"revision": revision})
    assert problem(answer, 422, "invalid-request")["errors"][0]["field"] == "body.revision"


def test_what_was_expected_is_named(client: httpx.Client) -> None:
    found = problem(client.put("/api/v1/mode", json={"mode": "fast"}), 422, "invalid-request")
    assert "`automatic`, `paused` or `hold`" in found["errors"][0]["expected"]


@pytest.mark.parametrize("body", [b"", b"{", b"nonsense", b'{"mode": "paused"', b"[" * 20_000, b'{"mode": "\xff"}'])
def test_what_is_not_json_is_refused(client: httpx.Client, controller: Controller, body: bytes) -> None:
    answer = client.put("/api/v1/mode", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code in (400, 422)
    assert answer.headers["content-type"] == "application/problem+json"
    assert controller.commands == []


def test_an_unknown_address_is_a_problem(client: httpx.Client) -> None:
    problem(client.get("/api/v1/nothing"), 404, "not-found")
    problem(client.post("/api/v1/nothing", json={}), 404, "not-found")
    problem(client.get("/api/v2/station"), 404, "not-found")


def test_a_method_that_an_address_does_not_know_is_a_problem_that_names_those_it_knows(client: httpx.Client) -> None:
    answer = client.post("/api/v1/station", json={})
    problem(answer, 405, "method-not-allowed")
    assert answer.headers["allow"] == "GET"
    answer = client.get("/api/v1/mode")
    problem(answer, 405, "method-not-allowed")
    assert answer.headers["allow"] == "PUT"


def test_without_a_controller_a_command_is_refused_at_once(lonely_server: Server) -> None:
    with lonely_server.client(Role.OPERATOR) as client:
        answer = client.put("/api/v1/mode", json={"mode": "paused"})
    problem(answer, 503, "controller-unavailable")


def test_a_controller_that_dies_over_a_command_leaves_its_outcome_open(
    server: Server, client: httpx.Client, controller: Controller
) -> None:
    begun = threading.Event()

    async def never(command: Command) -> None:
        begun.set()
        await asyncio.sleep(60)

    controller.link._handle = never
    answers: list[httpx.Response] = []
    asking = threading.Thread(target=lambda: answers.append(client.put("/api/v1/mode", json={"mode": "paused"})))
    asking.start()
    assert begun.wait(5)
    controller.stop()
    asking.join(5)
    assert "not known" in problem(answers[0], 504, "controller-timeout")["detail"]
    controller.link = type(controller.link)(controller.link.path, controller.handle)
    controller.start()
    until(lambda: client.put("/api/v1/mode", json={"mode": "paused"}).status_code == 204)
