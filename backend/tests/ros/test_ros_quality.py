"""Qualities of service: how they are written, what two sides must agree on, and who is told when they do not."""

from __future__ import annotations

import asyncio
import importlib.util
import time
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ros_networks import Network, play, settle, standard

from sequence_planner.ros.qos import QualityEvent, QualityOfService, disagreements
from sequence_planner.ros.transport import Sample
from support.examples import examples
from support.waiting import until_async

NO_RCLPY = pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None,
    reason="rclpy is not importable here: run this suite where ROS 2 Jazzy is installed",
)
KINDS = ["memory", "cyclonedds", pytest.param("rclpy", marks=NO_RCLPY)]
TEXT = "std_msgs/msg/String"
HELLO = standard().encode(TEXT, {"data": "hello"})


def test_names_are_those_of_ros2() -> None:
    assert QualityOfService.of("reliable") == QualityOfService(True, False, 10)
    assert QualityOfService.of("sensor_data") == QualityOfService(False, False, 5)
    assert QualityOfService.of("latched") == QualityOfService(True, True, 1)
    assert [str(QualityOfService.of(name)) for name in ("reliable", "sensor_data", "latched")] == [
        "reliable",
        "sensor_data",
        "latched",
    ]


def test_a_mapping_gives_every_part() -> None:
    written = {
        "reliability": "best_effort",
        "durability": "transient_local",
        "depth": 3,
        "deadline": 0.5,
        "liveliness": 2,
    }
    quality = QualityOfService.of(written)
    assert quality == QualityOfService(False, True, 3, 0.5, 2.0)
    assert str(quality) == (
        "{reliability: best_effort, durability: transient_local, depth: 3, deadline: 0.5, liveliness: 2}"
    )
    assert QualityOfService.of({}) == QualityOfService.RELIABLE


@pytest.mark.parametrize(
    ("written", "text"),
    [
        ("best", "'best' is not a quality of service: write one of reliable, sensor_data, latched"),
        ({"reliable": True}, "has no 'reliable': it has reliability, durability"),
        ({"reliability": "maybe"}, "reliability is 'maybe': write reliable or best_effort"),
        ({"durability": 1}, "durability is 1: write volatile or transient_local"),
        ({"depth": 0}, "depth is 0"),
        ({"depth": True}, "depth is True"),
        ({"deadline": 0}, "deadline is 0: write a time in seconds, at least 0.001"),
        ({"liveliness": float("nan")}, "liveliness is nan"),
        ({"deadline": "1 s"}, "deadline is '1 s'"),
    ],
)
def test_a_quality_that_cannot_be_is_refused(written: str | dict[str, object], text: str) -> None:
    with pytest.raises(ValueError, match=text.split(":", maxsplit=1)[0]) as caught:
        QualityOfService.of(written)
    assert text in str(caught.value)


TIMES = st.none() | st.sampled_from([0.1, 1.0, 2.0])
QUALITIES = st.builds(QualityOfService, st.booleans(), st.booleans(), st.integers(1, 5), TIMES, TIMES)


@given(QUALITIES, QUALITIES)
@examples(200)
def test_agreeing_is_an_order(offered: QualityOfService, wanted: QualityOfService) -> None:
    assert disagreements(offered, offered) == []
    best = QualityOfService(True, True, 1, 0.1, 0.1)
    least = QualityOfService(False, False, 1, None, None)
    assert disagreements(best, wanted) == disagreements(offered, least) == []
    if not disagreements(offered, wanted) and not disagreements(wanted, offered):
        same = [(q.reliable, q.transient_local, q.deadline, q.liveliness) for q in (offered, wanted)]
        assert same[0] == same[1]


def kinds_of(events: list[QualityEvent], direction: Literal["publisher", "subscriber"]) -> list[tuple[str, int]]:
    return [(event.kind, event.count) for event in events if event.direction == direction]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("offered", "wanted", "text"),
    [
        (
            {"reliability": "best_effort"},
            {},
            "reliability: the publisher offers best_effort, the subscriber wants reliable",
        ),
        ({}, {"durability": "transient_local"}, "durability: the publisher offers volatile"),
        ({"deadline": 2}, {"deadline": 1}, "deadline: the publisher offers 2 s, the subscriber wants 1 s"),
        ({}, {"liveliness": 1}, "liveliness: the publisher offers none, the subscriber wants 1 s"),
    ],
    ids=["reliability", "durability", "deadline", "liveliness"],
)
def test_both_sides_are_told_that_they_do_not_agree(
    kind: str, offered: dict[str, object], wanted: dict[str, object], text: str
) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        of_device, of_station = list[QualityEvent](), list[QualityEvent]()
        heard: list[Sample] = []
        device.watch(of_device.append)
        station.watch(of_station.append)
        device.advertise("/tool/state", TEXT, QualityOfService.of(offered))
        station.subscribe("/tool/state", TEXT, QualityOfService.of(wanted), heard.extend)
        await until_async(lambda: of_device and of_station, "both are told")
        device.publish("/tool/state", TEXT, HELLO)
        await settle()
        assert heard == []
        assert kinds_of(of_device, "publisher") == kinds_of(of_station, "subscriber") == [("incompatible", 1)]
        assert of_device[0].topic == "/tool/state"
        assert of_device[0].text.startswith("/tool/state: ")
        assert text in of_device[0].text
        assert text in of_station[0].text

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_deadline_that_is_missed_is_told_to_both_sides(kind: str) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        of_device, of_station = list[QualityEvent](), list[QualityEvent]()
        heard: list[Sample] = []
        device.watch(of_device.append)
        station.watch(of_station.append)
        quality = QualityOfService.of({"deadline": 0.2})
        device.advertise("/tool/state", TEXT, quality)
        station.subscribe("/tool/state", TEXT, quality, heard.extend)
        await until_async(lambda: len(station.graph()) >= 2, "the publisher is seen")

        def arrives() -> bool:
            device.publish("/tool/state", TEXT, HELLO)
            return bool(heard)

        await until_async(arrives, "a sample arrives")
        of_device.clear()
        of_station.clear()
        stopped = time.monotonic()
        await until_async(lambda: of_device and of_station, "both are told")
        assert time.monotonic() - stopped > 0.1
        assert (of_device[0].kind, of_station[0].kind) == ("deadline", "deadline")
        assert "no sample received within its deadline of 0.2 s" in of_station[0].text
        assert "no sample published within its deadline of 0.2 s" in of_device[0].text

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_who_agrees_is_told_nothing_and_the_graph_shows_what_was_agreed(kind: str) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        events: list[QualityEvent] = []
        heard: list[Sample] = []
        device.watch(events.append)
        station.watch(events.append)
        device.advertise("/tool/state", TEXT, QualityOfService.of({"deadline": 5, "liveliness": 4, "depth": 2}))
        station.subscribe("/tool/state", TEXT, QualityOfService.of({"deadline": 6}), heard.extend)

        def arrives() -> bool:
            device.publish("/tool/state", TEXT, HELLO)
            return bool(heard)

        await until_async(arrives, "a sample arrives")
        times = {(e.direction, e.deadline, e.liveliness) for e in station.graph() if e.topic == "/tool/state"}
        assert times == {("publisher", 5.0, 4.0), ("subscriber", 6.0, None)}
        station.close()
        await asyncio.sleep(0.1)
        assert events == []

    play(kind, scenario)
