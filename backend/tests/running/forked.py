"""A controller that is killed at many points: its devices and its operator are in another process, and live on.

It is the whole controller with its journal, and this process forks it, so that it needs no time to import and prepare
itself. Its network is a pipe, and it plans in its own process: nothing of it is left when it is killed. Real processes
on a real network are killed in `killing`, at fewer points.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import os
import random
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

import structlog

from running.judging import Judge, Kept
from running.wire import Wire
from sequence_planner.controller import planner_client
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import StartProduction
from sequence_planner.controller.commands.recovery import DecideOutputs
from sequence_planner.controller.commands.tasks import AcknowledgeTask
from sequence_planner.controller.previous_run import what_is_known
from sequence_planner.controller.views.station import StationIdentity
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.execution.events import Heard
from sequence_planner.execution.vocabulary import Production
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.portfolio.worker import Answer, Request
from sequence_planner.planning.problem import Contract, PlanRequest, WayBackRequest
from sequence_planner.planning.recovery_path import WaysBack
from sequence_planner.process.budget import Budget
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.simulation.devices import EmulatedDevices
from support.simulated import truck_engine

SPEED = 20.0  # of the devices
STEP, REPORT_EVERY = 0.01, 0.1  # seconds
UNTIL_KILLED = 0.6  # seconds after it has done some work, at most
PATIENCE = 240.0  # on a machine that is busy with much else
SHOW_EVERY = 2.0
LONGEST_STEP = 7200.0  # seconds by which the clock is stepped at most
IDENTITY = StationIdentity(name="truck", title="Truck", titles={}, description="", transport="memory", emulated=True)


@cache
def truck_engine_ways() -> WaysBack:
    """The ways back into the safe states of the truck engine station."""
    station, supervisor, _ = truck_engine()
    return WaysBack(station.automaton, supervisor.safe)


class NearPlanner:
    """Plans in a thread of this process; better plans, which take longer, it never finds."""

    trouble = None
    away = False

    def __init__(self, planner: Planner) -> None:
        self._planner = planner
        self._thread = ThreadPoolExecutor(1)

    async def ask(self, request: Request, seconds: float) -> Answer:
        loop = asyncio.get_running_loop()
        if isinstance(request, PlanRequest) and request.contract is Contract.MINIMAL:
            await loop.create_future()
        return await loop.run_in_executor(self._thread, self._answer, request)

    def _answer(self, request: Request) -> Answer:
        match request:
            case PlanRequest():
                return self._planner.answer(request)
            case WayBackRequest():
                return truck_engine_ways().answer(request, Budget.seconds(request.deadline))
            case DiagnosisRequest():
                return Diagnosis(None, ())

    def close(self) -> None:
        """There is nothing to end."""


class Child:
    """What a forked process does: it is a controller, with somebody in front of it who decides what is asked."""

    def __init__(self, url: str, line: socket.socket, seed: str) -> None:
        self._url, self._line, self._chance = url, line, random.Random(seed)
        self._rest = b""

    async def live(self) -> None:
        """Until it is killed."""
        station, supervisor, planner = truck_engine()
        loop, network, database = asyncio.get_running_loop(), MemoryNetwork(), Database.open(self._url)
        relay = network.join(station.registry, "emulated_devices", loop)
        for incoming in station.pipelines.incoming.values():
            relay.advertise(incoming.topic.name, incoming.topic.type_name, incoming.topic.quality)
        for outgoing in station.pipelines.outgoing.values():
            relay.subscribe(outgoing.topic.name, outgoing.topic.type_name, outgoing.topic.quality, self._commanded)
        self._relay = relay
        self._types = {name: each.topic.type_name for name, each in station.pipelines.incoming.items()}
        transport = network.join(station.registry, "sequence_planner", loop)
        with patch.object(planner_client, "planner_process", lambda automaton, supervisor: NearPlanner(planner)):
            controller = build_controller(
                IDENTITY, station, supervisor, transport, database, what_is_known(database, station.automaton)
            )
        controller.take_command()
        controller.execution.listeners.append(self._heard)
        if self._chance.random() < 0.3:
            loop.call_later(self._chance.uniform(0, UNTIL_KILLED), self._step_clock)
        self._controller = controller
        loop.add_reader(self._line, self._hear)
        await asyncio.gather(controller.run(), self._operate(), self._tell_durable(), self._show())

    def _step_clock(self) -> None:
        """Somebody sets the clock that people read."""
        real, step = time.time, self._chance.uniform(-LONGEST_STEP, LONGEST_STEP)
        time.time = lambda: real() + step
        self._say("seen", f"clock set {'forward' if step > 0 else 'back'}")

    def _say(self, *words: object) -> None:
        self._line.sendall(json.dumps(words).encode() + b"\n")

    def _commanded(self, samples: Sequence[Sample]) -> None:
        for sample in samples:
            self._say("commanded", sample.topic, sample.data.hex())

    def _heard(self, heard: Heard) -> None:
        if heard.outcome is not None and (heard.outcome.started or heard.outcome.ended):
            self._say("worked")

    def _hear(self) -> None:
        *lines, self._rest = (self._rest + self._line.recv(1 << 16)).split(b"\n")
        for line in lines:
            topic, data = json.loads(line)
            self._relay.publish(topic, self._types[topic], bytes.fromhex(data))

    async def _tell_durable(self) -> None:
        said = 0
        while True:
            if (durable := self._controller.records.writer.durable) != said:
                said = durable
                self._say("durable", said)
            await asyncio.sleep(0.002)

    async def _show(self) -> None:
        while True:
            await asyncio.sleep(SHOW_EVERY)
            view = self._controller.view()
            alarms = [f"{each.text} {each.action}" for each in view.alarms.values() if each.ended is None]
            self._say("shown", view.production, view.plan.status, view.plan.reason, list(view.undecided), alarms)

    async def _operate(self) -> None:
        """Decide on outputs, start production, and do what people are asked to do."""
        controller = self._controller
        while True:
            await asyncio.sleep(0.02)
            with contextlib.suppress(CommandRefused):
                if controller.execution.blind:
                    continue
                if controller.execution.production is Production.WAITING:
                    for name, each in controller.view().undecided.items():
                        value = self._chance.choice([each.value, *each.quiet])
                        decision = DecideOutputs(actor=SYSTEM, values={name: value}, reason="looked at")
                        await controller.command(decision)
                        self._say("seen", "outputs decided on")
                    await controller.command(StartProduction(actor=SYSTEM))
                else:
                    for id_, task in controller.view().tasks.items():
                        acknowledged = AcknowledgeTask(actor=SYSTEM, task=id_, revision=task.revision)
                        await controller.command(acknowledged)


class Hall:
    """The devices, which go on whatever becomes of their controller."""

    def __init__(self, folder: Path, seed: str) -> None:
        self._url = f"sqlite:///{folder}/station.sqlite"
        self._chance = random.Random(seed)
        self._seed = seed
        station, self._supervisor, _ = truck_engine()
        self._station = station
        self._devices = EmulatedDevices(station.automaton, station.pipelines, SPEED, self._chance.randrange(1000))
        self._wire = Wire(station)
        self._durable = 0
        self._shown: list[object] = []
        self.killed = True
        self.seen: Counter[str] = Counter()
        with contextlib.closing(Database.open(self._url)) as database:
            database.upgrade()
            self._kept = Kept(database)

    def child(self, line: socket.socket, number: int) -> Child:
        """What a life of the controller is."""
        return Child(self._url, line, f"{self._seed}.{number}")

    def heard(self, what: str, about: list[object]) -> None:
        """It has said something that nobody here knows of."""

    def goes_on(self, worked: bool) -> bool:
        """Whether it is not time to kill it, if it has `worked` by now."""
        return not worked

    def live(self, number: int, *, kill: bool = True) -> None:
        """One life of the controller. AssertionError when it does no work, or something is lost by its death."""
        self.killed = kill
        line, theirs = socket.socketpair()
        child = os.fork()
        if child == 0:
            line.close()
            _be_child(self.child(theirs, number))
        theirs.close()
        try:
            how = "after work" if not kill or self._chance.random() < 0.8 else "at any moment"
            self._go_on(line, how)
        finally:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
        self._take_rest(line)
        line.close()
        self.seen[f"controllers killed {how}"] += 1
        with contextlib.closing(Database.open(self._url)) as database:
            self._kept.database = database
            self._kept.look()
        assert self._kept.end.number >= self._durable, f"{self._durable} was durable, {self._kept.end.number} is there"

    def _go_on(self, line: socket.socket, how: str) -> None:
        """Let devices and controller work together until it is to be killed."""
        began = time.monotonic()
        end = None if how == "after work" else began + self._chance.uniform(0, UNTIL_KILLED)
        self._rest, said = b"", dict[str, tuple[float, bytes]]()
        while end is None or time.monotonic() < end:
            now = time.monotonic()
            truth = {name: self._devices.state[name] for name in self._devices.topics}
            assert end is not None or now - began < PATIENCE, f"nothing goes on: {truth} {self._shown}"
            self._devices.advance(now)
            for topic, pipeline in self._station.pipelines.incoming.items():
                message = self._devices.report(topic)
                data = self._station.registry.encode(pipeline.topic.type_name, message)
                due, last = said.get(topic, (0.0, b""))
                if data != last or now >= due:
                    said[topic] = now + REPORT_EVERY, data
                    line.sendall(json.dumps([topic, data.hex()]).encode() + b"\n")
            worked = self._take(line)
            if end is None and not self.goes_on(worked):
                end = time.monotonic() + self._chance.uniform(0, UNTIL_KILLED)

    def _take(self, line: socket.socket) -> bool:
        """What the controller says within a step; whether it has worked."""
        readable, _, _ = select.select([line], [], [], STEP)
        return bool(readable) and self._understand(line.recv(1 << 16))

    def _take_rest(self, line: socket.socket) -> None:
        """What it has said before it died."""
        with contextlib.suppress(ConnectionResetError):
            while data := line.recv(1 << 16):
                self._understand(data)

    def _understand(self, data: bytes) -> bool:
        assert data, "the controller has ended by itself"
        *lines, self._rest = (self._rest + data).split(b"\n")
        worked = False
        for each in lines:
            what, *about = json.loads(each)
            if what == "commanded":
                topic, command = about[0], bytes.fromhex(about[1])
                self._wire.take([Sample(topic, command, 0.0)])
                type_name = self._station.pipelines.outgoing[topic].topic.type_name
                assert not self._devices.command(topic, self._station.registry.decode(type_name, command))
            elif what == "durable":
                self._durable = max(self._durable, about[0])
            elif what == "shown":
                self._shown = about
            elif what == "seen":
                self.seen[about[0]] += 1
            else:
                self.heard(what, about)
            worked = worked or what == "worked"
        return worked

    def judged(self) -> Counter[str]:
        """All that was met; AssertionError when the journal and the devices say otherwise than they should."""
        judge = Judge(self._station.automaton, self._supervisor)
        with contextlib.closing(Database.open(self._url)) as database:
            judge.judge(database)
        for topic, heard in self._wire.heard.items():
            judge.require_decided(topic, heard)
            self.seen["commands heard by devices"] += len(heard)
        self.seen["records"] += self._kept.end.number
        self.seen["starts"] += judge.starts.total()
        return self.seen


def _be_child(child: Child) -> None:
    try:
        asyncio.run(child.live())
    except BaseException:
        logging.exception("the controller failed")
    finally:
        os._exit(1)


def lives(seed: str, kills: int) -> Counter[str]:
    """So many lives of a controller, and one that lives on. AssertionError when one of them is not as it should be."""
    with tempfile.TemporaryDirectory() as folder:
        hall = Hall(Path(folder), seed)
        for number in range(kills):
            hall.live(number)
        hall.live(kills, kill=False)
        return hall.judged()


def apart(seed: str, kills: int, what: str = "running.forked") -> Counter[str]:
    """The same in a process of its own, which has no threads and can be forked; `what` is the module of the lives."""
    done = subprocess.run(
        [sys.executable, "-m", what, seed, str(kills)],
        env={**os.environ, "PYTHONPATH": ":".join(sys.path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-4000:]
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return Counter(found)


def log_to_standard_error() -> None:
    """Standard output is for what was found."""
    structlog.configure(
        wrapper_class=structlog.make_filtering_bound_logger(logging.WARNING),
        logger_factory=structlog.PrintLoggerFactory(sys.stderr),
    )


if __name__ == "__main__":
    log_to_standard_error()
    sys.stdout.write(json.dumps(lives(sys.argv[1], int(sys.argv[2]))) + "\n")
