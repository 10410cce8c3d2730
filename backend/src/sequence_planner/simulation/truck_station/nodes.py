"""One node of the station as a process: ROS 2 on the one side, the signals of its device on the other."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import structlog

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, Transport
from sequence_planner.ros.types.errors import MalformedMessageError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.truck_station.drivers import (
    AgvDriver,
    DeviceLink,
    DockDriver,
    Driver,
    EndEffectorDriver,
    Record,
    RestLink,
    RobotDriver,
    SceneDriver,
    TagDriver,
    ToolDriver,
    WatchDriver,
    WorldEndedError,
    WorldLink,
)

LOG = structlog.get_logger(__name__)

PREFIX = "/unification_roscontrol"
PACKAGE = "unification_ros2_messages/msg"
RELIABLE = QualityOfService.RELIABLE


@dataclass(frozen=True)
class NodeType:
    """The messages that a node speaks and hears, and the seconds between two of its messages."""

    driver: Callable[[], Driver]
    every: float
    says: tuple[str, str]  # topic and type
    hears: tuple[str, str] | None


NODE_TYPES = {
    "tool_ecu": NodeType(ToolDriver, 0.01, ("aecu_uni_to_sp", "AecuUniToSP"), ("aecu_sp_to_uni", "AecuSPToUni")),
    "rsp_ecu": NodeType(EndEffectorDriver, 0.01, ("recu_uni_to_sp", "RecuUniToSP"), ("recu_sp_to_uni", "RecuSPToUni")),
    "dock_ecu": NodeType(DockDriver, 1.0, ("hecu_uni_to_sp", "HecuUniToSP"), None),
    "mircom": NodeType(
        AgvDriver, 0.2, ("mir_pose_uni_to_sp", "MiRPoseUniToSP"), ("mir_pose_sp_to_uni", "MiRPoseSPToUni")
    ),
    "rfidcam": NodeType(
        TagDriver, 0.2, ("rfidcam_uni_to_sp", "RfidcamUniToSP"), ("rfidcam_sp_to_uni", "RfidcamSPToUni")
    ),
    "ur10": NodeType(
        RobotDriver,
        0.1,
        ("ur_TARS_pose_unidriver_uni_to_sp", "URPoseUniToSP"),
        ("ur_pose_unidriver_sp_to_uni", "URPoseSPToUni"),
    ),
    "scene": NodeType(
        SceneDriver,
        0.2,
        ("scene_updater_uni_to_sp", "SceneUpdaterUniToSP"),
        ("scene_updater_sp_to_uni", "SceneUpdaterSPToUni"),
    ),
    "watch": NodeType(WatchDriver, 0.1, ("watch_uni_to_sp", "WatchUniToSP"), ("watch_sp_to_uni", "WatchSPToUni")),
}


async def live(
    name: str, port: int, mir_port: int, registry: MessageRegistry, connect: Callable[[str], Transport]
) -> None:
    """Run the node `name` until it is cancelled, or the world ends, which serves at `port`; the AGV is at `mir_port`.

    `connect` joins the network as the node of the given name. Raises OSError when there is no world, and TransportError
    when the network refuses.
    """
    world = await WorldLink.to(name, port)
    link: DeviceLink = RestLink(world, mir_port) if name == "mircom" else world
    kind = NODE_TYPES[name]
    try:
        await _live(kind, link, registry, lambda driver: _joined(name, kind, driver, registry, connect))
    except WorldEndedError:
        LOG.error("the world has ended")
    finally:
        link.close()


async def _live(
    kind: NodeType, link: DeviceLink, registry: MessageRegistry, join: Callable[[Driver], Transport]
) -> None:
    driver = kind.driver()
    transport: Transport | None = join(driver)
    topic, type_name = f"{PREFIX}/{kind.says[0]}", f"{PACKAGE}/{kind.says[1]}"
    due = time.monotonic()
    try:
        while True:
            answer = await link.exchange(driver.signals(time.monotonic()))
            trouble = answer.fault.get("kind")
            if trouble == "offline":
                if transport is not None:
                    transport.close()
                    transport = None
            elif transport is None:
                transport = join(driver)
            elif trouble != "silent":
                message = driver.say(answer.read, time.monotonic()) | answer.fault.get("fields", {})
                transport.publish(topic, type_name, registry.encode(type_name, message))
            due = max(due + kind.every, time.monotonic())
            await asyncio.sleep(due - time.monotonic())
    finally:
        if transport is not None:
            transport.close()


def _joined(
    name: str, kind: NodeType, driver: Driver, registry: MessageRegistry, connect: Callable[[str], Transport]
) -> Transport:
    transport = connect(f"{name}_unidriver")
    transport.advertise(f"{PREFIX}/{kind.says[0]}", f"{PACKAGE}/{kind.says[1]}", RELIABLE)
    if kind.hears is not None:
        topic, type_name = f"{PREFIX}/{kind.hears[0]}", f"{PACKAGE}/{kind.hears[1]}"
        transport.subscribe(topic, type_name, RELIABLE, _hearing(driver, registry, type_name))
    return transport


def _hearing(driver: Driver, registry: MessageRegistry, type_name: str) -> Callable[[Sequence[Sample]], None]:
    def hear(samples: Sequence[Sample]) -> None:
        for sample in samples:
            try:
                command: Record = registry.decode(type_name, sample.data)
            except MalformedMessageError as error:
                LOG.warning("command not understood", topic=sample.topic, reason=str(error))
                continue
            driver.on_command(command, time.monotonic())

    return hear
