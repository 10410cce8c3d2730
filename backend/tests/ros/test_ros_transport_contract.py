"""The contract of every transport: what a controller relies on, whichever it runs on."""

from __future__ import annotations

import importlib.util
import os
import threading
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from ros_networks import Network, play, settle, standard
from ros_peer import ROUNDS, STREAMED
from ros_processes import peer

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, Sample, Transport, TransportError
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from support.waiting import until_async

NO_RCLPY = pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None,
    reason="rclpy is not importable here: run this suite where ROS 2 Jazzy is installed",
)
OF_ANY_TYPE = ["memory", "cyclonedds"]
KINDS = [*OF_ANY_TYPE, pytest.param("rclpy", marks=NO_RCLPY)]

TEXT, NUMBER = "std_msgs/msg/String", "std_msgs/msg/Int32"
RELIABLE, SENSOR, LATCHED = QualityOfService.RELIABLE, QualityOfService.SENSOR_DATA, QualityOfService.LATCHED


class Listener:
    """Keeps what a subscription receives."""

    def __init__(self) -> None:
        self.samples: list[Sample] = []
        self.threads: set[int] = set()

    def __call__(self, batch: Sequence[Sample]) -> None:
        assert batch
        self.samples += batch
        self.threads.add(threading.get_ident())

    @property
    def texts(self) -> list[object]:
        return [standard().decode(TEXT, sample.data)["data"] for sample in self.samples]


def say(transport: Transport, topic: str, text: str) -> None:
    transport.publish(topic, TEXT, standard().encode(TEXT, {"data": text}))


def seen(transport: Transport, topic: str, direction: str) -> list[NetworkEndpoint]:
    """Return the foreign endpoints of a topic."""
    return [
        endpoint
        for endpoint in transport.graph()
        if (endpoint.topic, endpoint.direction, endpoint.own) == (topic, direction, False)
    ]


def own(transport: Transport, topic: str) -> list[NetworkEndpoint]:
    """Return the transport's own endpoints of a topic."""
    return [endpoint for endpoint in transport.graph() if endpoint.topic == topic and endpoint.own]


async def met(publisher: Transport, subscriber: Transport, topic: str) -> None:
    """Wait until both sides of a topic know each other."""
    await until_async(lambda: seen(publisher, topic, "subscriber"), f"the subscriber of {topic} is seen")
    await until_async(lambda: seen(subscriber, topic, "publisher"), f"the publisher of {topic} is seen")


@pytest.mark.parametrize("kind", KINDS)
def test_samples_arrive_in_order_on_the_event_loop(kind: str) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        listener, before = Listener(), time.monotonic()
        station.subscribe("/tool/state", TEXT, RELIABLE, listener)
        device.advertise("/tool/state", TEXT, RELIABLE)
        await met(device, station, "/tool/state")
        for text in ("one", "", "trois", "vier", "fünf"):
            say(device, "/tool/state", text)
        await until_async(lambda: len(listener.samples) == 5, "all samples arrive")
        assert listener.texts == ["one", "", "trois", "vier", "fünf"]
        assert listener.threads == {threading.get_ident()}
        assert {sample.topic for sample in listener.samples} == {"/tool/state"}
        received = [sample.received for sample in listener.samples]
        assert received == sorted(received)
        assert before <= received[0] <= time.monotonic()

    play(kind, scenario)


