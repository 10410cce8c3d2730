"""Advice, goals by hand, resets and why not over REST: what is asked of the controller, and what is answered."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from sequence_planner.auth.roles import Role
from sequence_planner.controller.commands.command import CommandRefused, Query, TextPlace
from sequence_planner.controller.commands.queries import (
    AboutWorkMasters,
    AskAbilityBlockers,
    AskAdvice,
    AskGoal,
    AskGoalBlockers,
    AskOperationBlockers,
    AskOperationDefinition,
    AskReset,
    AskTrace,
)
from sequence_planner.controller.commands.recovery import ExecuteOperatorPlan, StopOperatorPlan
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.core.data_models import DataModel
from sequence_planner.server.settings import Settings
from sequence_planner.texts.message import message
from support.server import Controller, Loop, Server

from .example_answers import ADVICE, OFFER, TRACE, example_answer
from .test_acting import problem


class Asked(Controller):
    """A controller that remembers what it was asked by somebody; the server asks about work masters by itself."""

    def __init__(self, loop: Loop, settings: Settings) -> None:
        super().__init__(loop, settings.controller_socket)
        self.asked: list[Query[Any]] = []
        self.refusal: CommandRefused | None = None
        self.link = ControllerLink(settings.controller_socket, self.handle, self.answer)

    async def answer(self, ask: Query[Any]) -> DataModel:
        if not isinstance(ask, AboutWorkMasters):
            self.asked.append(ask)
        if self.refusal is not None:
            raise self.refusal
        return example_answer(ask)


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Asked]:
    controller = Asked(loop, settings)
    controller.start()
    yield controller
    controller.stop()


@pytest.fixture
def engineer(server: Server) -> Iterator[httpx.Client]:
    with server.client(Role.ENGINEER) as client:
        client.base_url = httpx.URL(f"{server.address}/api/v1/")
        yield client


def test_each_question_is_asked_as_it_is_and_answered_with_its_document(
    engineer: httpx.Client, controller: Asked
) -> None:
    assert engineer.get("recovery/proposals").json() == ADVICE.model_dump(mode="json")
    goal = {"predicate": "robot.pose == home"}
    assert engineer.post("operator-plans/goal-preview", json=goal).json() == OFFER.model_dump(mode="json")
    assert engineer.post("operator-plans/reset-preview", json={"operation": "tighten(1)"}).json()["id"] == OFFER.id
    ability = engineer.get("abilities/robot.move/blockers").json()
    (condition,) = ability["conditions"]
    assert condition["involved"][0]["wanted"] == ["home"]
    problem(engineer.get("operations/carry%28left%29/blockers"), 404, "unknown-operation")
    assert engineer.get("operations/tighten/definition").json()["turns"]["in_order"]["text"] == "pose == home"
    problem(engineer.get("operations/carry/definition"), 404, "unknown-operation")
    assert engineer.get("variables/robot.pose/trace").json() == TRACE.model_dump(mode="json")
    problem(engineer.get("variables/robot.goal/trace"), 404, "unknown-variable")
    assert engineer.post("goals/blockers", json=goal).json()["plan"]["steps"][0]["ability"] == "robot.move"
    assert controller.asked == [
        AskAdvice(),
        AskGoal(predicate="robot.pose == home"),
        AskReset(operation="tighten(1)"),
        AskAbilityBlockers(name="robot.move"),
        AskOperationBlockers(name="carry(left)"),
        AskOperationDefinition(name="tighten"),
        AskOperationDefinition(name="carry"),
        AskTrace(name="robot.pose"),
        AskTrace(name="robot.goal"),
        AskGoalBlockers(predicate="robot.pose == home"),
    ]


def test_an_offer_is_taken_with_all_that_was_confirmed(engineer: httpx.Client, controller: Asked) -> None:
    body = {
        "offer": "81a0a8-1",
        "starts": ["robot.move"],
        "corrections": {"bolts": "placed", "on": True, "count": 3},
        "reason": "the bolt is out",
    }
    assert engineer.post("operator-plans", json=body).status_code == 204
    assert engineer.post("operator-plans/stop", json={}).status_code == 204
    taken, stopped = controller.commands
    assert isinstance(taken, ExecuteOperatorPlan)
    assert taken.needs_control
    assert (taken.offer, taken.starts, taken.reason) == ("81a0a8-1", ["robot.move"], "the bolt is out")
    assert taken.corrections == {"bolts": "placed", "on": True, "count": 3}
    assert taken.corrections["on"] is True
    assert isinstance(stopped, StopOperatorPlan)
    assert not stopped.needs_control
    for wrong in ({"reason": ""}, {"reason": None}, {"starts": "robot.move"}, {"corrections": {"bolts": 1.5}}):
        problem(engineer.post("operator-plans", json={**body, **wrong}), 422, "invalid-request")
    problem(engineer.post("operator-plans", json={"offer": "81a0a8-1", "reason": "no starts"}), 422, "invalid-request")
    assert len(controller.commands) == 2


def test_refusals_come_in_the_controllers_words(engineer: httpx.Client, controller: Asked) -> None:
    controller.refusal = CommandRefused("advisor-timeout", "Try again.", 504)
    late = problem(engineer.get("recovery/proposals"), 504, "advisor-timeout")
    assert (late["detail"], late["place"]) == ("Try again.", None)
    assert late["title_message"] == {"id": "refused.advisor-timeout", "arguments": {}}
    assert late["detail_message"] == {"id": "as-it-was", "arguments": {"text": "Try again."}}
    why = message("refused.plan-running.title", title=message("offer.try", ability="Move"))
    controller.refusal = CommandRefused("plan-running", why)
    running = problem(engineer.get("recovery/proposals"), 409, "plan-running")
    assert running["detail"] == "Try: Move is being carried out. Wait for its end, or stop it."
    assert running["detail_message"] == why.sent()
    detail = "character 1, `up`: unknown name `up`"
    place = TextPlace(start=0, end=2, message="unknown name `up`")
    controller.refusal = CommandRefused("bad-predicate", detail, 422, place=place)
    for path in ("operator-plans/goal-preview", "goals/blockers"):
        found = problem(engineer.post(path, json={"predicate": "up"}), 422, "bad-predicate")
        assert (found["detail"], found["place"]) == (detail, place.model_dump())
