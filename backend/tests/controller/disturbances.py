"""The truck engine station under random disturbances, in real time: its controller, its planner, and emulated devices.

Devices are moved by hand, estimates corrected, resources go away and come back, and people take their time.
"""

from __future__ import annotations

import asyncio
import random
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import pytest

from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import StartProduction
from sequence_planner.controller.commands.tasks import AcknowledgeTask
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.views.station import StationIdentity
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.execution.executor import Executor
from sequence_planner.planning.problem import PlanAnswer, PlanRequest
from sequence_planner.planning.validation.replay import Replay
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.simulation.devices import EmulatedDevices
from support.databases import journal
from support.simulated import truck_engine

LONGEST_TICK = 20.0  # milliseconds, of 99 in 100 ticks
STEPS = (1, 2, 5, 10, 20)  # milliseconds, in which the length of ticks is told
DEVICE_STEP = 0.05  # seconds between two reports of a device
SPEED = 2.0  # of the devices
CALM = 0.6  # seconds between two disturbances, on average
AWAY = 2.5  # seconds for which a resource is away, at most
IDENTITY = StationIdentity(name="truck", title="Truck", titles={}, description="", transport="memory", emulated=True)


@dataclass
class Disturbed:
    """What has been seen; `ticks` are how long each took, with all that the controller did beside it, in ms."""

    ticks: list[float] = field(default_factory=list)
    seen: Counter[str] = field(default_factory=Counter)

    @property
    def percentile(self) -> float:
        """What 99 in 100 ticks do not exceed."""
        return sorted(self.ticks)[len(self.ticks) * 99 // 100]

    @property
    def told(self) -> Counter[str]:
        """All of it in numbers that can be added up."""
        lengths = Counter(next((f"ticks of up to {s} ms" for s in STEPS if t <= s), "longer ticks") for t in self.ticks)
        return self.seen + lengths


class Devices:
    """All devices of the station as one node; those of a resource in `away` say nothing."""

    def __init__(self, network: MemoryNetwork, seed: int) -> None:
        station, _, _ = truck_engine()
        self._pipelines, self._registry = station.pipelines, station.registry
        self.emulated = EmulatedDevices(station.automaton, station.pipelines, SPEED, seed)
        self.transport = network.join(station.registry, "emulated_devices", asyncio.get_running_loop())
        self.away: dict[str, float] = {}  # resource: until when
        for incoming in station.pipelines.incoming.values():
            self.transport.advertise(incoming.topic.name, incoming.topic.type_name, incoming.topic.quality)
        for outgoing in station.pipelines.outgoing.values():
            self.transport.subscribe(
                outgoing.topic.name, outgoing.topic.type_name, outgoing.topic.quality, self._commanded
            )

    async def live(self) -> None:
        """Report until cancelled."""
        while True:
            now = time.monotonic()
            self.away = {resource: until for resource, until in self.away.items() if until > now}
            self.emulated.advance(now)
            for name, pipeline in self._pipelines.incoming.items():
                if pipeline.topic.resource not in self.away:
                    data = self._registry.encode(pipeline.topic.type_name, self.emulated.report(name))
                    self.transport.publish(name, pipeline.topic.type_name, data)
            await asyncio.sleep(DEVICE_STEP)

    def _commanded(self, samples: Sequence[Sample]) -> None:
        for sample in samples:
            topic = self._pipelines.outgoing[sample.topic].topic
            self.emulated.command(sample.topic, self._registry.decode(topic.type_name, sample.data))


@dataclass
class Trouble:
    """Somebody who disturbs a station again and again."""

    controller: Controller
    devices: Devices
    chance: random.Random
    seen: Counter[str]

    async def live(self) -> None:
        """Make trouble until cancelled."""
        acts = (self._move, self._correct, self._correct, self._send_away)
        while True:
            await asyncio.sleep(self.chance.uniform(0, 2 * CALM))
            self.chance.choice(acts)()
            for id_, task in self.controller.view().tasks.items():
                if self.chance.random() < 0.7:
                    try:
                        await self.controller.command(AcknowledgeTask(actor=SYSTEM, task=id_, revision=task.revision))
                    except CommandRefused:
                        continue

    def _move(self) -> None:
        """A device is moved by hand."""
        station = truck_engine()[0]
        name = self.chance.choice(sorted(station.pipelines.feeds))
        self.devices.emulated.set_value(name, self.chance.choice(station.automaton.variables[name].type.domain))
        self.seen["devices moved by hand"] += 1

    def _correct(self) -> None:
        """An estimate is corrected, which can activate an operation, or complete one."""
        execution = self.controller.execution
        name = self.chance.choice(execution.automaton.names(Kind.ESTIMATED))
        value = self.chance.choice(execution.automaton.variables[name].type.domain)
        execution.correct({name: value}, "somebody", "disturbed", Timestamp.now())
        self.seen["estimates corrected"] += 1

    def _send_away(self) -> None:
        """A resource goes away, and comes back later."""
        resources = sorted({p.topic.resource for p in truck_engine()[0].pipelines.incoming.values()})
        self.devices.away[self.chance.choice(resources)] = time.monotonic() + self.chance.uniform(0.5, AWAY)
        self.seen["resources sent away"] += 1


@contextmanager
def watched(into: Disturbed) -> Iterator[None]:
    """Take note of every tick and every plan adopted; AssertionError for a plan that does not replay."""
    step, adopt = Controller._step, Executor.adopt

    def timed(self: Controller, moment: Timestamp) -> None:
        before, began = self.execution.ticks, time.perf_counter()
        step(self, moment)
        if self.execution.ticks > before:
            into.ticks.append((time.perf_counter() - began) * 1000)

    def replayed(self: Executor, request: PlanRequest, answer: PlanAnswer) -> bool:
        adopted = adopt(self, request, answer)
        if self.plan.answer is answer and answer.plan is not None:
            replay = Replay(self.automaton, self.supervisor, request.circumstances)
            goals = [goal for goal in request.goals if goal.name in answer.goals]
            assert replay.exactly(request.state, request.state, goals, (), answer.plan.ticks), answer
            into.seen[f"plans adopted, {request.contract}"] += 1
        return adopted

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(Controller, "_step", timed)
        patched.setattr(Executor, "adopt", replayed)
        yield


async def disturbed(seconds: float, seed: str) -> Disturbed:
    """The station under disturbances for so long."""
    with journal() as database:
        return await _disturbed(seconds, seed, database)


async def _disturbed(seconds: float, seed: str, database: Database) -> Disturbed:
    seen = Disturbed()
    chance = random.Random(seed)
    station, supervisor, _ = truck_engine()
    network = MemoryNetwork()
    devices = Devices(network, chance.randrange(1000))
    transport = network.join(station.registry, "sequence_planner", asyncio.get_running_loop())
    controller = build_controller(IDENTITY, station, supervisor, transport, database)
    controller.take_command()
    trouble = Trouble(controller, devices, chance, seen.seen)
    with watched(seen):
        living = [asyncio.create_task(devices.live()), asyncio.create_task(controller.run())]
        try:
            await asyncio.sleep(1.0)
            await controller.command(StartProduction(actor=SYSTEM))
            living.append(asyncio.create_task(trouble.live()))
            done, _ = await asyncio.wait(living, timeout=seconds, return_when=asyncio.FIRST_EXCEPTION)
            for task in done:
                task.result()
            failing = [alarm.text for key, alarm in controller.view().alarms.items() if key.startswith("controller:")]
            assert not failing, failing
        finally:
            for task in living:
                task.cancel()
            await asyncio.gather(*living, return_exceptions=True)
            transport.close()
            devices.transport.close()
    seen.seen["operations completed"] += sum(view.completed for view in controller.view().operations.values())
    return seen
