"""Peers of other ROS 2 implementations: programs built from the sources beside this file, and run as processes.

They share neither code nor codec with the station. What builds them, `make foreign` installs; a machine that has not
got it skips their tests and says so. Built programs are kept in `.built`, under a hash of their sources.
"""

from __future__ import annotations

import asyncio
import hashlib
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from support.waiting import PATIENCE

FAST_DDS, ROS2_CLIENT = "fast_dds", "ros2_client"
HERE = Path(__file__).parent
BUILT = HERE / ".built"
HEADER = Path("/usr/include/fastdds/dds/topic/TopicDataType.hpp")
RUST = (1, 88)
COMPILATION = 900.0  # seconds; a crate's first compilation takes two minutes on two cores


def missing(peer: str) -> str | None:
    """What this machine lacks to build a peer, and how to get it; None when it can be built."""
    if peer == FAST_DDS and (shutil.which("g++") is None or not HEADER.exists()):
        return "Fast DDS is not installed: `make foreign`, or sudo apt-get install g++ libfastrtps-dev"
    if peer == ROS2_CLIENT and _rust() < RUST:
        return f"ros2-client needs Rust {'.'.join(map(str, RUST))} or later, with cargo: install it"
    return None


def _rust() -> tuple[int, ...]:
    """The version of cargo, which is Rust's; () where there is none."""
    if shutil.which("cargo") is None:
        return ()
    said = subprocess.run(["cargo", "--version"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"(\d+)\.(\d+)", said)
    return tuple(map(int, found.groups())) if found else ()


def built(peer: str) -> Path:
    """The program of a peer, built if its sources are new. Skips the test where it cannot be built."""
    lacking = missing(peer)
    if lacking is not None:
        pytest.skip(lacking)
    return build(peer)


def build(peer: str) -> Path:
    """Build the program of a peer unless it is there; raises CalledProcessError when it does not compile."""
    sources = HERE / peer
    digest = hashlib.sha256(platform.machine().encode())
    for source in sorted(path for path in sources.rglob("*") if path.is_file()):
        digest.update(source.read_bytes())
    program = BUILT / f"{peer}-{digest.hexdigest()[:16]}"
    if not program.exists():
        BUILT.mkdir(exist_ok=True)
        made = _compile(sources) if peer == FAST_DDS else _compile_crate(sources)
        made.replace(program)
    return program


def _compile(sources: Path) -> Path:
    made = BUILT / "fast_dds.new"
    files = [str(source) for source in sorted(sources.glob("*.cpp"))]
    command = ["g++", "-std=c++17", "-Wall", "-Wextra", "-o", str(made), *files, "-lfastrtps", "-lfastcdr"]
    subprocess.run(command, check=True, timeout=COMPILATION)
    return made


def _compile_crate(sources: Path) -> Path:
    """Compile in a copy: cargo writes beside the sources what it has found."""
    crate = BUILT / "crate"
    shutil.copytree(sources, crate, dirs_exist_ok=True)
    subprocess.run(["cargo", "build", "--quiet"], cwd=crate, check=True, timeout=COMPILATION)
    return crate / "target" / "debug" / "peer"


@dataclass
class Peer:
    """A peer that runs, and the lines that it has printed."""

    process: asyncio.subprocess.Process
    lines: list[str] = field(default_factory=list)

    async def listen(self) -> None:
        """Take the lines it prints until it ends."""
        assert self.process.stdout is not None
        async for line in self.process.stdout:
            self.lines.append(line.decode().rstrip())


@asynccontextmanager
async def running(program: Path, domain: int, *role: str) -> AsyncIterator[Peer]:
    """Run a peer in a role, and see it end well when its input ends."""
    process = await asyncio.create_subprocess_exec(
        str(program), str(domain), *role, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    peer = Peer(process)
    listening = asyncio.create_task(peer.listen())
    try:
        yield peer
        assert process.stdin is not None
        process.stdin.close()
        assert await asyncio.wait_for(process.wait(), PATIENCE) == 0
        await listening
    finally:
        listening.cancel()
        with suppress(ProcessLookupError):
            process.kill()
        await process.wait()


if __name__ == "__main__":
    for name in (FAST_DDS, ROS2_CLIENT):
        lacking = missing(name)
        if lacking is None:
            build(name)
        else:
            sys.stderr.write(f"Tests with {name} are skipped. {lacking}\n")
