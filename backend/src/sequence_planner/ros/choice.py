"""Which transport a station runs on.

`auto` takes rclpy where ROS 2 is installed, since it speaks every vendor's DDS and its security, and DDS from PyPI
anywhere else. Neither is imported before it is chosen: a machine needs only the one it uses.
"""

from __future__ import annotations

import asyncio
import importlib.util
import platform
from typing import Literal

from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Transport, TransportError

TransportChoice = Literal["auto", "rclpy", "cyclonedds"]


def open_transport(
    choice: TransportChoice,
    registry: MessageRegistry,
    node_name: str,
    loop: asyncio.AbstractEventLoop,
    domain_id: int | None = None,
) -> Transport:
    """Join the ROS 2 network as the node `node_name`, on the domain `domain_id` (None: as ROS_DOMAIN_ID says).

    Raises TransportError when the transport cannot start, saying what to do, and ValueError for a bad node name.
    """
    rclpy_here = importlib.util.find_spec("rclpy") is not None
    if choice == "rclpy" or (choice == "auto" and rclpy_here):
        if not rclpy_here:
            raise TransportError(
                "rclpy is not importable: source the setup file of a ROS 2 installation first, or choose cyclonedds"
            )
        # Only the transport that is chosen may be imported: the other may not be installed.
        from sequence_planner.ros.rclpy_transport import RclpyTransport  # noqa: PLC0415

        return RclpyTransport(registry, node_name, loop, domain_id)
    try:
        from sequence_planner.ros.cyclone import CycloneTransport  # noqa: PLC0415
    except ImportError as error:
        raise TransportError(
            f"cyclonedds is not importable ({error}). PyPI has it for Linux on x86_64 and Python 3.11 to 3.13, "
            f"and this is {platform.machine()} with Python {platform.python_version()}; elsewhere use ROS 2 with rclpy"
        ) from error
    return CycloneTransport(registry, node_name, loop, domain_id)
