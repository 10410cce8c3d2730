"""What it takes to start a station, and to have one: seconds, processor time, memory, processes; and small commands.

Run with `make bench`. Each station runs as its users run it, as a demonstration with emulated devices. It is ready when
its server hears its controller: with nothing known of its model, and with all that an earlier run has found. How much
of a core it takes at rest is measured before production is started, once nothing is looked for any more. Commands are
measured as whole processes, the first time on a model and again.
"""

from __future__ import annotations

import os
import resource
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
from stations.processes import Process, station_processes

STATIONS = Path(__file__).parents[2] / "models"
NAMES = ("bolt_tightening", "truck_engine_station")
SMALL = "single_bolt"
COMMANDS = ("plan", "show", "check")
STARTS = 5
AT_REST = 5  # processes, of a station of which all is known and nobody asks anything
LONGEST = 400.0  # seconds until it is at rest
LOOK = 30.0  # seconds for which it is looked what it takes
PATIENCE = 60.0


def main() -> None:
    """Measure and print."""
    os.environ["ROS_DOMAIN_ID"] = str(1 + (os.getpid() + 15) % 100)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    with tempfile.TemporaryDirectory() as folder:
        for name in NAMES:
            station(name, Path(folder) / name)
        for command in COMMANDS:
            small(command, Path(folder) / command)


def station(name: str, cache: Path) -> None:
    """Measure and print what it takes to start a station and to have one, with what it finds out in `cache`."""
    print(name)
    cold = []
    for _ in range(STARTS):
        shutil.rmtree(cache, ignore_errors=True)
        with started(name, cache) as (launcher, seconds):
            cold.append((seconds, used(launcher)))
    print(f"  ready after {said(cold)}, with nothing known")
    shutil.rmtree(cache, ignore_errors=True)
    with started(name, cache) as (launcher, _):
        before = time.monotonic()
        at_rest(launcher)
        print(
            f"  all is found {time.monotonic() - before:.0f} s later, with {used(launcher):.1f} s of a processor in all"
        )
        look(launcher)
    known = []
    for _ in range(STARTS):
        with started(name, cache) as (launcher, seconds):
            known.append((seconds, used(launcher)))
    print(f"  ready after {said(known)}, with all known", flush=True)


def said(starts: list[tuple[float, float]]) -> str:
    """Medians of seconds on the wall and of a processor."""
    ready, processor = (statistics.median(each) for each in zip(*starts, strict=True))
    return f"{ready:.2f} s ({processor:.2f} s of a processor; medians of {len(starts)})"


def at_rest(launcher: int) -> None:
    """Wait until nothing is looked for any more."""
    began, since = time.monotonic(), None
    while since is None or time.monotonic() - since < LOOK:  # what is put off begins by then
        if len(station_processes(launcher)) > AT_REST:
            since = None
        elif since is None:
            since = time.monotonic()
        if time.monotonic() - began > LONGEST:
            print(f"  not at rest after {LONGEST:g} s")
            return
        time.sleep(0.5)


def look(launcher: int) -> None:
    """Print the processes of a station, and what each of them takes."""
    before = {each.number: each.seconds for each in station_processes(launcher)}
    time.sleep(LOOK)
    now = station_processes(launcher)
    shares = {each.number: (each.seconds - before.get(each.number, 0.0)) / LOOK for each in now}
    memory = {each.number: each.megabytes for each in now}
    print(f"  at rest {sum(shares.values()):.1%} of a core, {sum(memory.values()):.0f} MB in {len(now)} processes")
    for each in now:
        print(f"    {shares[each.number]:6.1%} {memory[each.number]:4.0f} MB  {called(each)}", flush=True)


def called(process: Process) -> str:
    """What a process is called: its command, or its title."""
    for name in ("run", "controller", "server", "emulate"):
        if process.runs(name) or f"sequence-planner {name} " in process.title:
            return name
    return process.title


def small(command: str, cache: Path) -> None:
    """Measure and print what a command takes on a small model, as a whole process."""
    first, again = [], []
    for _ in range(STARTS):
        shutil.rmtree(cache, ignore_errors=True)
        first.append(taken(command, cache))
        again.append(taken(command, cache))
    print(f"{command} {SMALL}: {said(first)} the first time, {said(again)} again", flush=True)


def taken(command: str, cache: Path) -> tuple[float, float]:
    """Seconds on the wall and of a processor."""
    began, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, "-m", "sequence_planner.cli", command, str(STATIONS / SMALL)],
        env={**os.environ, "XDG_CACHE_HOME": str(cache)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=False,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.perf_counter() - began, processor


@contextmanager
def started(name: str, cache: Path) -> Iterator[tuple[int, float]]:
    """A station, and how many seconds it took until it was ready: the number of its launcher comes first."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "sequence_planner.cli", "run", str(STATIONS / name), "--port", str(port)]
    options = ["--emulator", "--demonstration"]
    began = time.perf_counter()
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache)}
    launcher = subprocess.Popen(
        [*command, *options], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
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
    main()
