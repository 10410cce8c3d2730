"""The real controller of the mixer, whose tank is reached by services and an action, on either kind of network.

Time is real. The tank is emulated, or says what a test wants.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.execution import StartProduction
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.views.station import StationIdentity
from sequence_planner.core.actor import SYSTEM
from sequence_planner.language.types import Value
from sequence_planner.ros.transport import Transport
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.servers import serve_clients
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.databases import journal
from support.network import DOMAIN
from support.places import MIXER

STIR, STIR_TYPE = "/tank/stir", "mixer_msgs/action/Stir"
LEVEL, LEVEL_TYPE = "/tank/level", "mixer_msgs/srv/Level"
FLUSH, FLUSH_TYPE = "/tank/flush", "std_srvs/srv/Trigger"


@cache
def mixer() -> tuple[ReadyStation, Supervisor]:
    """The mixer and its supervisor."""
    station = prepare_station(MIXER)
    return station, synthesise(station.automaton)


class Plant:
    """A network of one kind, on which controllers and tanks come and go."""

    def __init__(self, kind: str, station: ReadyStation) -> None:
        self._kind = kind
        self.station = station
        self._memory = MemoryNetwork()
        self._transports: list[Transport] = []
        self._running: list[asyncio.Task[None]] = []
        self._kept = ExitStack()
        self._database = self._kept.enter_context(journal())

    def join(self, node: str) -> Transport:
        """Join the network as a node."""
        loop, registry = asyncio.get_running_loop(), self.station.registry
        transport: Transport
        if self._kind == "memory":
            transport = self._memory.join(registry, node, loop)
        else:
            transport = open_transport("cyclonedds", registry, node, loop, DOMAIN)
        self._transports.append(transport)
        return transport

    def controller(self, supervisor: Supervisor) -> Controller:
        """A controller that runs, and waits for production to be started."""
        identity = StationIdentity(
            name="mixer", title="", titles={}, description="", transport=self._kind, emulated=True
        )
        controller = build_controller(identity, self.station, supervisor, self.join("sequence_planner"), self._database)
        controller.take_command()
        self._running.append(asyncio.create_task(controller.run()))
        return controller

    async def stop_controllers(self) -> None:
        """End the controllers, as when their process ends."""
        for task in self._running:
            task.cancel()
        await asyncio.gather(*self._running, return_exceptions=True)
        self._running.clear()

    def tank(self) -> tuple[EmulatedDevices, Transport]:
        """An emulated tank that lives until its transport is closed."""
        devices = EmulatedDevices(self.station.automaton, self.station.pipelines)
        transport = self.join("emulated_devices")
        serve_clients(self.station, devices, transport)
        return devices, transport

    async def close(self) -> None:
        """End everything."""
        await self.stop_controllers()
        for transport in self._transports:
            transport.close()
        self._kept.close()


def play(kind: str, scenario: Callable[[Plant], Awaitable[None]], station: ReadyStation | None = None) -> None:
    """Run a scenario on a fresh network and event loop."""

    async def run() -> None:
        plant = Plant(kind, station or mixer()[0])
        try:
            await scenario(plant)
        finally:
            await plant.close()

    asyncio.run(run())


@contextmanager
def living(devices: EmulatedDevices) -> Iterator[None]:
    """Let the time of emulated devices pass."""

    async def live() -> None:
        while True:
            devices.advance(time.monotonic())
            await asyncio.sleep(0.01)

    task = asyncio.create_task(live())
    try:
        yield
    finally:
        task.cancel()


async def start(controller: Controller) -> None:
    """Start production."""
    await controller.command(StartProduction(actor=SYSTEM))


def value(controller: Controller, name: str) -> Value | None:
    """The value of a variable."""
    return controller.execution.state[name]


def alarms(controller: Controller) -> list[str]:
    """The texts of all alarms whose causes are there, and of their parts."""
    there = [alarm for alarm in controller.view().alarms.values() if alarm.ended is None]
    return [text for alarm in there for text in (alarm.text, *alarm.parts)]
