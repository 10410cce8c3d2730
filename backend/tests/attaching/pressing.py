"""The press: its definitions, and its process on the network."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from sequence_planner.ros.transports.cyclonedds_network import loopback_configuration
from sequence_planner.ros.types.messages import MessageRegistry
from support.places import CELL

DOMAIN = 1 + (os.getpid() + 30) % 100
MESSAGES = {
    "PressState": "bool closed\nuint8 mode\nfloat64 force\nstring program\nfloat64[2] position\nTool tool\n",
    "Tool": "bool locked\nstring<=8 name\n",
    "PressCommand": "bool close\nfloat64 speed\nstring program\n",
    "Nothing": "builtin_interfaces/Time stamp\n",
}


def press_messages(folder: Path) -> Path:
    """A folder with the definitions."""
    definitions = folder / "press_msgs" / "msg"
    definitions.mkdir(parents=True)
    for name, fields in MESSAGES.items():
        (definitions / f"{name}.msg").write_text(fields, encoding="utf-8")
    return folder


def press_registry(folder: Path) -> MessageRegistry:
    """A registry that knows them."""
    return MessageRegistry.from_folder(press_messages(folder))


def station(folder: Path) -> Path:
    """A cell that knows nothing of the press."""
    return Path(shutil.copytree(CELL, folder / "cell"))


@contextlib.contextmanager
def press(folder: Path) -> Iterator[None]:
    """Run the device for as long as the block lasts."""
    environ = os.environ | {"CYCLONEDDS_URI": loopback_configuration(), "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    script, messages = Path(__file__).with_name("device.py"), press_messages(folder)
    command = [sys.executable, str(script), str(DOMAIN), str(messages)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environ, text=True) as process:
        try:
            assert process.stdin is not None
            assert process.stdout is not None
            assert process.stdout.readline() == "there\n"
            yield
            process.stdin.close()
            assert process.wait(10) == 0
        finally:
            process.kill()
