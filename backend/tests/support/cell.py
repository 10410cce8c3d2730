"""The real controller on a network inside one process, with devices that say what the test wants.

Time is real; the planner is its own process. The station is the small cell of `tests/stations`.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import cache

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.execution import StartProduction
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.previous_run import what_is_known
from sequence_planner.controller.views.station import StationIdentity
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.memory import MemoryNetwork, MemoryTransport
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.databases import journal
from support.places import CELL
from support.waiting import until_async

STATE, COMMAND = "/arm/state", "/arm/command"
STATE_TYPE, COMMAND_TYPE = "cell_msgs/msg/ArmState", "cell_msgs/msg/ArmCommand"
POSES = {"home": [0.0, 0.0], "out": [1.0, 0.5], "unknown": [0.5, 0.25]}
IDENTITY = StationIdentity(name="cell", title="Cell", titles={}, description="", transport="memory", emulated=True)


@cache
def cell() -> tuple[ReadyStation, Supervisor]:
    """The cell and its supervisor."""
    station = prepare_station(CELL)
    return station, synthesise(station.automaton)


class Arm:
    """The only device of the cell, as the node of the given name."""

    def __init__(self, network: MemoryNetwork, node: str = "emulated_devices") -> None:
        self._registry = cell()[0].registry
        self.transport = network.join(self._registry, node, asyncio.get_running_loop())
        self.transport.advertise(STATE, STATE_TYPE, QualityOfService.RELIABLE)
        self.transport.subscribe(COMMAND, COMMAND_TYPE, QualityOfService.RELIABLE, self._hear)
        self.commands: list[str] = []  # where it was told to go

    def say(self, *poses: str, moving: bool = False) -> None:
        """Report poses, one message each, at once."""
        for pose in poses:
            record = {"joints": POSES[pose], "moving": moving}
            self.transport.publish(STATE, STATE_TYPE, self._registry.encode(STATE_TYPE, record))

    @contextlib.contextmanager
    def saying(self, pose: str) -> Iterator[None]:
        """Report the pose again and again."""

        async def report() -> None:
            while True:
                self.say(pose)
                await asyncio.sleep(0.1)

        task = asyncio.create_task(report())
        try:
            yield
        finally:
            task.cancel()

    def _hear(self, samples: object) -> None:
        assert isinstance(samples, tuple)
        for sample in samples:
            assert isinstance(sample, Sample)
            joints = self._registry.decode(COMMAND_TYPE, sample.data)["joints"]
            self.commands.append(next(pose for pose, numbers in POSES.items() if numbers == joints))


@dataclass
class Bench:
    """What a test needs."""

    network: MemoryNetwork
    transport: MemoryTransport
    controller: Controller
    running: asyncio.Task[None]
    database: Database

    async def start(self) -> None:
        await self.controller.command(StartProduction(actor=SYSTEM))

    async def until(self, what: Callable[[], bool], seconds: float = 20) -> None:
        """Wait until `what` is true."""
        await until_async(lambda: self.running.done() or what(), seconds=seconds)
        assert not self.running.done(), "the controller has ended"


@asynccontextmanager
async def bench(network: MemoryNetwork | None = None, database: Database | None = None) -> AsyncIterator[Bench]:
    """A controller that runs, and waits for production to be started; it knows what `database` does."""
    station, supervisor = cell()
    network = network or MemoryNetwork()
    transport = network.join(station.registry, "sequence_planner", asyncio.get_running_loop())
    with contextlib.ExitStack() as kept:
        database = database or kept.enter_context(journal())
        known = what_is_known(database, station.automaton)
        controller = build_controller(IDENTITY, station, supervisor, transport, database, known)
        controller.take_command()
        running = asyncio.create_task(controller.run())
        await asyncio.sleep(0)  # what has not begun would not end in good order either
        try:
            yield Bench(network, transport, controller, running, database)
        finally:
            running.cancel()
            await asyncio.gather(running, return_exceptions=True)
            transport.close()
