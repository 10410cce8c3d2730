"""A peer in a process of its own: what it hears on /ping it says on /pong in capitals, until its input ends.

    python ros_peer.py ours|device|plain|route|stream DOMAIN

`ours` speaks through the station's transport. `device` does too, shows that it is alive twice a second, and serves
/add and the action /fibonacci. `plain` shares no code with it: a program written with cyclonedds as its
manual teaches, which knows ROS 2's names and leaves the bytes to cyclonedds' own codec.
`route` is such a program too, and publishes on /route a type that no file of a station defines.
`stream` publishes on twenty topics a hundred times a second, once all of them are subscribed to; it is held up now
and then, and catches up.
"""

import asyncio
import sys
from collections.abc import Sequence
from dataclasses import dataclass

from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, make_idl_struct, types
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from sequence_planner.ros.actions import ActionServer, GoalOutcome, GoalStatus, GoalWork
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry

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


ADD, FIBONACCI = "example_interfaces/srv/AddTwoInts", "example_interfaces/action/Fibonacci"


async def device(domain: int) -> None:
    registry = MessageRegistry.from_folder(None)
    transport = open_transport("cyclonedds", registry, "device", asyncio.get_running_loop(), domain)

    def answer(batch: Sequence[Sample]) -> None:
        for sample in batch:
            transport.publish("/pong", TEXT, sample.data)

    async def add(request: bytes) -> bytes:
        numbers = registry.decode(f"{ADD}_Request", request)
        return registry.encode(f"{ADD}_Response", {"sum": int(str(numbers["a"])) + int(str(numbers["b"]))})

    async def wait(work: GoalWork) -> GoalOutcome:
        await work.cancel_wanted.wait()
        return GoalOutcome(GoalStatus.CANCELED, {"sequence": [1]})

    transport.serve("/add", ADD, add)
    server = ActionServer(transport, registry, "/fibonacci", FIBONACCI, wait)
    transport.advertise("/pong", TEXT, QualityOfService(liveliness=0.5))
    transport.subscribe("/ping", TEXT, QualityOfService.RELIABLE, answer)
    await until_input_ends()
    server.close()
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


# Messages of the plant's own, with fields of every shape.
POINT = make_idl_struct("Point", "plant_msgs.msg.dds_.Point_", {"x": types.float64, "level": types.uint8})
ROUTE = make_idl_struct(
    "Route",
    "plant_msgs.msg.dds_.Route_",
    {
        "name": types.bounded_str[8],
        "points": types.sequence[POINT],
        "codes": types.array[types.uint16, 2],
        "labels": types.sequence[str, 3],
        "closed": bool,
    },
)


async def route(domain: int) -> None:
    participant = DomainParticipant(domain)
    policies = (Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.TransientLocal)
    writer = DataWriter(participant, Topic(participant, "rt/route", ROUTE), Qos(*policies, Policy.History.KeepLast(1)))
    points = [POINT(x=1.5, level=200)]
    writer.write(ROUTE(name="nuts", points=points, codes=[1, 65535], labels=["a", "b"], closed=True))
    await until_input_ends()


STREAMED, ROUNDS, HELD_UP = [f"/device_{number}/state" for number in range(20)], 300, 30


async def stream(domain: int) -> None:
    registry, loop = MessageRegistry.from_folder(None), asyncio.get_running_loop()
    transport = open_transport("cyclonedds", registry, "device", loop, domain)
    for topic in STREAMED:
        transport.advertise(topic, TEXT, QualityOfService(depth=1000))
    ended = asyncio.create_task(until_input_ends())

    def subscribed() -> set[str]:
        return {each.topic for each in transport.graph() if each.direction == "subscriber"}

    while not subscribed() >= set(STREAMED):  # noqa: ASYNC110 - nobody tells of that
        await asyncio.sleep(0.1)
    begun = loop.time() + 0.5  # The others know of us a little later.
    for number in range(ROUNDS):
        if number % HELD_UP == 0:
            await asyncio.sleep(begun + number / 100 - loop.time())
        for topic in STREAMED:
            transport.publish(topic, TEXT, registry.encode(TEXT, {"data": str(number)}))
    await ended
    transport.close()


KINDS = {"ours": ours, "device": device, "plain": plain, "route": route, "stream": stream}

if __name__ == "__main__":
    asyncio.run(KINDS[sys.argv[1]](int(sys.argv[2])))
