"""Which topics go through rosbridge: in one process, and for a station whose devices speak ROS 1 and ROS 2."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import sys
from collections.abc import Awaitable, Callable, Iterator, Sequence
from functools import cache
from pathlib import Path

import pytest

from rosbridge.server import RosbridgeServer
from sequence_planner.model.source import ModelError
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, Transport, TransportError
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.ros.transports.routing import ROSBRIDGE, open_routed
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.station import prepare_station
from support.network import free_port
from support.places import REPOSITORY
from support.station import RunningStation, finished, process
from support.waiting import until

TEXT = "std_msgs/msg/String"
OLD, NEW = "/old/state", "/new/state"
RELIABLE = QualityOfService.RELIABLE


@cache
def registry() -> MessageRegistry:
    return MessageRegistry.from_folder(None)


@pytest.fixture
def server() -> Iterator[RosbridgeServer]:
    running = RosbridgeServer()
    yield running
    running.close()


def text(data: str) -> bytes:
    return registry().encode(TEXT, {"data": data})


def play(url: str | None, scenario: Callable[[Transport, Transport], Awaitable[None]]) -> None:
    """Run `scenario` with a station's transport and that of another node of ROS 2."""

    async def run() -> None:
        loop, network = asyncio.get_running_loop(), MemoryNetwork()
        other = network.join(registry(), "other", loop)
        station = open_routed(
            lambda: network.join(registry(), "station", loop), {OLD}, url, registry(), "station", loop
        )
        try:
            await scenario(station, other)
        finally:
            station.close()
            other.close()
            with pytest.raises(TransportError, match="closed"):
                station.graph()

    asyncio.run(run())


async def soon(holds: Callable[[], bool]) -> None:
    await asyncio.to_thread(until, holds, seconds=10)


def test_each_topic_has_its_own_way(server: RosbridgeServer) -> None:
    async def scenario(station: Transport, other: Transport) -> None:
        heard: list[tuple[str, object]] = []

        def listen(batch: Sequence[Sample]) -> None:
            heard.extend((sample.topic, registry().decode(TEXT, sample.data)["data"]) for sample in batch)

        assert station.name == "memory + rosbridge"
        for topic in (OLD, NEW):
            station.advertise(topic, TEXT, RELIABLE)
            station.subscribe(topic, TEXT, RELIABLE, listen)
            other.advertise(topic, TEXT, RELIABLE)
        await soon(lambda: server.subscribed(OLD) == 1)
        for topic in (OLD, NEW):
            other.publish(topic, TEXT, text("of ROS 2"))
        server.publish(OLD, "std_msgs/String", {"data": "of ROS 1"})
        station.publish(NEW, TEXT, text("ours"))
        await soon(lambda: len(heard) == 3)
        assert sorted(heard) == [(NEW, "of ROS 2"), (NEW, "ours"), (OLD, "of ROS 1")]
        assert server.published(NEW) == []
        own = {(endpoint.topic, endpoint.direction) for endpoint in station.graph() if endpoint.own}
        assert own == {(topic, direction) for topic in (OLD, NEW) for direction in ("publisher", "subscriber")}

    play(server.url, scenario)


def test_services_are_those_of_ros_2(server: RosbridgeServer) -> None:
    async def scenario(station: Transport, other: Transport) -> None:
        type_name = "std_srvs/srv/Empty"
        asked = registry().encode("std_srvs/srv/Empty_Request", {})

        async def answer(request: bytes) -> bytes:
            return request

        other.serve("/reset", type_name, answer)
        assert await station.call("/reset", type_name, asked, 5.0) == asked
        station.serve("/reload", type_name, answer)
        assert await other.call("/reload", type_name, asked, 5.0) == asked

    play(server.url, scenario)


def test_without_topics_of_ros_1_there_is_no_bridge() -> None:
    async def run() -> None:
        loop = asyncio.get_running_loop()
        alone = MemoryNetwork().join(registry(), "station", loop)
        assert open_routed(lambda: alone, (), None, registry(), "station", loop) is alone

    asyncio.run(run())


