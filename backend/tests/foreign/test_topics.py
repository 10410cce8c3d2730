"""Topics with other implementations of ROS 2: their bytes, their policies, their discovery."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from functools import cache

import pytest

from foreign.peers import FAST_DDS, ROS2_CLIENT, built, running
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, Sample, Transport
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from support.network import DOMAIN
from support.waiting import until_async

TEXT, JOINTS = "std_msgs/msg/String", "sensor_msgs/msg/JointState"
RELIABLE, LATCHED = QualityOfService.RELIABLE, QualityOfService.LATCHED
BOTH = pytest.mark.parametrize("peer", [FAST_DDS, ROS2_CLIENT])


@cache
def registry() -> MessageRegistry:
    return MessageRegistry.from_folder(None)


class Station:
    """The station's transport, with what it has heard."""

    def __init__(self, transport: Transport) -> None:
        self.transport = transport
        self.heard: dict[str, list[dict[str, object]]] = {}

    def say(self, topic: str, type_name: str, values: dict[str, object]) -> None:
        self.transport.publish(topic, type_name, registry().encode(type_name, values))

    def hear(self, topic: str, type_name: str, quality: QualityOfService) -> None:
        heard = self.heard.setdefault(topic, [])

        def take(batch: Sequence[Sample]) -> None:
            heard.extend(registry().decode(type_name, sample.data) for sample in batch)

        self.transport.subscribe(topic, type_name, quality, take)

    def texts(self, topic: str) -> list[object]:
        return [message["data"] for message in self.heard[topic]]

    def foreign(self) -> list[NetworkEndpoint]:
        return [endpoint for endpoint in self.transport.graph() if not endpoint.own]


def play(peer: str, scenario: Callable[[Station], Awaitable[None]], late: Callable[[Station], None]) -> None:
    """Run `scenario` beside a peer that echoes; `late` is done when the peer has begun."""
    program = built(peer)

    async def live() -> None:
        transport = open_transport("cyclonedds", registry(), "station", asyncio.get_running_loop(), DOMAIN)
        try:
            station = Station(transport)
            async with running(program, DOMAIN, "echo"):
                late(station)
                await scenario(station)
            await until_async(lambda: station.foreign() == [], "the peer is gone")
        finally:
            transport.close()

    asyncio.run(live())


@BOTH
def test_commands_are_read_and_answered(peer: str) -> None:
    def begin(station: Station) -> None:
        station.transport.advertise("/ping", TEXT, RELIABLE)
        station.hear("/pong", TEXT, RELIABLE)

    async def scenario(station: Station) -> None:
        def greeted() -> bool:
            station.say("/ping", TEXT, {"data": "-"})  # The peer may not know yet who listens to its pong.
            return bool(station.texts("/pong"))

        await until_async(greeted, "the peer answers")
        for text in ("a", "ab", "abc", "abcd", "åäö 語"):
            station.say("/ping", TEXT, {"data": text})
        await until_async(lambda: station.texts("/pong")[-1] == "åäö 語åäö 語", "the last answer comes")
        answers = [text for text in station.texts("/pong") if text != "--"]
        assert answers == ["aa", "abab", "abcabc", "abcdabcd", "åäö 語åäö 語"]

    play(peer, scenario, begin)


@BOTH
def test_nested_messages_with_arrays_mean_the_same_on_both_sides(peer: str) -> None:
    said: dict[str, object] = {
        "header": {"stamp": {"sec": -1, "nanosec": 999_999_999}, "frame_id": "bäse"},
        "name": ["shoulder", "", "wrist_3"],
        "position": [1.5, -0.0, 1e300],
        "velocity": [],
        "effort": [float("inf"), -2.25],
    }
    answer = {**said, "name": ["wrist_3", "", "shoulder"], "position": [-1.5, 0.0, -1e300]}

    def begin(station: Station) -> None:
        station.transport.advertise("/joints/in", JOINTS, RELIABLE)
        station.hear("/joints/out", JOINTS, RELIABLE)

    async def scenario(station: Station) -> None:
        def answered() -> bool:
            station.say("/joints/in", JOINTS, said)
            return bool(station.heard["/joints/out"])

        await until_async(answered, "the peer answers")
        assert all(heard == answer for heard in station.heard["/joints/out"])

    play(peer, scenario, begin)


@BOTH
def test_latched_samples_reach_late_joiners_on_both_sides(peer: str) -> None:
    def begin(station: Station) -> None:
        station.transport.advertise("/kept/in", TEXT, LATCHED)
        station.say("/kept/in", TEXT, {"data": "older"})
        station.say("/kept/in", TEXT, {"data": "last"})  # before the peer can have been found

    async def scenario(station: Station) -> None:
        station.hear("/kept/out", TEXT, LATCHED)
        await until_async(lambda: "last" in station.texts("/kept/out"), "the peer has had it, and says it again")
        again = Station(station.transport)
        again.hear("/kept/out", TEXT, LATCHED)
        await until_async(lambda: again.texts("/kept/out") == ["last"], "who comes later still gets the last one")

    play(peer, scenario, begin)


@BOTH
def test_the_peer_is_seen_with_its_types_and_policies(peer: str) -> None:
    wanted = {
        ("/ping", TEXT, "subscriber", False),
        ("/pong", TEXT, "publisher", False),
        ("/joints/in", JOINTS, "subscriber", False),
        ("/joints/out", JOINTS, "publisher", False),
        ("/kept/in", TEXT, "subscriber", True),
        ("/kept/out", TEXT, "publisher", True),
    }

    async def scenario(station: Station) -> None:
        def seen() -> set[tuple[str, str, str, bool]]:
            return {(e.topic, e.type_name, e.direction, e.transient_local) for e in station.foreign()}

        await until_async(lambda: wanted <= seen(), "all its endpoints are seen")
        assert all(endpoint.reliable for endpoint in station.foreign() if endpoint.topic in {w[0] for w in wanted})
        if peer == ROS2_CLIENT:  # It tells its node, as ROS 2 does; plain DDS has none.
            await until_async(
                lambda: "/foreign" in {e.node for e in station.foreign() if e.topic == "/pong"}, "its node is known"
            )

    play(peer, scenario, lambda station: None)


@BOTH
def test_who_asks_for_more_than_the_peer_offers_gets_nothing(peer: str) -> None:
    def begin(station: Station) -> None:
        station.transport.advertise("/ping", TEXT, RELIABLE)
        station.hear("/pong", TEXT, RELIABLE)

    async def scenario(station: Station) -> None:
        demanding = Station(station.transport)
        demanding.hear("/pong", TEXT, LATCHED)

        def greeted() -> bool:
            station.say("/ping", TEXT, {"data": "-"})
            return len(station.texts("/pong")) > 3

        await until_async(greeted, "the peer answers")
        assert demanding.texts("/pong") == []

    play(peer, scenario, begin)
