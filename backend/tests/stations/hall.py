"""The whole station as it would stand in a hall: a world, its computers and the controller, each a process of its own.

Everything meets over DDS on the loopback, and over the world's port there. Processes are ended by their ids.
"""

from __future__ import annotations

import json
import shutil
import signal
import socket
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx

from sequence_planner.simulation.truck_station.signals import COMPUTERS
from support.network import free_port
from support.places import REPOSITORY
from support.station import RunningStation, environment
from support.waiting import PATIENCE, until

MODEL = Path("models") / "truck_engine_station"


def started(log: Path, *arguments: str) -> subprocess.Popen[bytes]:
    """A process of ours that runs a module."""
    with log.open("ab") as out:
        return subprocess.Popen(
            [sys.executable, "-m", *arguments], cwd=REPOSITORY, env=environment(), stdout=out, stderr=out
        )


def ended(process: subprocess.Popen[bytes]) -> None:
    """End a process of ours, if it still runs."""
    if process.poll() is None:
        process.send_signal(signal.SIGTERM)
        try:
            process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@dataclass
class Hall:
    """What a test or a campaign sees and does there."""

    folder: Path
    port: int
    mir_port: int
    nodes: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    def ask(self, question: Mapping[str, object]) -> dict[str, Any]:
        """One document of the world's server for another."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=10) as link, link.makefile("rw") as lines:
            lines.write(json.dumps(question) + "\n")
            lines.flush()
            answer: dict[str, Any] = json.loads(lines.readline())
        assert "error" not in answer, answer
        return answer

    def up(self) -> bool:
        """Whether the world answers."""
        try:
            return bool(self.ask({"verdict": True}))
        except OSError:
            return False

    def start(self, node: str) -> None:
        """Start a node."""
        self.nodes[node] = started(
            self.folder / f"{node}.log",
            "sequence_planner.simulation.truck_station",
            node,
            "--port",
            str(self.port),
            "--mir-port",
            str(self.mir_port),
            "--messages",
            str(MODEL / "messages"),
        )

    def kill(self, node: str) -> None:
        """End a node without warning."""
        self.nodes[node].kill()
        self.nodes[node].wait()

    def end(self) -> None:
        """End all nodes."""
        for process in self.nodes.values():
            ended(process)

    @property
    def counted(self) -> Counter[str]:
        """How often each event has been."""
        return Counter(event for _, event in self.ask({"verdict": True})["events"])

    @property
    def wrong(self) -> list[str]:
        """What must never have been."""
        found: list[str] = self.ask({"verdict": True})["wrong"]
        return found


@contextmanager
def hall(folder: Path, speed: float = 1.0, seed: int = 0) -> Iterator[Hall]:
    """A world and its computers. Logs go to `folder`."""
    place = Hall(folder, free_port(), free_port())
    world = started(
        folder / "world.log",
        "sequence_planner.simulation.truck_station",
        *("world", "--port", str(place.port), "--mir-port", str(place.mir_port)),
        *("--speed", str(speed), "--seed", str(seed)),
    )
    with ExitStack() as stack:
        stack.callback(ended, world)
        stack.callback(place.end)
        until(place.up)
        for node in COMPUTERS:
            place.start(node)
        yield place


@contextmanager
def controlled(folder: Path) -> Iterator[RunningStation]:
    """The controller of the station, with production started. It remembers nothing of another hall."""
    port, log = free_port(), folder / "controller.log"
    model = shutil.copytree(REPOSITORY / MODEL, folder / MODEL.name)  # its database is its own
    process = started(log, "sequence_planner.cli", "run", str(model), "--port", str(port))
    try:
        seen = RunningStation(process, port, log)
        until(seen.up, seconds=4 * PATIENCE)

        def at_work() -> bool:
            try:
                seen.post("production/start", {})
                return bool(seen.get("production", "station") == "started")
            except httpx.HTTPError:
                return False  # a busy machine answers too late

        until(at_work)
        yield seen
    finally:
        ended(process)
