"""Which transport a station gets, and what it is told when it cannot have it."""

from __future__ import annotations

import asyncio
import importlib.util
import sys

import pytest
from ros_networks import standard

from sequence_planner.ros.transport import TransportError
from sequence_planner.ros.transports.choice import TransportChoice, open_transport
from support.network import DOMAIN

RCLPY = importlib.util.find_spec("rclpy") is not None


def opened(choice: TransportChoice) -> str:
    """Open a transport, close it, and return its name."""

    async def scenario() -> str:
        transport = open_transport(choice, standard(), "station", asyncio.get_running_loop(), DOMAIN)
        transport.close()
        return transport.name

    return asyncio.run(scenario())


def test_auto_prefers_rclpy_and_does_without() -> None:
    assert opened("auto") == ("rclpy" if RCLPY else "cyclonedds")
    assert opened("cyclonedds") == "cyclonedds"


def test_a_computer_without_rclpy_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(TransportError, match="source the setup file of a ROS 2 installation"):
        opened("rclpy")


def test_a_computer_without_cyclonedds_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sequence_planner.ros.transports.cyclonedds", None)
    with pytest.raises(TransportError, match=r"cyclonedds is not importable.*elsewhere use ROS 2 with rclpy"):
        opened("cyclonedds")
