"""Nodes of genuine ROS 2 beside a station, wherever rclpy and one of its middlewares are installed."""

from __future__ import annotations

import asyncio
import importlib.util
import os
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from foreign.peers import HERE, Peer
from support.waiting import PATIENCE, until_async

CYCLONE, FAST = "rmw_cyclonedds_cpp", "rmw_fastrtps_cpp"
NEEDED = ("rclpy", "std_msgs", "geometry_msgs", "example_interfaces")


def lacking(rmw: str) -> str | None:
    """What is not installed here; None when a peer on the middleware `rmw` can run."""
    for package in NEEDED:
        if importlib.util.find_spec(package) is None:
            return f"{package} is not importable here: run this suite where ROS 2 Jazzy is installed"
    folders = os.environ.get("LD_LIBRARY_PATH", "").split(":")
    if not any((Path(folder) / f"lib{rmw}.so").exists() for folder in folders):
        return f"{rmw} is not installed in this ROS 2"
    return None


@dataclass
class Genuine(Peer):
    """A genuine node that runs; `complaints` is what it has written to its standard error."""

    complaints: list[str] = field(default_factory=list)

    async def heed(self) -> None:
        """Take its complaints until it ends."""
        assert self.process.stderr is not None
        async for line in self.process.stderr:
            self.complaints.append(line.decode().rstrip())

    async def told(self, line: str, answer: str) -> str:
        """Tell it a line, and return what it prints that begins so, without that beginning."""
        assert self.process.stdin is not None
        self.lines.clear()
        self.process.stdin.write(f"{line}\n".encode())
        return await self.says(answer)

    async def says(self, answer: str) -> str:
        """Wait until it prints what begins so, and return the rest of that line."""
        found: list[str] = []

        def printed() -> bool:
            found[:] = [each.removeprefix(f"{answer} ") for each in self.lines if each.split(" ")[0] == answer]
            return bool(found)

        await until_async(printed, f"the peer says {answer}; it said {self.lines} and {self.complaints}")
        return found[0]


@asynccontextmanager
async def genuine(rmw: str, domain: int) -> AsyncIterator[Genuine]:
    """Run a genuine node, and see it end well unless the test has killed it; skips where it cannot run."""
    why = lacking(rmw)
    if why is not None:
        pytest.skip(why)
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        str(HERE / "jazzy" / "peer.py"),
        str(domain),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "RMW_IMPLEMENTATION": rmw, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"},
    )
    peer = Genuine(process)
    listening = asyncio.gather(peer.listen(), peer.heed())
    try:
        await peer.says("ready")
        yield peer
        if process.returncode is None:
            assert process.stdin is not None
            process.stdin.close()
            assert await asyncio.wait_for(process.wait(), PATIENCE) == 0, peer.complaints
    finally:
        with suppress(ProcessLookupError):
            process.kill()
        await process.wait()
        await listening
