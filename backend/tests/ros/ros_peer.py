"""A peer in a process of its own: what it hears on /ping it says on /pong in capitals, until its input ends.

    python ros_peer.py ours|plain DOMAIN

`ours` speaks through the station's transport. `plain` shares no code with it: a program written with cyclonedds as its
manual teaches, which knows ROS 2's names and leaves the bytes to cyclonedds' own codec.
"""

import asyncio
import sys
from collections.abc import Sequence
from dataclasses import dataclass

from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from sequence_planner.ros.choice import open_transport
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import QualityOfService, Sample

TEXT = "std_msgs/msg/String"


async def until_input_ends() -> None:
    await asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)


async def ours(domain: int) -> None:
    registry = MessageRegistry.from_folder(None)
    transport = open_transport("cyclonedds", registry, "peer", asyncio.get_running_loop(), domain)

    def answer(batch: Sequence[Sample]) -> None:
        for sample in batch:
            text = str(registry.decode(TEXT, sample.data)["data"])
            transport.publish("/pong", TEXT, registry.encode(TEXT, {"data": text.upper()}))

    transport.advertise("/pong", TEXT, QualityOfService.RELIABLE)
    transport.subscribe("/ping", TEXT, QualityOfService.RELIABLE, answer)
    await until_input_ends()
    transport.close()


@dataclass
class Text(IdlStruct, typename="std_msgs.msg.dds_.String_"):
    """std_msgs/msg/String as IDL."""

    data: str


async def plain(domain: int) -> None:
    participant = DomainParticipant(domain)
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))
    reader = DataReader(participant, Topic(participant, "rt/ping", Text), qos)
    writer = DataWriter(participant, Topic(participant, "rt/pong", Text), qos)
    ended = asyncio.create_task(until_input_ends())
    while not ended.done():
        for sample in reader.take(10):
            if isinstance(sample, Text):
                writer.write(Text(sample.data.upper()))
        await asyncio.sleep(0.01)


if __name__ == "__main__":
    asyncio.run({"ours": ours, "plain": plain}[sys.argv[1]](int(sys.argv[2])))
