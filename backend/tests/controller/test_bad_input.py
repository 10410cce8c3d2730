"""What devices can do wrong, through real DDS: reported once for each cause, and the controller ticks on.

Cyclone sends no bytes that are not of the type, so those come over the network inside the process.
"""

from __future__ import annotations

import asyncio
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path

import pytest

from controller.mixing import Plant, alarms, play, value
from controller.tank_talker import TOPIC, TYPE
from pipelines.station_writing import write_station
from sequence_planner.controller.controller import Controller
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Transport
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.network import DOMAIN
from support.waiting import until_async

TANK = """\
topics:
  /tank/state:
    type: tank_msgs/msg/State
    direction: in
    deadline: 5.0
    quality: QUALITY
    ignore: [count]
    pipeline:
      - discretise: {field: level, variable: fill, ranges: {low: [null, 1.0], high: [1.0, null]}}
measured:
  mode: {type: mode}
  fill: {type: filling}
"""
STATE = "string mode\nfloat64 level\nuint32 count\n"
ENUMERATIONS = "mode: ['on', 'off']\nfilling: [low, high]"
LONGEST_WORK = 0.25  # seconds of its own time for which the controller may hold its event loop
LONGEST_GAP = 2.0  # seconds for which that may be away on a busy computer


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_station(
        tmp_path_factory.mktemp("tank"), TANK.replace("QUALITY", "reliable"), {"State": STATE}, ENUMERATIONS
    )


@cache
def ready(folder: Path) -> ReadyStation:
    return prepare_station(folder)


class Gaps:
    """How long the event loop of the controller was away at most, and how much of that it worked."""

    def __init__(self) -> None:
        self.longest = self.work = 0.0
        self.task = asyncio.create_task(self._watch())

    async def _watch(self) -> None:
        last, worked = time.monotonic(), time.thread_time()
        while True:
            await asyncio.sleep(0.002)
            now, work = time.monotonic(), time.thread_time()
            self.longest, last = max(self.longest, now - last), now
            self.work, worked = max(self.work, work - worked), work


class Tank:
    """A publisher of the tank's state."""

    def __init__(self, plant: Plant, type_name: str = TYPE) -> None:
        self.transport: Transport = plant.join("tank")
        self.transport.advertise(TOPIC, type_name, QualityOfService.RELIABLE)
        self._encode = plant.station.registry.encode

    def say(self, mode: str = "on", level: float = 0.5) -> None:
        self.send(self._encode(TYPE, {"mode": mode, "level": level}))

    def send(self, data: bytes) -> None:
        self.transport.publish(TOPIC, TYPE, data)


def run(folder: Path, scenario: Callable[[Plant, Controller], Awaitable[None]], kind: str = "cyclonedds") -> None:
    station = ready(folder)
    supervisor = synthesise(station.automaton)

    async def watched(plant: Plant) -> None:
        controller = plant.controller(supervisor)
        gaps = Gaps()
        await scenario(plant, controller)
        gaps.task.cancel()
        assert gaps.work < LONGEST_WORK
        assert gaps.longest < LONGEST_GAP

    play(kind, watched, station)


def state(controller: Controller) -> tuple[object, object]:
    return value(controller, "tank.mode"), value(controller, "tank.fill")


def of_tank(controller: Controller) -> list[str]:
    return [text for text in alarms(controller) if TOPIC in text]


@asynccontextmanager
async def talker(folder: Path, rate: float, quality: Mapping[str, object]) -> AsyncIterator[asyncio.subprocess.Process]:
    script = Path(__file__).with_name("tank_talker.py")
    command = [sys.executable, str(script), str(folder / "messages"), str(DOMAIN), str(rate), json.dumps(quality)]
    process = await asyncio.create_subprocess_exec(*command, env=os.environ, stdout=subprocess.DEVNULL)
    try:
        yield process
    finally:
        if process.returncode is None:
            process.kill()
        await process.wait()


async def heard(tank: Tank, controller: Controller) -> None:
    """Speak until the controller hears it."""

    def known() -> bool:
        tank.say()
        return state(controller) == ("on", "low")

    await until_async(known, "it is heard")


