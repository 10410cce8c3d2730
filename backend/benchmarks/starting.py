"""What it takes to start a station, and to have one: seconds, processor time, memory, processes.

Run with `make bench`. Each station runs as its users run it, as a demonstration with emulated devices whose production
starts at once. It is ready when its server hears its controller. How much of a core it takes is measured later, while
it waits for its operator. With `details` it says so of each process.
"""

from __future__ import annotations

import os
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
from stations.processes import station_processes

STATIONS = Path(__file__).parents[2] / "models"
NAMES = ("bolt_tightening", "truck_engine_station")
STARTS = 5
SETTLED = 20.0  # seconds after the start
LOOK = 10.0  # seconds for which it is looked what it takes
PATIENCE = 60.0


def main() -> None:
    """Measure and print."""
    os.environ["ROS_DOMAIN_ID"] = str(1 + (os.getpid() + 15) % 100)
    for name in NAMES:
        starts = []
        for _ in range(STARTS):
            with started(name) as (launcher, seconds):
                starts.append((seconds, used(launcher)))
        ready, processor = (statistics.median(each) for each in zip(*starts, strict=True))
        print(f"{name}: ready after {ready:.2f} s, with {processor:.1f} s of a processor (medians of {STARTS})")
        with started(name) as (launcher, seconds):
            time.sleep(SETTLED - seconds)
            print(f"  {SETTLED:g} s after the start {used(launcher):.1f} s")
            before = {each.number: each.seconds for each in station_processes(launcher)}
            time.sleep(LOOK)
            now = station_processes(launcher)
            share = sum(each.seconds - before.get(each.number, 0.0) for each in now) / LOOK
            memory = sum(each.megabytes for each in now)
            print(f"  then {share:.1%} of a core, {memory:.0f} MB in {len(now)} processes", flush=True)
            if "details" in sys.argv[1:]:
                for each in now:
                    percent = (each.seconds - before.get(each.number, 0.0)) / LOOK
                    print(f"    {percent:6.1%} {each.megabytes:4.0f} MB  {each.title[:60]}")


@contextmanager
def started(name: str) -> Iterator[tuple[int, float]]:
    """A station, and how many seconds it took until it was ready: the number of its launcher comes first."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "sequence_planner.cli", "run", str(STATIONS / name), "--port", str(port)]
    options = ["--emulator", "--start", "--demonstration"]
    began = time.perf_counter()
    launcher = subprocess.Popen([*command, *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while not is_ready(port):
            if time.perf_counter() - began > PATIENCE:
                raise TimeoutError(f"{name} was not ready within {PATIENCE:g} s")
            time.sleep(0.01)
        yield launcher.pid, time.perf_counter() - began
    finally:
        launcher.terminate()
        launcher.wait(PATIENCE)


def is_ready(port: int) -> bool:
    """Whether the server of a station answers that it hears its controller."""
    try:
        answer = httpx.get(f"http://127.0.0.1:{port}/healthz", timeout=1.0)
    except httpx.HTTPError:
        return False
    return answer.is_success and answer.json()["controller"] == "heard"


def used(launcher: int) -> float:
    """Seconds of a processor that all processes of a station have used, those that have ended included."""
    return sum(each.seconds for each in station_processes(launcher))


if __name__ == "__main__":
    sys.exit(main())
