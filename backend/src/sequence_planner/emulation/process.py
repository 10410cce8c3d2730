"""The process of the emulated devices: messages in, time passing, messages out."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import structlog

from sequence_planner.emulation.devices import EmulatedDevices
from sequence_planner.expressions.parser import parse_assignment
from sequence_planner.expressions.syntax import Constant, ExpressionError, Name
from sequence_planner.ros.errors import MalformedMessageError
from sequence_planner.ros.exclusivity import require_sole_publisher
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import QualityOfService, Sample, Transport
from sequence_planner.station import ReadyStation

LOG = structlog.get_logger(__name__)

NODE = "emulated_devices"  # its name on the network
STEP = 0.02  # seconds between two looks at the clock
REPORT_EVERY = 0.1  # seconds between two reports that say the same
BY_HAND_TOPIC = "/sequence_planner/emulator/by_hand"
BY_HAND_TYPE = "std_msgs/msg/String"


@dataclass(frozen=True)
class Emulation:
    """What is emulated, and how fast."""

    station: ReadyStation
    speed: float = 1.0
    seed: int = 0


async def emulate(emulation: Emulation, connect: Callable[[str], Transport]) -> None:
    """Run the emulated devices until cancelled. `connect` joins the network as the node of the given name.

    Raises `TransportError` when another publishes the devices' topics.
    """
    reported = {p.topic.name: p.topic.type_name for p in emulation.station.pipelines.incoming.values()}
    question = connect(f"{NODE}_check")
    try:
        await require_sole_publisher(question, reported, "the emulated devices")
    finally:
        question.close()
    transport = connect(NODE)
    try:
        await _run(emulation, transport)
    finally:
        transport.close()


async def _run(emulation: Emulation, transport: Transport) -> None:
    devices = EmulatedDevices(emulation.station.automaton, emulation.station.pipelines, emulation.speed, emulation.seed)
    incoming = emulation.station.pipelines.incoming
    for pipeline in incoming.values():
        transport.advertise(pipeline.topic.name, pipeline.topic.type_name, pipeline.topic.quality)
    for outgoing in emulation.station.pipelines.outgoing.values():
        topic = outgoing.topic
        transport.subscribe(topic.name, topic.type_name, topic.quality, _commands(emulation, devices))
    transport.subscribe(
        BY_HAND_TOPIC, BY_HAND_TYPE, QualityOfService.RELIABLE, _by_hand(emulation.station.registry, devices)
    )
    LOG.info("emulated devices are up", topics=sorted(incoming))
    said: dict[str, tuple[float, bytes]] = {}
    while True:
        now = time.monotonic()
        devices.advance(now)
        for name, pipeline in incoming.items():
            data = emulation.station.registry.encode(pipeline.topic.type_name, devices.report(name))
            last = said.get(name)
            if last is None or last[1] != data or now - last[0] >= REPORT_EVERY:
                transport.publish(name, pipeline.topic.type_name, data)
                said[name] = (now, data)
        await asyncio.sleep(STEP)


def _commands(emulation: Emulation, devices: EmulatedDevices) -> Callable[[Sequence[Sample]], None]:
    said: dict[str, list[str]] = {}  # what was wrong on each topic last, so that it is not said with every message

    def take(samples: Sequence[Sample]) -> None:
        for sample in samples:
            type_name = emulation.station.pipelines.outgoing[sample.topic].topic.type_name
            try:
                troubles = devices.command(sample.topic, emulation.station.registry.decode(type_name, sample.data))
            except MalformedMessageError as error:
                troubles = [str(error)]
            if troubles and troubles != said.get(sample.topic):
                LOG.warning("command not understood", topic=sample.topic, troubles=troubles)
            said[sample.topic] = troubles

    return take


def _by_hand(registry: MessageRegistry, devices: EmulatedDevices) -> Callable[[Sequence[Sample]], None]:
    """Take texts such as `robot.pose := home`: somebody moves a device by hand."""

    def take(samples: Sequence[Sample]) -> None:
        for sample in samples:
            text = ""
            try:
                text = str(registry.decode(BY_HAND_TYPE, sample.data)["data"])
                move(devices, text)
                LOG.info("moved by hand", change=text)
            except (MalformedMessageError, ExpressionError, ValueError) as error:
                LOG.warning("not moved", change=text[:200], reason=str(error)[:200])

    return take


def move(devices: EmulatedDevices, text: str) -> None:
    """Carry out a text such as `robot.pose := home`. Raises `ExpressionError` or ValueError saying what is wrong."""
    action = parse_assignment(text)
    match action.value if action.condition is None else None:
        case Constant(value):
            devices.put(str(action.target), value)
        case Name():
            devices.put(str(action.target), str(action.value))
        case _:
            raise ValueError(f"`{text}`: write `variable := value`")
