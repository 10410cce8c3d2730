"""Topics, services and actions with genuine ROS 2, both ways, on both transports."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import cache

import pytest

from foreign.genuine import CYCLONE, FAST, Genuine, genuine, lacking
from sequence_planner.ros.actions import ActionClient, ActionServer, GoalOutcome, GoalStatus, GoalWork, cancelled
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NoAnswerError, NoServerError, Sample, Transport
from sequence_planner.ros.transports.choice import TransportChoice, open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from support.network import DOMAIN
from support.waiting import PATIENCE, until_async

TEXT, POSE, ADD = "std_msgs/msg/String", "geometry_msgs/msg/PoseStamped", "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"
RELIABLE, LATCHED = QualityOfService.RELIABLE, QualityOfService.LATCHED
TRANSPORTS: tuple[TransportChoice, ...] = ("cyclonedds", "rclpy")
#: Where the station runs on rclpy it has one middleware in this process, that of RMW_IMPLEMENTATION.
OURS = os.environ.get("RMW_IMPLEMENTATION", FAST)

ON_EACH = pytest.mark.parametrize("transport", TRANSPORTS)
WITH_EACH = pytest.mark.parametrize("rmw", [CYCLONE, FAST])


@cache
def registry() -> MessageRegistry:
    return MessageRegistry.from_folder(None)


def alike(transport: TransportChoice, rmw: str) -> bool:
    """Whether both put the number of a call in the same place."""
    return rmw == (CYCLONE if transport == "cyclonedds" else OURS)


class Station:
    """A station's transport: what it says, hears, serves and asks for."""

    def __init__(self, transport: Transport) -> None:
        self.transport = transport
        self.heard: dict[str, list[Mapping[str, object]]] = {}

    def say(self, topic: str, type_name: str, values: Mapping[str, object]) -> None:
        self.transport.publish(topic, type_name, registry().encode(type_name, values))

    def hear(self, topic: str, type_name: str, quality: QualityOfService = RELIABLE) -> None:
        heard = self.heard.setdefault(topic, [])

        def take(batch: Sequence[Sample]) -> None:
            heard.extend(registry().decode(type_name, sample.data) for sample in batch)

        self.transport.subscribe(topic, type_name, quality, take)

    def texts(self, topic: str) -> list[object]:
        return [message["data"] for message in self.heard[topic]]

    async def greeted(self) -> None:
        """Wait until the peer answers what is said."""

        def answered() -> bool:
            self.say("/ping", TEXT, {"data": "-"})
            return bool(self.texts("/pong"))

        await until_async(answered, "the peer answers")

    async def add(self, a: int, b: int) -> object:
        request = registry().encode(f"{ADD}_Request", {"a": a, "b": b})
        answer = await self.transport.call("/genuine/add", ADD, request, PATIENCE)
        return registry().decode(f"{ADD}_Response", answer)["sum"]

    def serve(self) -> ActionServer:
        """Serve /station/add and /station/fibonacci."""

        async def add(request: bytes) -> bytes:
            numbers = registry().decode(f"{ADD}_Request", request)
            return registry().encode(f"{ADD}_Response", {"sum": int(str(numbers["a"])) + int(str(numbers["b"]))})

        async def count(work: GoalWork) -> GoalOutcome:
            sequence = [0, 1]
            while len(sequence) < int(str(work.goal["order"])):
                if await cancelled(work.cancel_wanted, 0.1):
                    return GoalOutcome(GoalStatus.CANCELED, {"sequence": sequence})
                sequence = [*sequence, sequence[-1] + sequence[-2]]
                work.feedback({"sequence": sequence})
            return GoalOutcome(GoalStatus.SUCCEEDED, {"sequence": sequence})

        self.transport.serve("/station/add", ADD, add)
        return ActionServer(self.transport, registry(), "/station/fibonacci", FIBONACCI, count)


def play(transport: TransportChoice, scenario: Callable[[Station], Awaitable[None]]) -> None:
    """Run `scenario` with a station that has the topics of the peer."""
    if transport == "rclpy" and (why := lacking(OURS)) is not None:
        pytest.skip(why)

    async def live() -> None:
        opened = open_transport(transport, registry(), "station", asyncio.get_running_loop(), DOMAIN)
        try:
            station = Station(opened)
            for topic, type_name in (("/ping", TEXT), ("/pose/in", POSE)):
                opened.advertise(topic, type_name, RELIABLE)
            for topic, type_name in (("/pong", TEXT), ("/pose/out", POSE)):
                station.hear(topic, type_name)
            await scenario(station)
        finally:
            opened.close()

    asyncio.run(live())


def quiet(peer: Genuine) -> None:
    """See that nothing has displeased a genuine node."""
    assert peer.complaints == []


@ON_EACH
@WITH_EACH
def test_topics_both_ways(transport: TransportChoice, rmw: str) -> None:
    pose = {"header": {"stamp": {"sec": -1, "nanosec": 7}, "frame_id": "bäse"}, "pose": {"position": {"x": 1.5}}}

    async def scenario(station: Station) -> None:
        station.transport.advertise("/station/latched", TEXT, LATCHED)
        station.say("/station/latched", TEXT, {"data": "ours"})
        async with genuine(rmw, DOMAIN) as peer:
            station.hear("/genuine/latched", TEXT, LATCHED)
            assert await peer.says("latched") == "ours"
            await station.greeted()
            for text in ("a", "ab", "åäö 語"):
                station.say("/ping", TEXT, {"data": text})
            station.say("/pose/in", POSE, pose)
            await until_async(lambda: station.texts("/pong")[-1:] == ["åäö 語åäö 語"], "the last answer comes")
            assert [each for each in station.texts("/pong") if each != "--"] == ["aa", "abab", "åäö 語åäö 語"]
            await until_async(lambda: station.heard["/pose/out"], "the pose comes back")
            [turned] = station.heard["/pose/out"]
            assert turned["header"] == {"stamp": {"sec": -1, "nanosec": 7}, "frame_id": "bäsebäse"}
            await until_async(lambda: station.texts("/genuine/latched") == ["last"], "what was kept comes")
            quiet(peer)

    play(transport, scenario)


