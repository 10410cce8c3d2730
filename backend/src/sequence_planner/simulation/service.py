"""The process of the emulated devices: messages in, time passing, messages out.

It looks at the devices when something has come for them, when a report is due, and when one of them is done.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import random
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import structlog

from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.ros.actions import ActionNames
from sequence_planner.ros.exclusivity import require_sole_publisher
from sequence_planner.ros.transport import Sample, Transport
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.ros.types.standard_types import GOAL_STATUSES
from sequence_planner.simulation.device_state import DeviceState, save_state
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.fault_script import Scripted
from sequence_planner.simulation.faults import FaultReader, FaultyDevices
from sequence_planner.simulation.manual_interface import NODE, cause, listen
from sequence_planner.simulation.messages import Links, Message
from sequence_planner.simulation.servers import serve_clients
from sequence_planner.station import ReadyStation

LOG = structlog.get_logger(__name__)

# Seconds in which others that emulate the same devices are found. Devices are on the network before the controller that
# begins with them ends the participant by which it looks for others: who comes in that moment may never be known whole.
ALONE = 1.0
STEP = 0.02  # seconds between two looks at the devices, at least
KEEP_EVERY = 1.0  # seconds between two notes of how they stand
REPORT_EVERY = 0.1  # seconds between two reports that say the same


@dataclass(frozen=True)
class Emulation:
    """A description of what is emulated, and how.

    Devices go `speed` times as fast. `seed` draws all that is random; effects and repeated reports come up to `jitter`
    seconds late. Only the devices of `resources` are emulated; None stands for all. `script` has faults, in the order
    in which they begin. They begin as others were `standing`; how they stand is `kept_in` a file, as soon as they are
    up, while they change, and at the end: they may be killed before they come to that.
    """

    station: ReadyStation
    speed: float = 1.0
    seed: int = 0
    jitter: float = 0.0
    resources: frozenset[str] | None = None
    script: tuple[Scripted, ...] = ()
    standing: DeviceState | None = None
    kept_in: Path | None = None

    @property
    def emulated(self) -> frozenset[str]:
        """The resources whose topics the devices are on."""
        pipelines = self.station.pipelines
        said = {each.topic.resource for each in (*pipelines.outgoing.values(), *pipelines.requests.values())}
        there = said.union(each.topic.resource for each in pipelines.sources.values())
        return frozenset(there if self.resources is None else there & self.resources)

    def reader(self) -> FaultReader:
        """Reads faults of these devices."""
        return FaultReader(self.station.automaton, self.station.pipelines, self.emulated.__contains__)


async def emulate(emulation: Emulation, connect: Callable[[str], Transport]) -> None:
    """Run the emulated devices until cancelled. `connect` joins the network as the node of the given name.

    Raises `TransportError` when another publishes the devices' topics.
    """
    pipelines, emulated = emulation.station.pipelines, emulation.emulated
    topics = [each.topic for each in pipelines.incoming.values() if each.topic.resource in emulated]
    served = [each.name for each in pipelines.actions.values() if each.goal.topic.resource in emulated]
    reported = {topic.name: topic.type_name for topic in topics}
    reported |= {ActionNames(name).status: GOAL_STATUSES for name in served}
    question = connect(f"{NODE}_check")
    try:
        await require_sole_publisher(question, reported, "the emulated devices", ALONE)
    finally:
        question.close()
    await _Life(emulation, connect).run()


@dataclass(frozen=True)
class _Said:
    """The last report on a topic, as it was and in bytes, and when the next one is due."""

    message: Message | None
    data: bytes
    due: float


class _Life:
    def __init__(self, emulation: Emulation, connect: Callable[[str], Transport]) -> None:
        station = emulation.station
        self._emulation = emulation
        self._pipelines, self._registry = station.pipelines, station.registry
        devices = EmulatedDevices(
            station.automaton,
            station.pipelines,
            emulation.speed,
            emulation.seed,
            jitter=emulation.jitter,
            resources=emulation.resources,
        )
        if emulation.standing is not None:
            devices.restore_values(emulation.standing.values, emulation.standing.messages)
        self._devices = FaultyDevices(devices, station.pipelines, emulation.seed)
        self._others = RunningPipelines(station.pipelines)  # what devices say that are not emulated
        self._random = random.Random(f"reports {emulation.seed}")
        self._troubles: dict[str, str] = {}  # what was wrong on each topic last, so that it is not said every time
        self._said: dict[str, _Said] = {}
        self._news = asyncio.Event()
        self._kept, self._unkept = 0.0, True  # when it was written down how they stand, and whether they have changed
        devices.on_change = self._change
        self._connect = connect
        self._emulated = emulation.emulated
        self._links = Links(station.pipelines, self._emulated, lambda: connect(NODE), self._obey)

    async def run(self) -> None:
        """Live until cancelled."""
        main = self._connect(NODE)
        try:
            listen(main, self._registry, self._devices, self._emulation.reader())
            self._subscribe_real_devices(main)
            serve_clients(self._emulation.station, self._devices.devices, main)
            self._links.keep(frozenset())
            LOG.info("emulated devices are up", resources=sorted(self._emulated))
            self._keep()
            script, began = list(self._emulation.script), time.monotonic()
            while True:
                self._news.clear()
                now = time.monotonic()
                while script and script[0].at <= now - began:
                    what = script.pop(0).what
                    LOG.info("as written", fault=str(what), answer=cause(self._devices, what, now))
                self._devices.advance(now)
                self._links.keep(self._devices.offline_resources)
                self._report(now)
                if self._unkept and now - self._kept > KEEP_EVERY:
                    self._keep()
                await asyncio.sleep(STEP)
                await self._until(script[0].at + began if script else math.inf)
        finally:
            self._keep()
            self._links.close()
            self._others.close()
            main.close()

    async def _until(self, due: float) -> None:
        """Wait until then, or until there is something to do before."""
        due = min(due, self._devices.due, *(each.due for each in self._said.values()))
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(max(0.0, due - time.monotonic()) if due < math.inf else None):
                await self._news.wait()

    def _change(self) -> None:
        self._unkept = True
        self._news.set()

    def _keep(self) -> None:
        self._kept, self._unkept = time.monotonic(), False
        if self._emulation.kept_in is not None:
            with contextlib.suppress(OSError):  # then those that come after begin as their model says
                save_state(self._devices.devices, self._emulation.kept_in)

    def _subscribe_real_devices(self, main: Transport) -> None:
        """Hear what is said and commanded where the devices are not emulated."""
        emulated = self._emulated
        for incoming in self._pipelines.incoming.values():
            if incoming.topic.resource not in emulated:
                main.subscribe(incoming.topic.name, incoming.topic.type_name, incoming.topic.quality, self._see)
        for outgoing in self._pipelines.outgoing.values():
            if outgoing.topic.resource not in emulated:
                main.subscribe(outgoing.topic.name, outgoing.topic.type_name, outgoing.topic.quality, self._obey)

    def _report(self, now: float) -> None:
        for name, pipeline in self._pipelines.incoming.items():
            if pipeline.topic.resource not in self._emulated:
                continue
            message = self._devices.says(name)
            if message is None:
                self._said.pop(name, None)
                continue
            last = self._said.get(name, _Said(None, b"", now))
            same = message is last.message  # what a device says is never changed, but another message takes its place
            data = last.data if same else self._registry.encode(pipeline.topic.type_name, message)
            if data == last.data and now < last.due:
                continue
            due = now + REPORT_EVERY + self._random.uniform(0, self._emulation.jitter)
            self._said[name] = _Said(message, data, due)
            if (sent := self._devices.sent(name, data)) is not None:
                self._links.publish(name, pipeline.topic.type_name, sent)

    def _obey(self, samples: Sequence[Sample]) -> None:
        """Take commands; one that makes no sense is said once."""
        for sample in samples:
            if self._devices.hears(sample.topic):
                type_name = self._pipelines.outgoing[sample.topic].topic.type_name
                try:
                    message = self._registry.decode(type_name, sample.data)
                    trouble = "; ".join(self._devices.devices.command(sample.topic, message))
                except MalformedMessageError as error:
                    trouble = str(error)
                self._log_trouble(sample.topic, trouble)

    def _see(self, samples: Sequence[Sample]) -> None:
        """Take what devices say that are not emulated; what cannot be read leaves what they said before."""
        for sample in samples:
            type_name = self._pipelines.incoming[sample.topic].topic.type_name
            try:
                self._others.take(sample.topic, self._registry.decode(type_name, sample.data), sample.received)
                self._log_trouble(sample.topic, "")
            except MalformedMessageError as error:
                self._log_trouble(sample.topic, str(error))
        fresh = dict.fromkeys(self._pipelines.sources, True)
        self._devices.devices.observe({n: v for n, v in self._others.values(fresh).items() if v is not None})

    def _log_trouble(self, topic: str, trouble: str) -> None:
        if trouble and trouble != self._troubles.get(topic):
            LOG.warning("message not understood", topic=topic, trouble=trouble)
        self._troubles[topic] = trouble
