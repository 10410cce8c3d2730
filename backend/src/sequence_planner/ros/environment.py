"""ROS 2 environment: domain, discovery range, interface, SROS 2 enclaves and DDS vendor ids."""

from __future__ import annotations

import os
import socket
from collections.abc import Mapping
from enum import StrEnum
from typing import Final
from uuid import UUID

from sequence_planner.ros.transport import TransportError

# What the environment says about the ROS 2 network.
#
# `ROS_DOMAIN_ID` and `ROS_AUTOMATIC_DISCOVERY_RANGE` mean what they mean to every ROS 2 program, with one difference: a
# range nobody set is LOCALHOST here and SUBNET there. A station that commands machines joins a network only when told
# to. ROS 2 has no variable for the network interface, so it is `SEQUENCE_PLANNER_INTERFACE`, by name as in `eth0`.

DOMAIN_ID = "ROS_DOMAIN_ID"
DISCOVERY_RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
INTERFACE = "SEQUENCE_PLANNER_INTERFACE"
SECURITY = "ROS_SECURITY_ENABLE"

#: The highest domain whose UDP ports exist.
_LAST_DOMAIN = 232


class DiscoveryRange(StrEnum):
    """The distance to look for peers."""

    LOCALHOST = "LOCALHOST"
    SUBNET = "SUBNET"
    SYSTEM_DEFAULT = "SYSTEM_DEFAULT"  # as the middleware's own configuration says
    OFF = "OFF"


def domain_id(wanted: int | None, environ: Mapping[str, str] = os.environ) -> int:
    """Return the domain to join: `wanted`, else ROS_DOMAIN_ID, else 0; raises TransportError when it is none."""
    text = str(wanted) if wanted is not None else environ.get(DOMAIN_ID) or "0"
    if not text.isascii() or not text.isdecimal() or int(text) > _LAST_DOMAIN:
        raise TransportError(f"{DOMAIN_ID} is {text!r}: give a number from 0 to {_LAST_DOMAIN}")
    return int(text)


def discovery_range(environ: Mapping[str, str] = os.environ) -> DiscoveryRange:
    """Return the range to look for peers in; raises TransportError when the environment names none."""
    text = environ.get(DISCOVERY_RANGE) or DiscoveryRange.LOCALHOST
    try:
        return DiscoveryRange(text.upper())
    except ValueError:
        known = ", ".join(DiscoveryRange)
        raise TransportError(f"{DISCOVERY_RANGE} is {text!r}: give one of {known}") from None


def interface(reach: DiscoveryRange, environ: Mapping[str, str] = os.environ) -> str | None:
    """Return the network interface to use with the range SUBNET; None leaves the choice to the middleware.

    Raises TransportError for one that this computer lacks, or that the range `reach` does not leave to be chosen.
    """
    name = environ.get(INTERFACE)
    if not name:
        return None
    there = [known for _, known in socket.if_nameindex()]
    if name not in there:
        raise TransportError(f"{INTERFACE} is {name!r}, and this computer has {', '.join(there)}: give one of these")
    if reach is DiscoveryRange.LOCALHOST:
        raise TransportError(
            f"{INTERFACE} is {name!r}, and {DISCOVERY_RANGE} is LOCALHOST, which stays on this computer: "
            "set the range to SUBNET, or leave the interface out"
        )
    if reach is DiscoveryRange.SYSTEM_DEFAULT:
        raise TransportError(
            f"{INTERFACE} is {name!r}, and {DISCOVERY_RANGE} is SYSTEM_DEFAULT, with which the middleware's own "
            "configuration (CYCLONEDDS_URI) names the interface: set the range to SUBNET, or leave the interface out"
        )
    return name


def refuse_interface(environ: Mapping[str, str] = os.environ) -> None:
    """Raise TransportError when an interface is named and rclpy is used, where each middleware has its own way."""
    if environ.get(INTERFACE):
        raise TransportError(
            f"{INTERFACE} is {environ[INTERFACE]!r}, which rclpy cannot pass on: name the interface in the "
            "configuration of its middleware (CYCLONEDDS_URI, FASTDDS_DEFAULT_PROFILES_FILE), and unset it"
        )


def security_wanted(environ: Mapping[str, str] = os.environ) -> bool:
    """Return whether the environment asks for DDS Security (SROS 2)."""
    return environ.get(SECURITY, "").lower() == "true"


# Which enclave of SROS 2 each node of this program belongs to: who shares one shares its key and its rights.

OVERRIDE: Final = "ROS_SECURITY_ENCLAVE_OVERRIDE"  # ROS 2's own variable; it comes before what is said here
CONTROLLER: Final = "/sequence_planner/controller"
EMULATED: Final = "/sequence_planner/emulated_devices"
TOOLS: Final = (
    "/sequence_planner/tools"  # what people look and intervene with at the command line, and the page's graph
)
DEVICES: Final = "/sequence_planner/devices"  # below it, one for each resource

_OF_NODES: Final = {
    "sequence_planner": CONTROLLER,
    "sequence_planner_check": CONTROLLER,
    "emulated_devices": EMULATED,
    "emulated_devices_check": EMULATED,
}


def enclave_of(node: str) -> str:
    """The enclave of a node, by its name."""
    return _OF_NODES.get(node, TOOLS)


def arguments(node: str, environ: Mapping[str, str] = os.environ) -> list[str]:
    """Return what the context of a node is told of its enclave: nothing without security, or where ROS 2 is told
    itself.
    """
    if not security_wanted(environ) or environ.get(OVERRIDE):
        return []
    return ["--ros-args", "--enclave", enclave_of(node)]


# Whose DDS a peer uses, by the number that its participant bears.

#: Vendor identifiers as the OMG has assigned them (https://www.dds-foundation.org/dds-vendor-ids).
_VENDORS = {
    0x0101: "RTI Connext DDS",
    0x0102: "ADLINK OpenSplice DDS",
    0x0103: "OCI OpenDDS",
    0x0106: "TwinOaks CoreDX DDS",
    0x010A: "RTI Connext DDS Micro",
    0x010F: "eProsima Fast DDS",
    0x0110: "Eclipse Cyclone DDS",
    0x0111: "GurumDDS",
    0x0112: "RustDDS",
    0x0114: "Dust DDS",
}

#: The middleware of ROS 2 that each runs under, as RMW_IMPLEMENTATION names it.
_MIDDLEWARES = {
    "RTI Connext DDS": "rmw_connextdds",
    "eProsima Fast DDS": "rmw_fastrtps_cpp",
    "Eclipse Cyclone DDS": "rmw_cyclonedds_cpp",
    "GurumDDS": "rmw_gurumdds_cpp",
}


def worded(vendor: str | None) -> str:
    """Return what to call a vendor's DDS, with ROS 2's name for it.

    >>> worded("eProsima Fast DDS")
    'eProsima Fast DDS (rmw_fastrtps_cpp)'
    """
    middleware = _MIDDLEWARES.get(vendor or "")
    return f"{vendor} ({middleware})" if middleware else vendor or "another DDS"


def vendor_of(participant: UUID) -> str | None:
    """Return the vendor in the first two bytes of a participant's identifier, where RTPS puts it; None if unknown."""
    return _VENDORS.get(int.from_bytes(participant.bytes[:2]))
