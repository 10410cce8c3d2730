"""A life of a real controller with its planner and with emulated devices, which have faults, on a network in memory."""

from __future__ import annotations

import asyncio
import contextlib
import random
import time
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path
from typing import Final, Literal

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.approvals import ForceVariable
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import (
    EnterRestart,
    LeaveRestart,
    SetMode,
    SetService,
    StartProduction,
    TakeControl,
)
from sequence_planner.controller.commands.jobs import CommandJob, TakeJob
from sequence_planner.controller.commands.queries import AskAdvice, AskGoal, AskReset
from sequence_planner.controller.commands.recovery import CorrectEstimates, DecideOutputs, ExecuteOperatorPlan
from sequence_planner.controller.commands.tasks import AcknowledgeTask
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.previous_run import what_is_known
from sequence_planner.controller.views.proposals import AdviceView, OfferView
from sequence_planner.controller.views.station import StationIdentity, StationView
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.types import Value
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.faults import Fault, FaultKind, FaultyDevices
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.people import EVA

SPEED: Final = 6.0  # of the devices
DEVICE_STEP: Final = 0.05  # seconds between two reports of a device
SNAPSHOT_EVERY: Final = 120  # records, so that there are some in a short run
PATIENCE: Final = 30.0  # seconds
SOON: Final = 3.0  # seconds
TASK: Final = 0.5  # seconds that a person needs for a task
WHY: Final = "to record it"


@cache
def ready(folder: Path) -> tuple[ReadyStation, Supervisor]:
    """The station in `folder` and its supervisor."""
    station = prepare_station(folder)
    return station, synthesise(station.automaton)


class Devices:
    """All devices of a station as one node. They stay when the controller is started again."""

    def __init__(self, station: ReadyStation, network: MemoryNetwork, seed: int) -> None:
        self._pipelines, self._registry = station.pipelines, station.registry
        self.emulated = EmulatedDevices(station.automaton, station.pipelines, SPEED, seed)
        self._faulty = FaultyDevices(self.emulated, station.pipelines, seed)
        self._transport = network.join(station.registry, "emulated_devices", asyncio.get_running_loop())
        for incoming in station.pipelines.incoming.values():
            self._transport.advertise(incoming.topic.name, incoming.topic.type_name, incoming.topic.quality)
        for outgoing in station.pipelines.outgoing.values():
            self._transport.subscribe(
                outgoing.topic.name, outgoing.topic.type_name, outgoing.topic.quality, self._commanded
            )

    def fail(self, kind: FaultKind, target: str, seconds: float, value: Value | None = None, amount: float = 1) -> None:
        """Let a fault begin."""
        self._faulty.start(Fault(kind, target, amount, value, seconds), time.monotonic())

    async def live(self) -> None:
        """Report until cancelled."""
        try:
            while True:
                self._faulty.advance(time.monotonic())
                for name, pipeline in self._pipelines.incoming.items():
                    if (message := self._faulty.says(name)) is not None:
                        kind = pipeline.topic.type_name
                        data = self._faulty.sent(name, self._registry.encode(kind, message))
                        if data is not None:
                            self._transport.publish(name, kind, data)
                await asyncio.sleep(DEVICE_STEP)
        finally:
            self._transport.close()

    def _commanded(self, samples: Sequence[Sample]) -> None:
        for sample in samples:
            if self._faulty.hears(sample.topic):
                topic = self._pipelines.outgoing[sample.topic].topic
                self.emulated.command(sample.topic, self._registry.decode(topic.type_name, sample.data))


