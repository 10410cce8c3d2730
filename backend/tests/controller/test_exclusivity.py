"""Nobody commands devices, or speaks for them, beside another."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import pytest

from sequence_planner.ros import exclusivity
from sequence_planner.ros.exclusivity import require_sole_publisher
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Transport, TransportError
from sequence_planner.ros.transports.memory import MemoryNetwork
from support.cell import COMMAND, COMMAND_TYPE, Arm, cell

Scenario = Callable[[MemoryNetwork, Transport], Awaitable[None]]


@pytest.fixture(autouse=True)
def _short_leases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exclusivity, "DISCOVERY", 0.1)
    monkeypatch.setattr(exclusivity, "LONGEST_LEASE", 1.0)


def run(scenario: Scenario) -> None:
    async def live() -> None:
        network = MemoryNetwork()
        await scenario(network, network.join(cell()[0].registry, "question", asyncio.get_running_loop()))

    asyncio.run(asyncio.wait_for(live(), 10))


def other(network: MemoryNetwork) -> Transport:
    transport = network.join(cell()[0].registry, "other", asyncio.get_running_loop())
    transport.advertise(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE)
    return transport


async def ask(question: Transport) -> None:
    await require_sole_publisher(question, {COMMAND: COMMAND_TYPE}, "the controller")


def test_alone_one_may_go_on() -> None:
    async def scenario(network: MemoryNetwork, question: Transport) -> None:
        Arm(network)
        await ask(question)

    run(scenario)


def test_another_that_speaks_is_named_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exclusivity, "LONGEST_LEASE", 60.0)

    async def scenario(network: MemoryNetwork, question: Transport) -> None:
        transport = other(network)

        async def speak() -> None:
            while True:
                data = cell()[0].registry.encode(COMMAND_TYPE, {})
                transport.publish(COMMAND, COMMAND_TYPE, data)
                await asyncio.sleep(0.02)

        speaking = asyncio.create_task(speak())
        with pytest.raises(TransportError, match=r"publishes /arm/command \(node /other\): the controller would fight"):
            await ask(question)
        speaking.cancel()

    run(scenario)


def test_one_that_was_killed_is_waited_for_until_it_is_forgotten() -> None:
    async def scenario(network: MemoryNetwork, question: Transport) -> None:
        dead = other(network)
        asking = asyncio.create_task(ask(question))
        await asyncio.sleep(0.4)
        assert not asking.done()
        dead.close()
        await asking

    run(scenario)


def test_one_that_is_silent_and_stays_is_alive() -> None:
    async def scenario(network: MemoryNetwork, question: Transport) -> None:
        other(network)
        with pytest.raises(TransportError, match="choose another ROS_DOMAIN_ID"):
            await ask(question)

    run(scenario)
