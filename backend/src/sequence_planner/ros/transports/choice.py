"""The choice of the transport that a station runs on.

`auto` takes rclpy where ROS 2 is installed, since it speaks every vendor's DDS and its security, and DDS from PyPI
anywhere else. Neither is imported before it is chosen: a machine needs only the one it uses. That ROS 2 lies on the
path does not mean that it works there: it may be of another Python, or have lost a library. `auto` does without it
then, and says so.
"""

from __future__ import annotations

import asyncio
import importlib.util
import platform
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Literal

import structlog

from sequence_planner.ros.transport import Transport, TransportError

if TYPE_CHECKING:
    from sequence_planner.ros.transports.rclpy import RclpyTransport
    from sequence_planner.ros.types.messages import MessageRegistry

TransportChoice = Literal["auto", "rclpy", "cyclonedds"]

_log = structlog.get_logger(__name__)

_OVER_RCLPY = "sequence_planner.ros.transports.rclpy"
_PATIENCE = 60.0  # seconds for the import of rclpy


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
    transport = None if choice == "cyclonedds" else _rclpy_transport(choice)
    if transport is not None:
        return transport(registry, node_name, loop, domain_id)
    try:
        # Only the transport that is chosen may be imported: the other may not be installed.
        from sequence_planner.ros.transports.cyclonedds import CycloneTransport  # noqa: PLC0415
    except ImportError as error:
        raise TransportError(
            f"cyclonedds is not importable ({error}). PyPI has it for Linux on x86_64 and Python 3.11 to 3.13, "
            f"and this is {platform.machine()} with Python {platform.python_version()}; elsewhere use ROS 2 with rclpy"
        ) from error
    return CycloneTransport(registry, node_name, loop, domain_id)


def settled(choice: TransportChoice, say: Callable[[str], None]) -> TransportChoice:
    """Return the transport for all processes of a station, so that they agree; `say` gets what a person should know.

    What a broken installation does to whoever imports it is seen in a process that does nothing else. Raises
    TransportError when rclpy is a must and cannot be had.
    """
    if choice == "cyclonedds" or not _is_here(choice):
        return "cyclonedds"
    command = [sys.executable, "-c", f"import {_OVER_RCLPY}"]
    try:
        tried = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=_PATIENCE, check=False
        )
    except subprocess.TimeoutExpired:
        reason = f"it takes longer than {_PATIENCE:g} s"
    else:
        if tried.returncode == 0:
            return "rclpy"
        reason = (tried.stderr.strip().splitlines() or [f"it ends with code {tried.returncode}"])[-1]
    if choice == "rclpy":
        raise TransportError(_refusal(reason))
    say(_fallback(reason))
    return "cyclonedds"


def _rclpy_transport(choice: Literal["auto", "rclpy"]) -> type[RclpyTransport] | None:
    """Return the transport over rclpy; None where `auto` has to do without. Raises TransportError when it is a must."""
    if not _is_here(choice):
        return None
    try:
        from sequence_planner.ros.transports.rclpy import RclpyTransport  # noqa: PLC0415
    except Exception as error:  # whatever a broken installation raises
        reason = f"{type(error).__name__}: {error}".splitlines()[0]
        if choice == "rclpy":
            raise TransportError(_refusal(reason)) from error
        _warn_once(_fallback(reason))
        return None
    return RclpyTransport


@cache
def _warn_once(text: str) -> None:
    """Log what holds for all nodes of a process; emulated devices are one for each resource."""
    _log.warning(text)


def _is_here(choice: Literal["auto", "rclpy"]) -> bool:
    """Return whether there is an rclpy, working or not; raises TransportError where it is a must and there is none."""
    here = importlib.util.find_spec("rclpy") is not None
    if choice == "rclpy" and not here:
        raise TransportError(
            "rclpy is not importable: source the setup file of a ROS 2 installation first, or choose cyclonedds"
        )
    return here


def _fallback(reason: str) -> str:
    return f"cyclonedds is used instead of {_broken(reason)}"


def _refusal(reason: str) -> str:
    return f"cannot use {_broken(reason)}: mend that installation of ROS 2, or choose cyclonedds"


def _broken(reason: str) -> str:
    found = importlib.util.find_spec("rclpy")
    where = None if found is None else found.origin or next(iter(found.submodule_search_locations or ()), None)
    return f"the rclpy at {where}, which Python {platform.python_version()} cannot import ({reason})"
