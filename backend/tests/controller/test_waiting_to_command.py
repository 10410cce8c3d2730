"""A controller that is started again while somebody else commands the devices: it waits, and says for whom."""

from __future__ import annotations

import asyncio
import contextlib
from pathlib import Path

import pytest

from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import StartProduction
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.service import Running, control
from sequence_planner.core.actor import SYSTEM
from sequence_planner.execution.vocabulary import Production
from sequence_planner.ros import exclusivity
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import TransportError
from sequence_planner.ros.transports.memory import MemoryNetwork
from support.cell import COMMAND, COMMAND_TYPE, Arm, cell
from support.places import CELL
from support.waiting import until_async


@pytest.fixture(autouse=True)
def _short_leases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exclusivity, "DISCOVERY", 0.1)
    monkeypatch.setattr(exclusivity, "LONGEST_LEASE", 0.3)


def running(network: MemoryNetwork, folder: Path, *, again: bool) -> Running:
    folder.chmod(0o700)
    loop = asyncio.get_running_loop()
    return Running(
        cell()[0],
        CELL,
        folder / "socket",
        lambda node: network.join(cell()[0].registry, node, loop),
        emulated=False,
        start=False,
        database=f"sqlite:///{folder}/station.sqlite",
        again=again,
    )


def test_it_says_for_whom_it_waits_and_commands_once_that_has_ended(tmp_path: Path) -> None:
    async def scenario() -> None:
        network, loop = MemoryNetwork(), asyncio.get_running_loop()
        arm, other = Arm(network), network.join(cell()[0].registry, "other", loop)
        other.advertise(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE)
        client = ControllerClient(tmp_path / "socket")
        living = [asyncio.create_task(each) for each in (control(running(network, tmp_path, again=True)), client.run())]
        start = StartProduction(actor=SYSTEM, reason="work")

        def waits() -> bool:
            alarm = None if client.view is None else client.view.alarms.get("rival")
            return alarm is not None and alarm.ended is None

        with arm.saying("home"):
            await until_async(waits)
            assert client.view is not None
            assert "/other" in client.view.alarms["rival"].text
            with pytest.raises(CommandRefused, match=r"/arm/command \(node /other\)") as refused:
                await client.send(start)
            assert refused.value.slug == "other-controller"
            other.close()

            async def begin() -> bool:
                while True:
                    with contextlib.suppress(CommandRefused):
                        return await client.send(start)
                    await asyncio.sleep(0.1)

            await asyncio.wait_for(begin(), 30)
            await until_async(lambda: client.view is not None and client.view.production is Production.STARTED)
            await until_async(lambda: not waits())
        for task in living:
            task.cancel()
        await asyncio.wait(living)

    asyncio.run(scenario())


def test_at_the_first_start_it_refuses(tmp_path: Path) -> None:
    async def scenario() -> None:
        network = MemoryNetwork()
        other = network.join(cell()[0].registry, "other", asyncio.get_running_loop())
        other.advertise(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE)
        with pytest.raises(TransportError, match="Stop the other one"):
            await asyncio.wait_for(control(running(network, tmp_path, again=False)), 30)

    asyncio.run(scenario())
