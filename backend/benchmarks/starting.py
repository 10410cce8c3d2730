"""What it takes to start a station, and to have one: seconds, processor time, memory, processes; and small commands.

Run with `make bench`. Each station runs as its users run it, as a demonstration with emulated devices. It is heard when
its page is open and shows what its controller says, and ready when its safe states are known, too, and it may command
its devices (`/readyz`), for which it listens for 1.5 s whether somebody else does: with nothing known of its model, and
with all that an earlier run has found. How much of a core it takes at rest is measured before production is started,
once nothing is looked for any more; at work, while it makes one engine, with devices as slow as real ones. Commands are
measured as whole processes, the first time on a model and again.
"""

from __future__ import annotations

import contextlib
import http.client
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
from dataclasses import dataclass
from pathlib import Path

from stations.at_work import Person
from stations.processes import Process, station_processes

STATIONS = Path(__file__).parents[2] / "models"
MADE = {"bolt_tightening": "new_engine", "truck_engine_station": "release_engine"}  # what ends with an engine
SMALL = "single_bolt"
COMMANDS = ("plan", "show", "check")
STARTS = 5
AT_REST = 5  # processes, of a station of which all is known and nobody asks anything
LONGEST = 400.0  # seconds until it is at rest
LOOK = 30.0  # seconds for which it is looked what it takes
LONGEST_WORK = 600.0  # seconds until an engine is made
LOOK_EVERY = 1.0  # seconds, at work
ASK_EVERY = 0.02  # seconds: who asks all the time takes a core from it
PROGRAM = Path(sys.executable).with_name("sequence-planner")
PATIENCE = 60.0


def main() -> None:
    """Measure and print."""
    os.environ["ROS_DOMAIN_ID"] = str(1 + (os.getpid() + 15) % 100)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    with tempfile.TemporaryDirectory() as folder:
        for name in MADE:
            station(name, Path(folder) / name)
        for command in COMMANDS:
            small(command, Path(folder) / command)


def station(name: str, cache: Path) -> None:
    """Measure and print what it takes to start a station and to have one, with what it finds out in `cache`."""
    print(name)
    cold = []
    for _ in range(STARTS):
        shutil.rmtree(cache, ignore_errors=True)
        with started(name, cache) as (_, _, start):
            cold.append(start)
    print(f"  {told(cold)}, with nothing known")
    shutil.rmtree(cache, ignore_errors=True)
    with started(name, cache) as (launcher, port, _):
        before = time.monotonic()
        at_rest(launcher)
        print(
            f"  all is found {time.monotonic() - before:.0f} s later, with {used(launcher):.1f} s of a processor in all"
        )
        look(launcher)
        work(launcher, port, MADE[name])
    known = []
    for _ in range(STARTS):
        with started(name, cache) as (_, _, start):
            known.append(start)
    print(f"  {told(known)}, with all known", flush=True)


@dataclass(frozen=True)
class Start:
    """How many seconds it took on the wall and of a processor until a station was heard, and until it was ready."""

    heard: tuple[float, float]
    ready: tuple[float, float]


def told(starts: list[Start]) -> str:
    """Medians of what starts took."""
    return f"heard after {said([each.heard for each in starts])}, ready after {said([each.ready for each in starts])}"


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


def work(launcher: int, port: int, made: str) -> None:
    """Print what a station takes while it makes one engine, and each of its processes, with the most memory it had."""
    person = Person(port)
    person.begin()
    before = {each.number: each.seconds for each in station_processes(launcher)}
    began, looks = time.monotonic(), list[tuple[int, float]]()  # how many processes, and their memory
    found: dict[int, tuple[Process, float]] = {}
    while person.completed(made) == 0 and time.monotonic() - began < LONGEST_WORK:
        person.acknowledge()
        if time.monotonic() - began < len(looks) * LOOK_EVERY:
            continue
        with contextlib.suppress(OSError):  # one of them has ended just now
            now = {each: each.megabytes for each in station_processes(launcher)}
            looks.append((len(now), sum(now.values())))
            for each, memory in now.items():
                found[each.number] = each, max(memory, found[each.number][1] if each.number in found else 0.0)
    took = time.monotonic() - began
    person.leave()
    shares = {number: (each.seconds - before.get(number, 0.0)) / took for number, (each, _) in found.items()}
    counts, memories = zip(*looks, strict=True)
    print(
        f"  at work for {took:.0f} s {sum(shares.values()):.1%} of a core, {statistics.median(memories):.0f} MB "
        f"({max(memories):.0f} at most) in {statistics.median(counts):.0f} processes ({max(counts)} at most)"
    )
    for number, (each, memory) in found.items():
        print(f"    {shares[number]:6.1%} {memory:4.0f} MB  {called(each)}", flush=True)


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
        [PROGRAM, command, str(STATIONS / SMALL)],
        env={**os.environ, "XDG_CACHE_HOME": str(cache)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=False,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.perf_counter() - began, processor


@contextmanager
def started(name: str, cache: Path) -> Iterator[tuple[int, int, Start]]:
    """A station that is ready: the number of its launcher, its port, and what it took."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [str(PROGRAM), "run", str(STATIONS / name), "--port", str(port), "--emulator", "--demonstration"]
    began = time.perf_counter()
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache)}
    launcher = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def when(path: str) -> tuple[float, float]:
        while not is_fine(port, path):
            if time.perf_counter() - began > PATIENCE:
                raise TimeoutError(f"{name} did not answer {path} within {PATIENCE:g} s")
            time.sleep(ASK_EVERY)
        return time.perf_counter() - began, used(launcher.pid)

    try:
        yield launcher.pid, port, Start(heard=when("/healthz"), ready=when("/readyz"))
    finally:
        launcher.terminate()
        launcher.wait(PATIENCE)


def is_fine(port: int, path: str) -> bool:
    """Whether the server of a station answers there that all is well."""
    asking = http.client.HTTPConnection("127.0.0.1", port, timeout=1.0)
    with contextlib.closing(asking):
        try:
            asking.request("GET", path)
            return asking.getresponse().status == 200
        except (OSError, http.client.HTTPException):
            return False


def used(launcher: int) -> float:
    """Seconds of a processor that all processes of a station have used, those that have ended included."""
    return sum(each.seconds for each in station_processes(launcher))


if __name__ == "__main__":
    main()
