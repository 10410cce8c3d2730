"""Manual interface of emulated devices: node and topic names, hand moves and faults as text lines."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Final

import structlog

from sequence_planner.language.parser import parse_assignment
from sequence_planner.language.syntax import Constant, ExpressionError, Name
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, Transport
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.faults import Clear, Fault, FaultReader, FaultyDevices

# What a person does to emulated devices while they run, in lines of text, each of which is answered.
#
# On one topic devices are moved by hand, `robot.pose := home`; on another they get faults, `robot silent for 5 s`. What
# has become of a line is said on a third, behind the line itself: `robot silent for 5 s => begins`.

LOG = structlog.get_logger(__name__)

BY_HAND_TOPIC = "/sequence_planner/emulator/by_hand"
FAULTS_TOPIC = "/sequence_planner/emulator/faults"
SAID_TOPIC = "/sequence_planner/emulator/said"
TEXT_TYPE = "std_msgs/msg/String"
REFUSED = "refused: "  # with which an answer begins when nothing was done
_LONGEST = 200  # characters of a line that are repeated

Act = Callable[[str], str]


def answer_start(line: str) -> str:
    """Return how the answer to a line begins."""
    return f"{line[:_LONGEST]} => "


def listen(transport: Transport, registry: MessageRegistry, devices: FaultyDevices, reader: FaultReader) -> None:
    """Carry out and answer lines until the transport is closed."""

    def obey(act: Act) -> Callable[[Sequence[Sample]], None]:
        def take(samples: Sequence[Sample]) -> None:
            for sample in samples:
                line = ""
                try:
                    line = str(registry.decode(TEXT_TYPE, sample.data)["data"])
                    answer = act(line)
                    LOG.info("done to the devices", line=line[:_LONGEST], answer=answer)
                except (MalformedMessageError, ExpressionError, ValueError) as error:
                    answer = f"{REFUSED}{str(error)[:1000]}"
                    LOG.warning("not done to the devices", line=line[:_LONGEST], reason=str(error)[:_LONGEST])
                text = f"{answer_start(line)}{answer}"
                transport.publish(SAID_TOPIC, TEXT_TYPE, registry.encode(TEXT_TYPE, {"data": text}))

        return take

    transport.advertise(SAID_TOPIC, TEXT_TYPE, QualityOfService.RELIABLE)
    for topic, act in (
        (BY_HAND_TOPIC, lambda line: _moved(devices.devices, line)),
        (FAULTS_TOPIC, lambda line: cause(devices, reader.read(line), time.monotonic())),
    ):
        transport.subscribe(topic, TEXT_TYPE, QualityOfService.RELIABLE, obey(act))


def cause(devices: FaultyDevices, what: Fault | Clear, now: float) -> str:
    """Let faults begin or end; returns what has been done, for a person."""
    devices.advance(now)  # who is slow from now on was not slow before
    if isinstance(what, Clear):
        ended = devices.clear(what)
        return f"ended: {'; '.join(map(str, ended))}" if ended else "there was nothing to end"
    devices.start(what, now)
    return "begins"


def _moved(devices: EmulatedDevices, line: str) -> str:
    move(devices, line)
    return "done"


def move(devices: EmulatedDevices, text: str) -> None:
    """Carry out a text such as `robot.pose := home`. Raises `ExpressionError` or ValueError saying what is wrong."""
    action = parse_assignment(text)
    match action.value if action.condition is None else None:
        case Constant(value):
            devices.set_value(str(action.target), value)
        case Name():
            devices.set_value(str(action.target), str(action.value))
        case _:
            raise ValueError(f"`{text}`: write `variable := value`")


# How emulated devices are known on the network; by itself, as the controller needs no more of them.

NODE: Final = "emulated_devices"
