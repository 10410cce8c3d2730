"""A station at work, and what disturbs it: real processes that meet over DDS only."""

from __future__ import annotations

import asyncio
import math
import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from sequence_planner.ros.qos import QualityOfService
from support.network import free_port
from support.station import MODEL, RunningStation, finished, foreign_node, process, station
from support.waiting import until

AT_WORK = ("--emulator", "--start", "--emulator-speed", "5")


@pytest.fixture(scope="module")
def at_work(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStation]:
    with station(tmp_path_factory.mktemp("at-work"), *AT_WORK) as running:
        yield running


def test_a_whole_engine_is_assembled(at_work: RunningStation) -> None:
    at_work.work_on(3)
    until(lambda: at_work.completed("new_engine") >= 1)
    assert [alarm["text"] for alarm in at_work.get("alarms").values() if alarm["ended"] is None] == []


def test_two_controllers_never_command_the_same_devices(at_work: RunningStation, tmp_path: Path) -> None:
    second = finished("run", str(MODEL), "--port", str(free_port()))
    assert second.returncode == 2
    assert "another controller of this station runs already" in second.stderr
    second = finished("run", str(MODEL), "--port", str(free_port()), "--database", f"sqlite:///{tmp_path}/other.sqlite")
    assert second.returncode == 2
    assert "somebody else publishes /" in second.stderr
    assert "Stop the other one, or choose another ROS_DOMAIN_ID" in second.stderr
    assert "Traceback" not in second.stderr


def test_emulated_devices_never_speak_for_devices_that_are_there(at_work: RunningStation) -> None:
    second = finished("emulate", str(MODEL))
    assert second.returncode == 2
    assert "the emulated devices would fight with it" in second.stderr
    assert "(node /emulated_devices)" in second.stderr


def test_a_port_that_is_taken_is_said(at_work: RunningStation) -> None:
    second = finished("run", str(MODEL), "--port", str(at_work.port))
    assert second.returncode == 2
    assert second.stderr == f"port {at_work.port} is taken; use --port\n"


def test_a_message_of_another_type_is_shown_and_the_work_goes_on(at_work: RunningStation) -> None:
    async def disturb() -> None:
        async with foreign_node() as (transport, registry):
            transport.advertise("/ur10/state", "std_msgs/msg/String", QualityOfService.RELIABLE)
            transport.publish("/ur10/state", "std_msgs/msg/String", registry.encode("std_msgs/msg/String", {}))
            await asyncio.to_thread(
                until, lambda: "as std_msgs/msg/String" in str(at_work.get("topics")["/ur10/state"]["trouble"])
            )
            assert "network:robot" in at_work.get("alarms")
            await asyncio.to_thread(at_work.work_on, 1)

    asyncio.run(disturb())
    until(lambda: at_work.get("topics")["/ur10/state"]["trouble"] is None)


def test_a_peer_built_with_another_definition_is_shown_with_both_hashes(
    at_work: RunningStation, tmp_path: Path
) -> None:
    definition = tmp_path / "truck_engine_msgs" / "msg" / "RobotState.msg"
    definition.parent.mkdir(parents=True)
    definition.write_text("float64[6] joint_positions\n")

    async def disturb() -> None:
        async with foreign_node(tmp_path) as (transport, registry):
            type_name = "truck_engine_msgs/msg/RobotState"
            transport.advertise("/ur10/state", type_name, QualityOfService.RELIABLE)
            theirs = registry.type_hash(type_name)
            await asyncio.to_thread(until, lambda: f"theirs is {theirs}, ours is RIHS01_" in str(at_work.get("alarms")))
            await asyncio.to_thread(at_work.work_on, 1)

    asyncio.run(disturb())


def test_a_message_that_means_nothing_makes_its_variables_unknown_until_the_next(at_work: RunningStation) -> None:
    async def disturb() -> None:
        async with foreign_node() as (transport, registry):
            topic, type_name = "/ur10/state", "truck_engine_msgs/msg/RobotState"
            transport.advertise(topic, type_name, QualityOfService.RELIABLE)
            nowhere = registry.encode(type_name, {"joint_positions": [math.nan] * 6})

            def troubled() -> bool:
                transport.publish(topic, type_name, nowhere)
                return "joint_positions is no position: [nan" in str(at_work.get("alarms"))

            for _ in range(2000):
                if troubled():
                    break
                await asyncio.sleep(0.005)
            else:
                pytest.fail("the message was not noticed")

    asyncio.run(disturb())
    until(lambda: at_work.value("robot.pose") is not None)
    at_work.work_on(1)


def done_so_far(at_work: RunningStation) -> dict[str, tuple[bool, int]]:
    """Of each operation whether it is active, and how often it was completed."""
    return {name: (each["active"], each["completed"]) for name, each in at_work.get("operations").items()}


def test_devices_that_were_killed_leave_unknown_values_and_come_back_to_work(
    at_work: RunningStation, tmp_path: Path
) -> None:
    os.kill(at_work.child("emulate"), signal.SIGKILL)
    until(lambda: at_work.value("robot.pose") is None)
    pose = at_work.get("variables", "state")["robot.pose"]
    assert pose["awaits"] == "/ur10/state"
    assert pose["last_known"] in pose["domain"], "where it was last"
    topics = ["/ur10/state", "/ur10/planning_scene/state"]
    until(lambda: at_work.get("resources")["robot"]["awaited_topics"] == topics)
    assert at_work.get("resources")["operator"]["online"]
    until(lambda: "No more messages on /smart_nutrunner/state" in str(at_work.get("alarms")))
    before = done_so_far(at_work)
    time.sleep(1)
    assert done_so_far(at_work) == before
    with process(tmp_path / "devices.log", "emulate", str(MODEL), "--speed", "5"):
        until(lambda: at_work.value("robot.pose") is not None)
        at_work.work_on(2)
        moved = finished("by-hand", "robot.pose := home")
        assert (moved.returncode, moved.stderr) == (0, "")
        at_work.work_on(2)
    at_work.log.write_text("")