class Life:
    """What a scenario asks of the station: it stands for a person at the page, at the devices, and with the tasks."""

    def __init__(self, station: ReadyStation, controller: Controller, devices: Devices, chance: random.Random) -> None:
        self.station, self.controller, self.devices, self.chance = station, controller, devices, chance

    @property
    def view(self) -> StationView:
        """What there is to see."""
        return self.controller.view()

    def value(self, name: str) -> Value | None:
        """What a variable is."""
        return self.controller.execution.state[name]

    async def until(self, what: Callable[[], bool]) -> None:
        """Wait until `what` is true."""
        end = time.monotonic() + PATIENCE
        while not what():
            execution = self.controller.execution
            assert time.monotonic() < end, f"not in time: {execution.plan.reason}; runs: {sorted(execution.running())}"
            await asyncio.sleep(0.02)

    async def work(self, starts: int) -> None:
        """Let so many more abilities start."""
        count = [0]
        self.controller.execution.listeners.append(
            lambda heard: count.__setitem__(0, count[0] + len(heard.outcome.started if heard.outcome else ()))
        )
        await self.until(lambda: count[0] >= starts)

    async def start(self) -> None:
        """Take control, decide that restored outputs stay as they are, and start production."""
        await asyncio.sleep(0.5)
        await self.controller.command(TakeControl(actor=EVA))
        values = {name: view.value for name, view in self.view.undecided.items()}
        if values:
            await self.controller.command(DecideOutputs(actor=EVA, reason=WHY, values=values))
        await self.controller.command(StartProduction(actor=EVA))

    async def mode(self, mode: Literal[Mode.AUTOMATIC, Mode.PAUSED, Mode.HOLD]) -> None:
        """Go to a mode."""
        await self.controller.command(SetMode(actor=EVA, mode=mode))

    async def enter_restart(self) -> None:
        """Go to restart mode, and wait for what runs: it ends soon, or waits for what is not started any more."""
        await self.controller.command(EnterRestart(actor=EVA))
        end = time.monotonic() + SOON
        while self.controller.execution.running():
            if time.monotonic() > end:
                return
            await asyncio.sleep(0.02)

    async def leave_restart(self) -> None:
        """Leave restart mode, and go on."""
        await self.controller.command(LeaveRestart(actor=EVA))
        await self.mode(Mode.AUTOMATIC)

    async def correct(self, values: dict[str, Value]) -> None:
        """Say what estimates are."""
        revision = self.controller.execution.revision
        await self.controller.command(CorrectEstimates(actor=EVA, reason=WHY, values=values, revision=revision))

    async def force(self, name: str, value: Value, seconds: float) -> None:
        """Force a variable."""
        await self.controller.command(ForceVariable(actor=EVA, reason=WHY, name=name, value=value, seconds=seconds))

    async def service(self, of: ServiceKind, name: str, in_service: bool) -> None:
        """Take something out of service, or put it back."""
        command = SetService(actor=EVA, reason=WHY, of=of, name=name, in_service=in_service)
        await self.controller.command(command)

    async def advised(self) -> OfferView | None:
        """Take the first way on that can be taken as things are; None where there is none."""
        advice = await self.controller.answer(AskAdvice())
        assert isinstance(advice, AdviceView)
        offer = next((each for each in advice.offers if each.obstacle is None and each.errand is not None), None)
        if offer is not None:
            await self._take(offer)
        return offer

    async def goal(self, predicate: str) -> None:
        """Take a plan by hand to what shall hold."""
        await self._take(await self.controller.answer(AskGoal(predicate=predicate)))

    async def reset(self, operation: str) -> None:
        """Take a plan by hand to the precondition of an operation."""
        await self._take(await self.controller.answer(AskReset(operation=operation)))

    async def operator_plan_over(self) -> None:
        """Wait until a plan by hand is over."""
        await self.until(lambda: self.controller.execution.operator_plan is None)

    async def job(self, job: str, work_master: str) -> None:
        """Order a job."""
        await self.controller.command(TakeJob(actor=SYSTEM, job=job, title=f"Job {job}", work_master=work_master))

    async def tell_job(self, job: str, what: Literal["pause", "resume", "stop", "abort"]) -> None:
        """Command a job."""
        await self.controller.command(CommandJob(actor=SYSTEM, job=job, what=what))

    async def _take(self, offer: object) -> None:
        assert isinstance(offer, OfferView)
        assert offer.errand is not None
        starts = [step.ability for step in offer.errand.steps]
        corrections = {change.name: change.then for change in offer.corrections}
        await self.controller.command(
            ExecuteOperatorPlan(actor=EVA, reason=WHY, offer=offer.id, starts=starts, corrections=corrections)
        )

    async def attend(self) -> None:
        """Do the tasks that people are given, until cancelled."""
        while True:
            await asyncio.sleep(0.05)
            for id_, task in self.controller.view().tasks.items():
                if time.time() - task.created > TASK:
                    command = AcknowledgeTask(actor=SYSTEM, task=id_, revision=task.revision)
                    with contextlib.suppress(CommandRefused):
                        await self.controller.command(command)


@asynccontextmanager
async def devices(folder: Path, network: MemoryNetwork, seed: int) -> AsyncIterator[Devices]:
    """Emulated devices that report."""
    found = Devices(ready(folder)[0], network, seed)
    living = asyncio.create_task(found.live())
    try:
        yield found
    finally:
        living.cancel()
        await asyncio.gather(living, return_exceptions=True)


@asynccontextmanager
async def life(
    folder: Path, network: MemoryNetwork, database: Database, around: Devices, chance: random.Random
) -> AsyncIterator[Life]:
    """A controller from its start to its end, which knows what the journal does."""
    station, supervisor = ready(folder)
    identity = StationIdentity(
        name=folder.name.removesuffix("_deployed"),
        title="",
        titles={},
        description="",
        transport="memory",
        emulated=True,
    )
    transport = network.join(station.registry, "sequence_planner", asyncio.get_running_loop())
    known = what_is_known(database, station.automaton)
    controller = build_controller(identity, station, supervisor, transport, database, known)
    controller.records.recorder._snapshot_every = SNAPSHOT_EVERY
    controller.take_command()
    here = Life(station, controller, around, chance)
    running = asyncio.create_task(controller.run())
    attending = asyncio.create_task(here.attend())
    try:
        yield here
        failing = [alarm.text for key, alarm in controller.view().alarms.items() if key.startswith("controller:")]
        assert not failing, failing
    finally:
        for task in (attending, running):
            task.cancel()
        await asyncio.gather(running, attending, return_exceptions=True)
        transport.close()
