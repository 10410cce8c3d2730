"""Peers in processes of their own, on the loopback interface."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from sequence_planner.ros.transports.cyclonedds_network import loopback_configuration
from support.network import DOMAIN


async def start(kind: str) -> asyncio.subprocess.Process:
    """Start `ros_peer.py` beside this process."""
    # SUBNET takes the configuration from CYCLONEDDS_URI, which keeps the peer on the loopback interface all the same.
    environ = os.environ | {
        "CYCLONEDDS_URI": loopback_configuration(),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
    }
    command = [sys.executable, "-W", "error", str(Path(__file__).with_name("ros_peer.py")), kind, str(DOMAIN)]
    return await asyncio.create_subprocess_exec(*command, stdin=subprocess.PIPE, env=environ)


@asynccontextmanager
async def peer(kind: str) -> AsyncIterator[asyncio.subprocess.Process]:
    """Run `ros_peer.py`, and see it end well unless the test has killed it."""
    process = await start(kind)
    try:
        yield process
        if process.returncode is None:
            assert process.stdin is not None
            process.stdin.close()
            assert await asyncio.wait_for(process.wait(), 10) == 0
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
