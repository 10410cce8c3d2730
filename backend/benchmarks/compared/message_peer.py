"""A process that answers messages, until its input ends: `message_peer.py echo | controller FOLDER SOCKET`.

`echo` is DDS and nothing else: a thread sleeps until there is a sample and writes it on the other topic. `controller`
is the station's own, whole; for each line of input it prints its memory as JSON: kB that are resident, and bytes that
Python has allocated since the first line and not freed.
"""

from __future__ import annotations

import asyncio
import json
import sys
import tracemalloc
from pathlib import Path

from compared.message_station import NUMBER
from cyclonedds.core import InstanceState, ReadCondition, SampleState, ViewState, WaitSet
from cyclonedds.internal import InvalidSample
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from sequence_planner.controller.service import Running, control
from sequence_planner.core.logging import configure_logs
from sequence_planner.ros import environment, names
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Transport
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.transports.cyclonedds_discovery import endpoint_qos
from sequence_planner.ros.transports.cyclonedds_network import join, raw_types
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.station import prepare_station

BARE_ASKED, BARE_ANSWERED = "/bare/asked", "/bare/answered"


def echo(folder: Path) -> None:
    """Answer with the same bytes, on DDS alone."""
    registry = MessageRegistry.from_folder(folder / "messages")
    raw = raw_types(registry)(NUMBER)
    _domain, participant = join(environment.domain_id(None), environment.discovery_range())
    qos = endpoint_qos(QualityOfService.RELIABLE, names.type_hash_user_data(registry.type_hash(NUMBER)))
    reader = DataReader(participant, Topic(participant, names.dds_topic(BARE_ASKED), raw), qos)
    writer = DataWriter(participant, Topic(participant, names.dds_topic(BARE_ANSWERED), raw), qos)
    waiting = WaitSet(participant)
    waiting.attach(ReadCondition(reader, ViewState.Any | InstanceState.Any | SampleState.NotRead))
    while True:
        waiting.wait(duration(infinite=True))
        for sample in reader.take(100):
            if not isinstance(sample, InvalidSample):
                writer.write(raw(sample.data))


async def controller(folder: Path, socket: Path) -> None:
    """Run the controller, and start production as soon as the devices are there."""
    configure_logs()
    station = prepare_station(folder)
    loop = asyncio.get_running_loop()

    def connect(node: str) -> Transport:
        return open_transport("cyclonedds", station.registry, node, loop)

    asking = asyncio.create_task(_tell_memory())
    database = f"sqlite:///{socket.parent}/station.sqlite"
    running = Running(station, folder, socket, connect, emulated=True, start=True, database=database)
    living = asyncio.create_task(control(running))
    await asyncio.wait({asking, living}, return_when=asyncio.FIRST_COMPLETED)
    living.cancel()
    await asyncio.gather(living, return_exceptions=True)


async def _tell_memory() -> None:
    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
    while await reader.readline():
        if not tracemalloc.is_tracing():
            tracemalloc.start()
        print(json.dumps([_resident(), tracemalloc.get_traced_memory()[0]]), flush=True)


def _resident() -> int:
    """The process's memory in kB."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    (resident,) = [line.split()[1] for line in status.splitlines() if line.startswith("VmRSS")]
    return int(resident)


if __name__ == "__main__":
    if sys.argv[1] == "echo":
        echo(Path(sys.argv[2]))
    else:
        asyncio.run(controller(Path(sys.argv[2]), Path(sys.argv[3])))
