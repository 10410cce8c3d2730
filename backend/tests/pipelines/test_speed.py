"""What pipelines cost while a station runs: processor time, and memory that does not grow."""

from __future__ import annotations

import gc
import time
import tracemalloc
from statistics import median

import pytest

from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.ros.transport import Sample
from sequence_planner.station import ReadyStation
from support.examples import ONLY_TIMED

from .station_writing import station_with

TOPICS, RATE = 20, 100  # messages a second on each
STATE = "tank_msgs/msg/State"
FIELDS = {"State": "std_msgs/Header header\nfloat64[6] joints\nfloat64 speed\nuint8 mode\nbool moving\n"}
ENUMERATIONS = "poses: [between, home, left, right]\nsaved_poses: [home, left, right]\nmodes: [idle, busy, failed]"


def topic(number: int) -> str:
    return f"""
  /state_{number}:
    type: {STATE}
    direction: in
    deadline: 5.0
    ignore: [moving]
    pipeline:
      - discretise:
          field: joints
          variable: pose_{number}
          tolerance: 0.02
          otherwise: between
          values:
            home: [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]
            left: [0.6, -1.2, 1.4, -1.77, -1.57, 0.6]
            right: [0.45, -0.95, 1.55, -2.17, -1.57, 0.45]
      - remember: {{variable: last_{number}, of: pose_{number}, except: [between]}}
      - expression: {{fast_{number}: speed > 0.25 and moving}}
      - map: {{field: mode, variable: mode_{number}, values: {{0: idle, 1: busy, 2: failed}}}}
"""


def flow(number: int) -> str:
    one, other = f"/state_{number}", f"/state_{(number + 1) % TOPICS}"
    stage = f"expression: {{both_{number}: one.moving and other.moving}}"
    return f"  both_{number}: {{from: {{one: {one}, other: {other}}}, pipeline: [{stage}]}}\n"


def variables(number: int) -> str:
    return (
        f"  pose_{number}: {{type: poses}}\n  last_{number}: {{type: saved_poses}}\n  fast_{number}: {{type: bool}}\n"
        f"  mode_{number}: {{type: modes}}\n  both_{number}: {{type: bool}}\n"
    )


@pytest.fixture(scope="module")
def station(tmp_path_factory: pytest.TempPathFactory) -> ReadyStation:
    numbers = range(TOPICS)
    parts = (
        "topics:",
        *map(topic, numbers),
        "flows:\n",
        *map(flow, numbers),
        "measured:\n",
        *map(variables, numbers),
    )
    return station_with(tmp_path_factory.mktemp("station"), "".join(parts), FIELDS, ENUMERATIONS)


def a_second(station: ReadyStation, second: int) -> list[Sample]:
    """What comes in a second; no message says what the one before said."""
    samples = []
    for number in range(RATE):
        message = {
            "header": {"stamp": {"sec": number}},
            "joints": [0.001 * (number % 40), -1.57, 1.57, -1.57, -1.57, 0.0],
            "speed": number / RATE,
            "mode": number % 3,
            "moving": number % 2 == 1,
        }
        data = station.registry.encode(STATE, message)
        samples += [Sample(f"/state_{each}", data, second + number / RATE) for each in range(TOPICS)]
    return samples


def take(feeds: Inputs, samples: list[Sample]) -> None:
    """As the controller does it when every message comes alone."""
    for sample in samples:
        feeds.take([sample])
        feeds.wake(sample.received)
        feeds.measured(sample.received)


@ONLY_TIMED
def test_twenty_topics_at_a_hundred_messages_a_second_take_less_than_half_a_core(station: ReadyStation) -> None:
    feeds = Inputs(station.pipelines, station.registry)
    taken = []
    for second in range(5):
        samples = a_second(station, second)
        began = time.process_time()
        take(feeds, samples)
        taken.append(time.process_time() - began)
    assert median(taken) < 0.5
    assert feeds.observed()["/state_7"].edges[-1].records == 5 * RATE


def test_memory_does_not_grow_with_the_messages(station: ReadyStation) -> None:
    feeds = Inputs(station.pipelines, station.registry)
    take(feeds, a_second(station, 0))
    gc.collect()
    tracemalloc.start()
    try:
        before, _ = tracemalloc.get_traced_memory()
        for second in range(1, 6):
            take(feeds, a_second(station, second))
        gc.collect()
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert after - before < 200_000
