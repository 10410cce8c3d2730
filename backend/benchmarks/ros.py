"""Messages through real DDS: how long an answer takes, how many messages a controller can hear, and what it keeps.

Run with `make bench`. The controller is a process with the whole truck engine station and more devices beside, 21
topics to hear; this process is all of its devices. A round trip is a message, the tick that it causes, and the command
that follows; beside it, in turns, a process answers that does nothing but DDS. Latencies are times on the wall, all
else is CPU time of the controller's process.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import random
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from compared.message_peer import BARE_ANSWERED, BARE_ASKED
from compared.message_station import ANSWERED, ASKED, NUMBER, NUMBERS, reports, write_station

from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, Transport
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.simulation.manual_interface import NODE
from sequence_planner.station import ReadyStation, prepare_station

STATION = Path(__file__).parents[2] / "models" / "truck_engine_station"
PEER = Path(__file__).parent / "compared" / "message_peer.py"
DOMAIN = 1 + (os.getpid() + 25) % 100
ROUNDS = 1000
RATE = 100  # messages per second and topic
SECONDS = 10  # of hearing all topics
MANY = 100_000
LEISURE = 20  # messages of each topic, before all have been heard
VIEWED = 2.0  # seconds after which what was heard is seen
PATIENCE = 120.0  # seconds


def main() -> None:
    """Measure and print."""
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    with tempfile.TemporaryDirectory(prefix="messages-") as folder:
        model = Path(folder) / "station"
        write_station(STATION, model)
        station = prepare_station(model)
        asyncio.run(measure(station, model, Path(folder)))


class Peers:
    """The processes that answer, and this one's way to them; `async with` ends them."""

    def __init__(self, station: ReadyStation, model: Path, folder: Path) -> None:
        self._station = station
        self._socket = folder / "controller.socket"
        self._environment = {**os.environ, "PYTHONPATH": str(PEER.parents[1])}
        self._arguments = (["echo", str(model)], ["controller", str(model), str(self._socket)])
        self._answers: dict[str, asyncio.Future[bytes]] = {}

    async def __aenter__(self) -> Peers:
        pipe = asyncio.subprocess.PIPE
        self._processes = [
            await asyncio.create_subprocess_exec(
                *(sys.executable, str(PEER), *arguments),
                env=self._environment,
                stdin=pipe,
                stdout=pipe,
                stderr=asyncio.subprocess.DEVNULL,
            )
            for arguments in self._arguments
        ]
        loop = asyncio.get_running_loop()
        self.transport: Transport = open_transport("cyclonedds", self._station.registry, NODE, loop)
        for incoming in self._station.pipelines.incoming.values():
            self.transport.advertise(incoming.topic.name, incoming.topic.type_name, incoming.topic.quality)
        for outgoing in self._station.pipelines.outgoing.values():
            self.transport.subscribe(outgoing.topic.name, outgoing.topic.type_name, outgoing.topic.quality, self._hear)
        self.transport.advertise(BARE_ASKED, NUMBER, QualityOfService.RELIABLE)
        self.transport.subscribe(BARE_ANSWERED, NUMBER, QualityOfService.RELIABLE, self._hear)
        self.client = ControllerClient(self._socket)
        self._looking = asyncio.create_task(self.client.run())
        return self

    async def __aexit__(self, *error: object) -> None:
        self._looking.cancel()
        await asyncio.gather(self._looking, return_exceptions=True)
        self.transport.close()
        for process in self._processes:
            with contextlib.suppress(ProcessLookupError):  # it may have ended by itself
                process.terminate()
            await process.wait()

    async def started(self) -> None:
        """Wait until the controller has started production."""
        await until(lambda: self.client.view is not None and self.client.view.production == "started")

    def _hear(self, samples: Sequence[Sample]) -> None:
        for sample in samples:
            answer = self._answers.get(sample.topic)
            if answer is not None and not answer.done():
                answer.set_result(sample.data)

    async def round_trip(self, asked: str, answered: str, number: int) -> float:
        """Seconds until the number comes back."""
        registry = self._station.registry
        began = time.perf_counter()
        self._answers[answered] = asyncio.get_running_loop().create_future()
        self.transport.publish(asked, NUMBER, registry.encode(NUMBER, {"number": number}))
        while True:
            answer = await asyncio.wait_for(self._answers[answered], PATIENCE)
            if registry.decode(NUMBER, answer)["number"] == number:
                break
            self._answers[answered] = asyncio.get_running_loop().create_future()
        return time.perf_counter() - began

    def heard(self) -> int:
        """How many messages of the devices the controller has heard."""
        view = self.client.view
        assert view is not None
        return sum(topic.messages for name, topic in view.topics.items() if topic.direction == "in" and name != ASKED)

    async def until_heard(self, many: int) -> None:
        """Wait until the controller has heard so many messages in all."""
        await until(lambda: self.heard() >= many)

    def cpu(self) -> float:
        """CPU seconds that the controller's process has used so far."""
        fields = Path(f"/proc/{self._processes[1].pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    async def memory(self) -> tuple[int, int]:
        """The controller's memory in kB: resident, and allocated by Python."""
        stdin, stdout = self._processes[1].stdin, self._processes[1].stdout
        assert stdin is not None
        assert stdout is not None
        stdin.write(b"\n")
        resident, allocated = json.loads(await stdout.readline())
        return resident, allocated // 1024


async def until(what: Callable[[], bool]) -> None:
    """Wait until it is true; raises TimeoutError."""
    async with asyncio.timeout(PATIENCE):
        while True:
            if what():
                return
            await asyncio.sleep(0.05)


async def measure(station: ReadyStation, model: Path, folder: Path) -> None:
    """Latencies while nothing else is said, the load of all topics, latencies beside it, and memory."""
    said = reports(station, 100)
    async with Peers(station, model, folder) as peers:
        await peers.started()
        await latencies(peers, "all topics silent")
        await measure_load(station, peers, said)
        saying = asyncio.create_task(say(station, peers, said, RATE * PATIENCE, RATE))
        await latencies(peers, f"{len(said)} topics at {RATE} Hz")
        saying.cancel()
        await asyncio.sleep(VIEWED)
        await measure_memory(station, peers, said)


async def measure_load(station: ReadyStation, peers: Peers, said: Mapping[str, Sequence[bytes]]) -> None:
    """What of a core the controller uses to hear all topics, and whether it hears every message."""
    before, began, cpu = peers.heard(), time.perf_counter(), peers.cpu()
    sent = await say(station, peers, said, RATE * SECONDS, RATE)
    load = (peers.cpu() - cpu) / (time.perf_counter() - began)
    await asyncio.sleep(VIEWED)
    print(f"{len(said)} topics at {RATE} Hz: {sent} sent, {peers.heard() - before} heard, {load:.2f} of a core")


async def latencies(peers: Peers, beside: str) -> None:
    """Round trips of both peers in turns, at random times."""
    drawn = random.Random(0)
    taken: dict[str, list[float]] = {"bare DDS": [], "controller": []}
    for number in range(ROUNDS):
        asked = (number + 1) % NUMBERS
        taken["bare DDS"].append(await peers.round_trip(BARE_ASKED, BARE_ANSWERED, asked))
        await asyncio.sleep(drawn.uniform(0, 0.01))
        taken["controller"].append(await peers.round_trip(ASKED, ANSWERED, asked))
        await asyncio.sleep(drawn.uniform(0, 0.01))
    for peer, seconds in taken.items():
        median, last = statistics.median(seconds) * 1e3, statistics.quantiles(seconds, n=100)[98] * 1e3
        print(f"{beside}, {peer}: median {median:.2f} ms, 99th percentile {last:.2f} ms")


async def say(
    station: ReadyStation, peers: Peers, said: Mapping[str, Sequence[bytes]], times: float, rate: float
) -> int:
    """Let every topic speak so many times, one after the other in even steps; returns how many messages there were."""
    types = {name: pipeline.topic.type_name for name, pipeline in station.pipelines.incoming.items()}
    began, sent = time.perf_counter(), 0
    for number in range(int(times)):
        for place, (topic, messages) in enumerate(said.items()):
            due = began + (number + place / len(said)) / rate
            if (wait := due - time.perf_counter()) > 0:
                await asyncio.sleep(wait)
            peers.transport.publish(topic, types[topic], messages[number % len(messages)])
            sent += 1
    return sent


async def measure_memory(station: ReadyStation, peers: Peers, said: Mapping[str, Sequence[bytes]]) -> None:
    """The controller's memory while it hears many messages, after a tenth as many."""
    await peers.memory()  # from here on Python's blocks are counted, which makes everything slower
    before, heard = peers.heard(), 0
    for many in (MANY // 10, MANY // 2, MANY - MANY // 2):
        goal = peers.heard() + many
        while peers.heard() < goal:
            await say(station, peers, said, LEISURE, RATE)
            heard += LEISURE * len(said)
            await peers.until_heard(before + heard)
        resident, allocated = await peers.memory()
        print(f"{heard:6} messages heard: {resident / 1024:.1f} MiB resident, {allocated} kB allocated by Python")


if __name__ == "__main__":
    main()
