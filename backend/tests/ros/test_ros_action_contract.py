"""The contract of actions on every transport."""

from __future__ import annotations

import asyncio
import importlib.util
from collections.abc import Mapping

import pytest
from ros_networks import Network, play, standard
from structlog.testing import capture_logs

from sequence_planner.ros.actions import (
    ActionClient,
    ActionServer,
    Execute,
    GoalOutcome,
    GoalRejectedError,
    GoalStatus,
    GoalWork,
    LostGoalError,
    cancelled,
)
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NoServerError, Transport
from sequence_planner.ros.types.errors import MessageValueError
from sequence_planner.ros.types.standard_types import GOAL_STATUSES
from support.waiting import until_async

NO_RCLPY = pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None,
    reason="rclpy is not importable here: run this suite where ROS 2 Jazzy is installed",
)
KINDS = ["memory", "cyclonedds", pytest.param("rclpy", marks=NO_RCLPY)]

FIBONACCI = "example_interfaces/action/Fibonacci"


async def count(work: GoalWork) -> GoalOutcome:
    """Make one number of the sequence after another, until it is cancelled."""
    order, sequence = work.goal["order"], [0, 1]
    assert isinstance(order, int)
    while len(sequence) < order:
        work.feedback({"sequence": sequence})
        if await cancelled(work.cancel_wanted, 0.01):
            return GoalOutcome(GoalStatus.CANCELED, {"sequence": sequence})
        sequence = [*sequence, sequence[-1] + sequence[-2]] if len(sequence) < 40 else [*sequence, 0]
    return GoalOutcome(GoalStatus.SUCCEEDED, {"sequence": sequence})


def server_on(transport: Transport, execute: Execute = count) -> ActionServer:
    def accepts(goal: Mapping[str, object]) -> bool:
        return goal["order"] != 13

    return ActionServer(transport, standard(), "/fibonacci", FIBONACCI, execute, accepts)


def client_on(transport: Transport) -> ActionClient:
    return ActionClient(transport, standard(), "/fibonacci", FIBONACCI)


@pytest.mark.parametrize("kind", KINDS)
def test_a_goal_gives_feedback_status_and_result(kind: str) -> None:
    async def scenario(network: Network) -> None:
        client = client_on(network.join("station"))
        server = server_on(network.join("device"))
        told: list[object] = []
        # The first goals may be under way before the topics have met.
        while not told:
            first = await client.send_goal({"order": 10}, 10.0, lambda values: told.append(values["sequence"]))
            assert (await first.result()).status == GoalStatus.SUCCEEDED
        told.clear()
        goal = await client.send_goal({"order": 7}, 10.0, lambda values: told.append(values["sequence"]))
        await until_async(lambda: goal.status == GoalStatus.EXECUTING, "the status is told")
        assert await goal.result() == GoalOutcome(GoalStatus.SUCCEEDED, {"sequence": [0, 1, 1, 2, 3, 5, 8]})
        assert told == [[0, 1], [0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3], [0, 1, 1, 2, 3, 5]]
        server.close()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_goals_side_by_side_are_told_apart(kind: str) -> None:
    async def scenario(network: Network) -> None:
        client, other = client_on(network.join("station")), client_on(network.join("other"))
        server = server_on(network.join("device"))
        goals = [await each.send_goal({"order": order}, 10.0) for order in (3, 5, 8) for each in (client, other)]
        outcomes = await asyncio.gather(*(goal.result() for goal in goals))
        lengths = [len(sequence) for outcome in outcomes if isinstance(sequence := outcome.result["sequence"], list)]
        assert lengths == [3, 3, 5, 5, 8, 8]
        server.close()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_goal_can_be_cancelled(kind: str) -> None:
    async def scenario(network: Network) -> None:
        client = client_on(network.join("station"))
        server = server_on(network.join("device"))
        goal = await client.send_goal({"order": 100_000}, 10.0)
        ending = asyncio.ensure_future(goal.result(renewal=0.1))  # asks again and again meanwhile
        await asyncio.sleep(0.35)
        await goal.cancel(10.0)
        assert (await ending).status == GoalStatus.CANCELED
        with pytest.raises(GoalRejectedError, match="ERROR_GOAL_TERMINATED"):
            await goal.cancel(10.0)
        server.close()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_what_goes_wrong_is_told(kind: str) -> None:
    async def fail(work: GoalWork) -> GoalOutcome:
        raise RuntimeError("the arm is blocked")

    async def scenario(network: Network) -> None:
        client = client_on(network.join("station"))
        with pytest.raises(NoServerError, match="nobody serves /fibonacci/_action/send_goal"):
            await client.send_goal({"order": 3}, 0.1)
        server = server_on(network.join("device"), fail)
        with pytest.raises(GoalRejectedError, match="/fibonacci does not accept the goal"):
            await client.send_goal({"order": 13}, 10.0)
        with pytest.raises(MessageValueError, match=r"goal\.order: expected int32"):
            await client.send_goal({"order": "many"}, 10.0)
        with capture_logs() as logs:
            goal = await client.send_goal({"order": 3}, 10.0)
            assert await goal.result() == GoalOutcome(GoalStatus.ABORTED, {"sequence": []})
        assert "a goal could not be carried out" in [log["event"] for log in logs]
        server.close()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_server_that_goes_or_forgets_is_noticed(kind: str) -> None:
    async def scenario(network: Network) -> None:
        client, device = client_on(network.join("station")), network.join("device")
        server = server_on(device)
        goals = [await client.send_goal({"order": 100_000}, 10.0) for _ in range(2)]
        ending = asyncio.ensure_future(goals[0].result(renewal=0.2))
        await asyncio.sleep(0)
        server.close()
        device.close()
        with pytest.raises(LostGoalError, match="has lost its server"):
            await ending
        server = server_on(network.join("device"))
        with pytest.raises(LostGoalError, match="has been started anew"):
            await goals[1].result(renewal=5.0)
        server.close()

    play(kind, scenario)


def test_nonsense_about_goals_is_counted_and_harms_nobody() -> None:
    """DDS lets none through to here, for it checks what it carries; a transport need not."""

    async def scenario(network: Network) -> None:
        client, vandal = client_on(network.join("station")), network.join("vandal")
        server = server_on(network.join("device"))
        feedback, status = "/fibonacci/_action/feedback", "/fibonacci/_action/status"
        vandal.advertise(feedback, f"{FIBONACCI}_FeedbackMessage", QualityOfService.RELIABLE)
        vandal.advertise(status, GOAL_STATUSES, QualityOfService.LATCHED)
        vandal.publish(feedback, f"{FIBONACCI}_FeedbackMessage", b"\0\1\0\0" + b"\xff" * 40)
        vandal.publish(status, GOAL_STATUSES, b"\0\1\0\0" + b"\xff" * 4)
        await until_async(lambda: client.malformed == 2, "the nonsense is counted")
        goal = await client.send_goal({"order": 3}, 10.0)
        told = {"goal_info": {"goal_id": {"uuid": list(goal.id)}}, "status": 77}
        vandal.publish(status, GOAL_STATUSES, standard().encode(GOAL_STATUSES, {"status_list": [told]}))
        assert await goal.result() == GoalOutcome(GoalStatus.SUCCEEDED, {"sequence": [0, 1, 1]})
        server.close()

    play("memory", scenario)