@ON_EACH
@WITH_EACH
def test_a_genuine_server_answers_and_a_genuine_client_is_answered(transport: TransportChoice, rmw: str) -> None:
    if not alike(transport, rmw):
        pytest.skip(f"{rmw} does not map services as this station does: see the tests of refusal")

    async def scenario(station: Station) -> None:
        server = station.serve()
        async with genuine(rmw, DOMAIN) as peer:
            assert await station.add(-(2**62), 2**62 - 1) == -1
            # As many at a time as rclpy's servers keep.
            assert await asyncio.gather(*(station.add(number, 1) for number in range(10))) == list(range(1, 11))
            assert await peer.told("add 20", "added") == str(list(range(1, 21)))
            quiet(peer)
        server.close()

    play(transport, scenario)


@ON_EACH
@WITH_EACH
def test_actions_both_ways(transport: TransportChoice, rmw: str) -> None:
    if not alike(transport, rmw):
        pytest.skip(f"{rmw} does not map services as this station does: see the tests of refusal")

    async def scenario(station: Station) -> None:
        server = station.serve()
        client = ActionClient(station.transport, registry(), "/genuine/fibonacci", FIBONACCI)
        async with genuine(rmw, DOMAIN) as peer:
            told: list[object] = []
            goal = await client.send_goal({"order": 8}, PATIENCE, lambda values: told.append(values["sequence"]))
            assert await goal.result() == GoalOutcome(GoalStatus.SUCCEEDED, {"sequence": [0, 1, 1, 2, 3, 5, 8, 13]})
            assert told
            assert told[-1] == [0, 1, 1, 2, 3, 5, 8, 13]
            goal = await client.send_goal({"order": 40}, PATIENCE)
            await asyncio.sleep(0.3)
            await goal.cancel(PATIENCE)
            assert (await goal.result()).status == GoalStatus.CANCELED
            assert await peer.told("fibonacci 6", "succeeded") == "[0, 1, 1, 2, 3, 5]"
            assert "told True" in peer.lines
            assert (await peer.told("fibonacci 40 cancel", "canceled")).startswith("[0, 1, 1")
            assert "cancelling 1" in peer.lines
            quiet(peer)
        server.close()

    play(transport, scenario)


@ON_EACH
@WITH_EACH
def test_each_sees_the_other_by_name(transport: TransportChoice, rmw: str) -> None:
    async def scenario(station: Station) -> None:
        server = station.serve()
        async with genuine(rmw, DOMAIN) as peer:
            await station.greeted()

            def named() -> bool:
                return {each.node for each in station.transport.graph() if each.topic == "/pong" and not each.own} == {
                    "/cell/genuine"
                }

            await until_async(named, "the genuine node is named")
            [pong] = [each for each in station.transport.graph() if each.topic == "/pong" and not each.own]
            assert pong.type_hash == registry().type_hash(TEXT)
            for _ in range(100):
                seen = await peer.told("graph", "hash")
                if any(line.startswith("service") and "/station/add" in line for line in peer.lines):
                    break
                await asyncio.sleep(0.1)
            assert seen == registry().type_hash(TEXT)
            lines = dict(line.split(" ", 1) for line in peer.lines)
            assert "'/station'" in lines["nodes"]
            assert f"/ping {TEXT}" in lines["publisher"]
            assert f"/pong {TEXT}" in lines["subscriber"]
            assert f"/station/add {ADD}" in lines["service"]
            assert f"/station/fibonacci/_action/send_goal {FIBONACCI}_SendGoal" in lines["service"]
            quiet(peer)
        server.close()

    play(transport, scenario)


@ON_EACH
@WITH_EACH
def test_either_side_may_be_killed_and_come_back(transport: TransportChoice, rmw: str) -> None:
    async def scenario(station: Station) -> None:
        for _ in range(2):
            async with genuine(rmw, DOMAIN) as peer:
                station.heard["/pong"].clear()
                await station.greeted()
                if alike(transport, rmw):
                    assert await station.add(1, 2) == 3
                quiet(peer)
                peer.process.kill()
                await peer.process.wait()

    async def beside_a_station_that_comes_back() -> None:
        async with genuine(rmw, DOMAIN) as peer:
            for _ in range(2):
                opened = open_transport(transport, registry(), "station", asyncio.get_running_loop(), DOMAIN)
                station = Station(opened)
                opened.advertise("/ping", TEXT, RELIABLE)
                station.hear("/pong", TEXT)
                server = station.serve()
                await station.greeted()
                if alike(transport, rmw):
                    assert await peer.told("add 3", "added") == "[1, 2, 3]"
                server.close()
                opened.close()
            quiet(peer)

    play(transport, scenario)
    asyncio.run(beside_a_station_that_comes_back())


@ON_EACH
@WITH_EACH
def test_a_server_of_another_mapping_is_refused_before_anything_is_written(
    transport: TransportChoice, rmw: str
) -> None:
    if alike(transport, rmw):
        pytest.skip(f"{rmw} maps services as this station does")

    async def scenario(station: Station) -> None:
        async with genuine(rmw, DOMAIN):
            await station.greeted()
            with pytest.raises(NoServerError, match="nothing was sent") as refused:
                await station.add(1, 2)
            assert not isinstance(refused.value, NoAnswerError)

    play(transport, scenario)
