"""What the environment says about the ROS 2 network.

`ROS_DOMAIN_ID` and `ROS_AUTOMATIC_DISCOVERY_RANGE` mean what they mean to every ROS 2 program, with one difference: a
range nobody set is LOCALHOST here and SUBNET there. A station that commands machines joins a network only when told to.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from enum import StrEnum

from sequence_planner.ros.transport import TransportError

DOMAIN_ID = "ROS_DOMAIN_ID"
DISCOVERY_RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
SECURITY = "ROS_SECURITY_ENABLE"

#: The highest domain whose UDP ports exist.
_LAST_DOMAIN = 232


class DiscoveryRange(StrEnum):
    """How far to look for peers."""

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


def security_wanted(environ: Mapping[str, str] = os.environ) -> bool:
    """Return whether the environment asks for DDS Security (SROS 2)."""
    return environ.get(SECURITY, "").lower() == "true"
