"""Types that colcon has built, of all models and of ROS 2 itself, have the hashes that we give them."""

from __future__ import annotations

import asyncio
import importlib.util
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from foreign.genuine import lacking
from foreign.test_genuine import OURS
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import TransportError
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from support.network import DOMAIN
from support.places import REPOSITORY

CHANGED = "truck_engine_msgs/msg/RobotCommand"
MODELS = sorted(path.parent for path in (REPOSITORY / "models").glob("*/messages"))


def built() -> Iterator[tuple[str, Path]]:
    """Yield each package that is installed in this ROS 2, and its folder."""
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        for marker in sorted(Path(prefix, "share/ament_index/resource_index/rosidl_interfaces").glob("*")):
            yield marker.name, Path(prefix, "share", marker.name)


def hashes_of(package: Path) -> dict[str, str]:
    """What rosidl wrote of the types of a package, beside the code that it generated of them."""
    described = [path for kind in ("msg", "srv", "action") for path in sorted(package.glob(f"{kind}/*.json"))]
    return {
        each["type_name"]: each["hash_string"]
        for path in described
        for each in json.loads(path.read_text(encoding="utf-8"))["type_hashes"]
        if each["type_name"].startswith(f"{package.name}/")
    }


@pytest.mark.parametrize("model", MODELS, ids=lambda path: str(path.name))
def test_the_messages_of_a_model_have_the_hashes_that_colcon_built(model: Path) -> None:
    registry, folders = MessageRegistry.from_folder(model / "messages"), dict(built())
    for package in sorted(path.name for path in (model / "messages").iterdir()):
        if package not in folders or importlib.util.find_spec(package) is None:
            pytest.skip(f"{package} is not built here: `sequence-planner messages {model}`, then colcon build")
        theirs = hashes_of(folders[package])
        ours = {name: registry.type_hash(name) for name in registry.type_names() if name.startswith(f"{package}/")}
        assert ours
        assert ours == theirs


def test_the_types_of_ros_have_our_hashes() -> None:
    """Its messages, services and actions, and what is derived of those."""
    registry, compared = MessageRegistry.from_folder(None), 0
    for _, folder in built():
        for name, theirs in hashes_of(folder).items():
            with suppress(UnknownMessageTypeError):
                assert registry.type_hash(name) == theirs, name
                compared += 1
    if not compared:
        pytest.skip("no interfaces of ROS 2 are installed here: run this suite where ROS 2 Jazzy is sourced")
    assert compared > 100


def test_code_that_was_generated_from_another_definition_is_refused(tmp_path: Path) -> None:
    if (why := lacking(OURS)) is not None or importlib.util.find_spec("truck_engine_msgs") is None:
        pytest.skip(why or "truck_engine_msgs is not built here")
    shutil.copytree(REPOSITORY / "models" / "bolt_tightening" / "messages", tmp_path / "messages")
    changed = tmp_path / "messages" / "truck_engine_msgs" / "msg" / "RobotCommand.msg"
    changed.write_text(f"{changed.read_text()}float64 payload\n")
    registry = MessageRegistry.from_folder(tmp_path / "messages")

    async def scenario() -> None:
        opened = open_transport("rclpy", registry, "station", asyncio.get_running_loop(), DOMAIN)
        try:
            opened.advertise("/as_built", "truck_engine_msgs/msg/RobotState", QualityOfService.RELIABLE)
            with pytest.raises(TransportError, match="Build the package truck_engine_msgs again"):
                opened.advertise("/changed", CHANGED, QualityOfService.RELIABLE)
            with pytest.raises(TransportError, match="Build the package truck_engine_msgs again"):
                opened.subscribe("/changed", CHANGED, QualityOfService.RELIABLE, lambda batch: None)
        finally:
            opened.close()

    asyncio.run(scenario())
