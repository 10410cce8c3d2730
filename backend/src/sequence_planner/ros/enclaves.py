"""Which enclave of SROS 2 each node of this program belongs to: who shares one shares its key and its rights."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Final

from sequence_planner.ros.environment import security_wanted

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
    """What the context of a node is told of its enclave: nothing without security, or where ROS 2 is told itself."""
    if not security_wanted(environ) or environ.get(OVERRIDE):
        return []
    return ["--ros-args", "--enclave", enclave_of(node)]