def test_another_type_on_a_topic(folder: Path) -> None:
    async def scenario(plant: Plant, controller: Controller) -> None:
        Tank(plant, "std_msgs/msg/String")
        await until_async(lambda: any("std_msgs/msg/String" in text for text in of_tank(controller)), "it is reported")
        assert state(controller) == (None, None)

    run(folder, scenario)


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (b"\x00\x01\x00\x00", "memory"),
        (b"", "memory"),
        (b"\x00\x01\x00\x00\xff\xff\xff\xff" + b"a" * 40, "memory"),
        (b"\x00\x01\x00\x00\x03\x00\x00\x00\xff\xfe\x00" + b"\x00" * 17, "cyclonedds"),
    ],
    ids=["truncated", "empty", "longer than everything", "no text"],
)
def test_a_payload_that_is_no_message(folder: Path, data: bytes, kind: str) -> None:
    async def scenario(plant: Plant, controller: Controller) -> None:
        tank = Tank(plant)
        await heard(tank, controller)
        for _ in range(3):
            tank.send(data)
        await until_async(lambda: state(controller) == (None, None), "it is unknown")
        await until_async(lambda: any("(3 times, first at " in text for text in of_tank(controller)), "it is counted")
        (text,) = of_tank(controller)
        assert TYPE in text
        await heard(tank, controller)

    run(folder, scenario, kind)


@pytest.mark.parametrize(
    ("mode", "level", "known", "told"),
    [
        ("on", math.nan, ("on", None), "level"),
        ("on", math.inf, ("on", None), "level"),
        ("on", -math.inf, ("on", None), "level"),
        ("half", 0.5, (None, "low"), "mode is 'half'"),
    ],
    ids=["not a number", "infinite", "minus infinite", "a value nobody declared"],
)
def test_a_value_that_means_nothing(
    folder: Path, mode: str, level: float, known: tuple[object, object], told: str
) -> None:
    async def scenario(plant: Plant, controller: Controller) -> None:
        tank = Tank(plant)
        await heard(tank, controller)
        for _ in range(3):
            tank.say(mode, level)
        await until_async(lambda: state(controller) == known, "what means nothing is unknown")
        await until_async(lambda: any("(3 times, first at " in text for text in of_tank(controller)), "it is counted")
        (text,) = of_tank(controller)
        assert told in text
        await heard(tank, controller)

    run(folder, scenario)


def test_a_publisher_that_is_started_anew(folder: Path) -> None:
    async def scenario(plant: Plant, controller: Controller) -> None:
        tank = Tank(plant)
        await heard(tank, controller)
        tank.transport.close()
        await until_async(lambda: state(controller) == (None, None), "it is unknown without a publisher")
        assert of_tank(controller) == [f"No more messages on {TOPIC} (its publishers have gone)"]
        await heard(Tank(plant), controller)
        assert of_tank(controller) == []

    run(folder, scenario)


def test_a_flood(folder: Path) -> None:
    async def scenario(plant: Plant, controller: Controller) -> None:
        feed = controller.devices.feeds.topics[TOPIC]
        async with talker(folder, 10_000, {}):
            await until_async(lambda: feed.messages > 5_000, "the flood is heard")
            seen = controller.execution.ticks
            await until_async(lambda: controller.execution.ticks > seen + 10, "the controller ticks on")
        tank = Tank(plant)
        await heard(tank, controller)
        tank.say("off")
        asked = time.monotonic()
        await until_async(lambda: value(controller, "tank.mode") == "off", "what comes after the flood is heard")
        assert time.monotonic() - asked < 2.0

    run(folder, scenario)


@pytest.mark.parametrize(
    ("policy", "seconds"), [("deadline", 0.3), ("liveliness", 0.5)], ids=["deadline", "liveliness"]
)
def test_a_quality_of_service_that_is_not_kept(tmp_path: Path, policy: str, seconds: float) -> None:
    quality = {policy: seconds}
    written = TANK.replace("QUALITY", json.dumps(quality).replace('"', ""))
    own = write_station(tmp_path, written, {"State": STATE}, ENUMERATIONS)

    async def scenario(plant: Plant, controller: Controller) -> None:
        async with talker(own, 100, quality) as process:
            await until_async(lambda: value(controller, "tank.mode") == "on", "it is heard")
            process.kill()
            killed = time.monotonic()
            await until_async(lambda: state(controller) == (None, None), "the promise is broken")
            assert time.monotonic() - killed < 4.0  # of the topic's own deadline, 5 s, and DDS's lease, 10 s
            (text,) = of_tank(controller)
            assert text.startswith(f"No more messages on {TOPIC} (")
        async with talker(own, 100, quality):
            await until_async(lambda: value(controller, "tank.mode") == "on", "it is heard again")

    run(own, scenario)
