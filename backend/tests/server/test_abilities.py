"""How an ability is defined, and a trial of it, over REST."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.queries import AskDefinition
from sequence_planner.controller.commands.recovery import TryAbility
from sequence_planner.controller.ipc import CarriedOut
from sequence_planner.server.settings import Settings
from support.server import Loop

from .example_answers import DEFINITION
from .test_acting import problem
from .test_operator_plans import Asked, engineer

__all__ = ["engineer"]


class Trying(Asked):
    """A controller that may refuse what it is told, too."""

    refused: CommandRefused | None = None

    async def handle(self, command: Command) -> CarriedOut | None:
        if self.refused is not None:
            raise self.refused
        return await super().handle(command)


@pytest.fixture
def controller(loop: Loop, settings: Settings) -> Iterator[Trying]:
    controller = Trying(loop, settings)
    controller.start()
    yield controller
    controller.stop()


def test_a_definition_is_told_by_the_name_of_the_ability(engineer: httpx.Client, controller: Trying) -> None:
    answer = engineer.get("abilities/robot.move/definition").json()
    assert answer == DEFINITION.model_dump(mode="json")
    problem(engineer.get("abilities/robot.move%28home%29/definition"), 404, "unknown-ability")
    assert controller.asked == [AskDefinition(ability="robot.move"), AskDefinition(ability="robot.move(home)")]


def test_a_trial_is_a_command_of_who_has_control(engineer: httpx.Client, controller: Trying) -> None:
    body = {"ability": "robot.move", "real_devices": True, "reason": "to see it"}
    assert engineer.post("test-runs", json=body).status_code == 204
    assert engineer.post("test-runs", json={"ability": "robot.move"}).status_code == 204
    first, second = controller.commands
    assert isinstance(first, TryAbility)
    assert isinstance(second, TryAbility)
    assert first.needs_control
    assert (first.ability, first.real_devices, first.reason) == ("robot.move", True, "to see it")
    assert (second.real_devices, second.reason, second.subject) == (False, None, "robot.move")
    wrongs: tuple[dict[str, object], ...] = ({"ability": ""}, {"ability": 3}, {"real_devices": "si"}, {"starts": []})
    for wrong in wrongs:
        problem(engineer.post("test-runs", json={**body, **wrong}), 422, "invalid-request")


@pytest.mark.parametrize(("slug", "status"), [("not-startable", 409), ("real-devices", 409), ("unknown-ability", 404)])
def test_what_the_controller_refuses_is_said_in_its_words(
    engineer: httpx.Client, controller: Trying, slug: str, status: int
) -> None:
    controller.refused = CommandRefused(slug, "It waits for robot.pose == home.", status)
    found = problem(engineer.post("test-runs", json={"ability": "robot.move"}), status, slug)
    assert found["detail"] == "It waits for robot.pose == home."