@pytest.mark.parametrize("kind", ["cyclonedds", pytest.param("rclpy", marks=NO_RCLPY)])
def test_twenty_topics_at_a_hundred_hertz_lose_nothing(kind: str) -> None:
    """Though the process that reads them computes most of the time."""

    async def scenario(network: Network) -> None:
        station = network.join("station")
        listeners = {topic: Listener() for topic in STREAMED}
        for topic, listener in listeners.items():
            station.subscribe(topic, TEXT, RELIABLE, listener)

        def all_there() -> bool:
            end = time.monotonic() + 0.1
            while time.monotonic() < end:  # keeps the interpreter to itself, as a tick does
                pass
            return all(listener.texts[-1:] == [str(ROUNDS - 1)] for listener in listeners.values())

        async with peer("stream"):
            await until_async(all_there, "the last samples arrive")
        expected = [str(number) for number in range(ROUNDS)]
        assert {topic: listener.texts for topic, listener in listeners.items()} == dict.fromkeys(STREAMED, expected)

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_the_graph_tells_own_from_foreign(kind: str) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        device.advertise("/tool/state", TEXT, LATCHED)
        station.subscribe("/tool/state", TEXT, SENSOR, Listener())
        await met(device, station, "/tool/state")
        published = NetworkEndpoint(
            "/tool/state", TEXT, "publisher", False, standard().type_hash(TEXT), "/device", True, True
        )
        subscribed = NetworkEndpoint(
            "/tool/state", TEXT, "subscriber", True, standard().type_hash(TEXT), "/station", False, False
        )
        fast = kind == "rclpy" and os.environ.get("RMW_IMPLEMENTATION") != "rmw_cyclonedds_cpp"
        vendor = None if kind == "memory" else "eProsima Fast DDS" if fast else "Eclipse Cyclone DDS"
        expected = {replace(published, vendor=vendor), replace(subscribed, vendor=vendor)}
        await until_async(lambda: expected <= set(station.graph()), "the nodes are named")
        assert [endpoint.direction for endpoint in own(device, "/tool/state")] == ["publisher"]

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_another_publisher_of_ones_topic_is_seen(kind: str) -> None:
    async def scenario(network: Network) -> None:
        first, second = network.join("station"), network.join("station")  # even of the same name
        first.advertise("/tool/command", TEXT, RELIABLE)
        assert seen(first, "/tool/command", "publisher") == []
        second.advertise("/tool/command", TEXT, RELIABLE)
        await until_async(lambda: seen(first, "/tool/command", "publisher"), "the other publisher is seen")
        await until_async(lambda: seen(second, "/tool/command", "publisher"), "the first publisher is seen")
        for each in (first, second):
            await until_async(partial(own, each, "/tool/command"), "one's own publisher is seen")
            assert len(own(each, "/tool/command")) == 1

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_late_joiner_gets_the_last_sample_of_a_latched_topic(kind: str) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        for topic, qos in (("/plan/latched", LATCHED), ("/plan/volatile", RELIABLE)):
            device.advertise(topic, TEXT, qos)
            for text in ("old", "last"):
                say(device, topic, text)
        latched, volatile, unlatched = Listener(), Listener(), Listener()
        station.subscribe("/plan/latched", TEXT, LATCHED, latched)
        station.subscribe("/plan/latched", TEXT, RELIABLE, unlatched)
        station.subscribe("/plan/volatile", TEXT, RELIABLE, volatile)
        await until_async(lambda: latched.samples, "the last sample arrives")
        await settle()
        assert latched.texts == ["last"]
        assert volatile.samples == unlatched.samples == []
        say(device, "/plan/latched", "new")
        await until_async(lambda: latched.texts == ["last", "new"], "later samples arrive")

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_peer_of_another_type_is_seen_and_delivers_nothing(kind: str) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        listener = Listener()
        station.subscribe("/tool/state", TEXT, RELIABLE, listener)
        device.advertise("/tool/state", NUMBER, RELIABLE)
        await met(device, station, "/tool/state")
        device.publish("/tool/state", NUMBER, standard().encode(NUMBER, {"data": 6}))
        await settle()
        assert listener.samples == []
        [publisher] = seen(station, "/tool/state", "publisher")
        assert (publisher.type_name, publisher.type_hash) == (NUMBER, standard().type_hash(NUMBER))

    play(kind, scenario)