async def nothing(station: Transport, other: Transport) -> None:
    raise AssertionError("it should have been refused")


def test_a_station_without_an_address_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(ROSBRIDGE, raising=False)
    with pytest.raises(
        TransportError, match=r"topics of ROS 1 \(/old/state\).*--rosbridge or SEQUENCE_PLANNER_ROSBRIDGE"
    ):
        play(None, nothing)
    monkeypatch.setenv(ROSBRIDGE, "http://127.0.0.1:9090")
    with pytest.raises(TransportError, match="is not the address of a rosbridge server"):
        play(None, nothing)


def test_a_computer_without_roslibpy_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sequence_planner.ros.transports.rosbridge", None)
    with pytest.raises(TransportError, match=r"need roslibpy .*pip install 'sequence-planner\[ros1\]'"):
        play("ws://127.0.0.1:9090", nothing)


@pytest.fixture
def mixed(tmp_path: Path) -> Path:
    """A station whose second robot speaks ROS 1."""
    model = tmp_path / "station"
    shutil.copytree(REPOSITORY / "models" / "robots_with_buffer", model)
    robot = model / "resources" / "robot_2.yaml"
    written = robot.read_text(encoding="utf-8")
    topics = "topics:\n  /robot_2/state: {ros: 1}\n  /robot_2/command: {ros: 1}\n"
    robot.write_text(f"{written}\n{topics}", encoding="utf-8")
    return model


def test_the_model_says_which_topics_are_of_ros_1(mixed: Path) -> None:
    assert prepare_station(mixed).ros_1 == {"/robot_2/state", "/robot_2/command"}
    robot = mixed / "resources" / "robot_2.yaml"
    robot.write_text(robot.read_text(encoding="utf-8").replace("ros: 1", "ros: 3"), encoding="utf-8")
    with pytest.raises(ModelError, match="1 or 2"):
        prepare_station(mixed)


def test_devices_of_both_kinds_do_the_work_of_the_station(mixed: Path, server: RosbridgeServer, tmp_path: Path) -> None:
    port, log = free_port(), tmp_path / "station.log"
    options = ("--emulator", "--emulator-speed", "10", "--port", str(port), "--rosbridge", server.url)
    try:
        with process(log, "run", str(mixed), *options) as started:
            station = RunningStation(started, port, log)
            until(station.up)
            assert station.get("station")["transport"] == "cyclonedds + rosbridge"
            until(lambda: None not in (station.value("robot_1.at"), station.value("robot_2.at")))
            assert station.post("production/start", {}).status_code == 204
            until(lambda: station.completed("deliver_part") >= 1)
            assert station.get("alarms") == {}

            server.stop()
            until(lambda: station.value("robot_2.at") is None)
            assert station.value("robot_1.at") is not None
            server.start()
            until(lambda: station.value("robot_2.at") is not None)
            done = station.completed("deliver_part")
            until(lambda: station.completed("deliver_part") > done)

            os.kill(station.child("emulate"), signal.SIGKILL)
            said = {"at": 5, "part_in_gripper": False, "part_on_conveyor": False}
            trouble = "buffer_msgs/msg/RobotState at: expected string, found 5 (int)"

            def troubled() -> bool:
                server.publish("/robot_2/state", "buffer_msgs/RobotState", said)
                return bool(station.get("topics")["/robot_2/state"]["trouble"] == trouble)

            until(troubled)
            assert station.value("robot_2.at") is None
    except AssertionError as error:
        raise AssertionError(log.read_text()) from error
    topics = {operation.get("topic") for operation in server.operations if operation["op"] == "publish"}
    assert topics == {"/robot_2/state", "/robot_2/command"}


def test_a_station_of_ros_1_does_not_run_without_a_server_to_reach_it(mixed: Path) -> None:
    refused = finished("emulate", str(mixed))
    assert refused.returncode == 2
    assert "topics of ROS 1 (/robot_2/command, /robot_2/state)" in refused.stderr
    assert "Traceback" not in refused.stderr