# rclpy would need the generated code of both definitions.
@pytest.mark.parametrize("kind", OF_ANY_TYPE)
def test_a_stale_definition_shows_in_the_type_hash(kind: str, tmp_path: Path) -> None:
    def registry(folder: str, definition: str) -> MessageRegistry:
        path = tmp_path / folder / "cell_msgs" / "msg" / "State.msg"
        path.parent.mkdir(parents=True)
        path.write_text(definition)
        return MessageRegistry.from_folder(tmp_path / folder)

    async def scenario(network: Network) -> None:
        old, new = registry("old", "bool idle\n"), registry("new", "bool idle\nfloat64 torque\n")
        device, station = network.join("device", old), network.join("station", new)
        station.subscribe("/tool/state", "cell_msgs/msg/State", RELIABLE, Listener())
        device.advertise("/tool/state", "cell_msgs/msg/State", RELIABLE)
        await met(device, station, "/tool/state")
        hashes = {endpoint.own: endpoint.type_hash for endpoint in station.graph()}
        name = "cell_msgs/msg/State"
        assert hashes == {True: new.type_hash(name), False: old.type_hash(name)}
        assert old.type_hash(name) != new.type_hash(name)

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_who_asks_for_more_than_is_offered_gets_nothing(kind: str) -> None:
    async def scenario(network: Network) -> None:
        device, station = network.join("device"), network.join("station")
        reliable, sensor = Listener(), Listener()
        device.advertise("/camera", TEXT, SENSOR)
        station.subscribe("/camera", TEXT, RELIABLE, reliable)
        station.subscribe("/camera", TEXT, SENSOR, sensor)
        await met(device, station, "/camera")

        def heard() -> bool:
            say(device, "/camera", "frame")  # Best effort: what was sent before both sides were ready is lost.
            return bool(sensor.samples)

        await until_async(heard, "a frame arrives")
        await settle()
        assert reliable.samples == []
        [publisher] = seen(station, "/camera", "publisher")
        assert not publisher.reliable

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_who_closes_is_gone_and_hears_nothing(kind: str) -> None:
    async def scenario(network: Network) -> None:
        threads = set(threading.enumerate())
        device, station = network.join("device"), network.join("station")
        listener = Listener()
        station.subscribe("/tool/state", TEXT, RELIABLE, listener)
        device.advertise("/tool/state", TEXT, RELIABLE)
        await met(device, station, "/tool/state")
        say(device, "/tool/state", "unheard")
        station.close()
        station.close()
        await until_async(lambda: not seen(device, "/tool/state", "subscriber"), "the subscriber goes")
        say(device, "/tool/state", "to nobody")
        device.close()
        assert set(threading.enumerate()) <= threads
        await settle()
        assert listener.samples == []
        with pytest.raises(TransportError):
            say(device, "/tool/state", "after the end")
        with pytest.raises(TransportError, match="closed"):
            device.advertise("/tool/other", TEXT, RELIABLE)
        with pytest.raises(TransportError, match="closed"):
            station.graph()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_misuse_is_refused_with_a_reason(kind: str) -> None:
    async def scenario(network: Network) -> None:
        station = network.join("station")
        with pytest.raises(TransportError, match="/tool/command has not been advertised"):
            say(station, "/tool/command", "go")
        station.advertise("/tool/command", TEXT, RELIABLE)
        station.advertise("/tool/command", TEXT, RELIABLE)  # harmless
        await until_async(lambda: own(station, "/tool/command"), "the publisher is seen")
        assert len(own(station, "/tool/command")) == 1
        with pytest.raises(TransportError, match="already advertised as std_msgs/msg/String"):
            station.advertise("/tool/command", NUMBER, RELIABLE)
        with pytest.raises(TransportError, match="has not been advertised as std_msgs/msg/Int32"):
            station.publish("/tool/command", NUMBER, b"")
        for topic in ("tool/command", "/tool//command", "/1st", "/tool/", "/tool state", "/a__b", ""):
            with pytest.raises(ValueError, match="is not a topic name"):
                station.advertise(topic, TEXT, RELIABLE)
            with pytest.raises(ValueError, match="is not a topic name"):
                station.subscribe(topic, TEXT, RELIABLE, Listener())
        with pytest.raises(UnknownMessageTypeError, match="did you mean std_msgs/msg/String"):
            station.subscribe("/tool/state", "std_msgs/msg/Strng", RELIABLE, Listener())
        with pytest.raises(ValueError, match="is not a node name"):
            network.join("my station")

    play(kind, scenario)
