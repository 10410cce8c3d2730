"""Ticks of a running station with its journal, beside planning, synthesis and many who look on and ask.

Run with `make bench`. The truck engine station runs as its users run it, in processes of its own over DDS, with a
database of SQLite on the disk; only its controller notes beside how long each turn with ticks took, on the wall, and
how long after it what has happened was durable. Tasks are acknowledged at once. It runs alone, then while the same
station is synthesised over and over and some look on, then in turns alone and with a crowd that looks on and asks. In
the end the controller is killed again and again, and it is seen how long it takes until the station is shown again.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import os
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import httpx
from stations.processes import part
from websockets.asyncio.client import connect

from sequence_planner.controller.controller import Controller
from sequence_planner.controller.features.records import Records
from sequence_planner.core.clock import Timestamp
from sequence_planner.program import main as program

STATION = Path(__file__).parents[2] / "models" / "truck_engine_station"
DOMAIN = 1 + (os.getpid() + 5) % 100
CLIENTS, CROWD = 50, 200
RATE = 100  # requests a second of a crowd
ASKED = ("station", "tasks", "alarms", "state", "job-orders?limit=20", "capabilities", "events?after=0&limit=20")
SECONDS = 60.0
TURNS = 4  # of a crowd
ELSEWHERE = 15  # niceness of those who would be at other machines
RESTARTS = 7
BETWEEN = 20.0  # seconds between restarts
PATIENCE = 120.0  # seconds
VIEW = 0.2  # seconds within which a view that was on its way has come
NOTES = "SEQUENCE_PLANNER_BENCHMARK_NOTES"


def main() -> None:
    """Measure and print."""
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    with tempfile.TemporaryDirectory(prefix="ticking-") as folder, Parts(Path(folder)) as parts:
        client = signed_in(parts.address)
        wait_for(lambda: production(client) == "started")
        say(f"alone, {SECONDS:g} s", parts.measured(client, SECONDS))
        watching = ("clients", parts.address, session(client), str(CLIENTS))
        with parts.beside("synthesising"), parts.beside(*watching):
            time.sleep(5.0)  # until all of them look on
            say(f"with synthesis and {CLIENTS} clients, {SECONDS:g} s", parts.measured(client, SECONDS))
        crowded(parts, client)
    took = sorted(restarts())
    print(f"from the kill of a controller to a live state, {RESTARTS} times:")
    print(f"  {statistics.median(took):.2f} s median, {took[-1]:.2f} s at most")


def crowded(parts: Parts, client: httpx.Client) -> None:
    """In turns alone and with a crowd: what it does to the ticks."""
    each = SECONDS / TURNS
    alone, crowd, answered = Times(), Times(), parts.folder / "answered.jsonl"
    answered.touch()
    for _ in range(TURNS):
        alone.add(parts.measured(client, each))
        watching = ("clients", parts.address, session(client), str(CROWD))
        asking = ("asking", parts.address, session(client), str(answered))
        with parts.beside(*watching), parts.beside(*asking):
            time.sleep(5.0)
            begin = answered.stat().st_size
            crowd.add(parts.measured(client, each))
            end = answered.stat().st_size
        with answered.open() as file:
            file.seek(begin)
            crowd.add({"answers": [json.loads(line) for line in file.read(end - begin).splitlines()]})
    say(f"alone again, {TURNS} times {each:g} s", alone)
    say(f"with {CROWD} clients and {RATE} requests a second, in turns with that", crowd)
    for what, times in alone.items():
        ratio = statistics.median(crowd[what]) / statistics.median(times)
        print(
            f"  {what}: {ratio:.2f} times in the median, {percentile(crowd[what]) / percentile(times):.2f} at the 99th"
        )
    print(f"  {len(crowd['answers']) / SECONDS:.0f} answers a second")


class Times(dict[str, list[float]]):
    """Seconds of what was measured, by what it is."""

    def add(self, more: Mapping[str, Sequence[float]]) -> None:
        """And these."""
        for what, times in more.items():
            self.setdefault(what, []).extend(times)


def say(what: str, measured: Mapping[str, Sequence[float]]) -> None:
    """Print what was measured."""
    print(f"{what}:")
    for name, times in measured.items():
        median, most = statistics.median(times) * 1000, percentile(times) * 1000
        print(f"  {name}: {len(times)}, {median:.2f} ms median, {most:.2f} ms 99th percentile")


def restarts() -> Iterator[float]:
    """Seconds from when a controller is killed until its station is shown again as it is.

    They do not die one after the other, so that none is started again only after a pause.
    """
    port = free_port()
    command = [sys.executable, "-m", "sequence_planner.cli", "run", str(STATION), "--emulator", "--demonstration"]
    launcher = subprocess.Popen([*command, "--port", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        client = signed_in(f"http://127.0.0.1:{port}")
        wait_for(lambda: production(client) == "waiting")
        for _ in range(RESTARTS):
            time.sleep(BETWEEN)
            controller = part(launcher.pid, "controller")
            assert controller is not None
            os.kill(controller.number, signal.SIGKILL)
            killed, began = time.time(), time.monotonic()
            wait_for(partial(is_live, client, killed), 0.02)
            yield time.monotonic() - began
    finally:
        launcher.terminate()
        launcher.wait(PATIENCE)


def free_port() -> int:
    """A port of the loopback that nobody uses."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def signed_in(address: str) -> httpx.Client:
    """Somebody who acts at a demonstration."""
    client = httpx.Client(base_url=f"{address}/api/v1", timeout=10)

    def opened() -> bool:
        with contextlib.suppress(httpx.HTTPError):
            return client.post("session/demonstration", json={}).status_code == httpx.codes.OK
        return False

    wait_for(opened)
    return client


class Parts:
    """The processes of a station."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._socket = folder / "controller.socket"
        self._notes = folder / "notes.jsonl"
        self._port = free_port()
        self.address = f"http://127.0.0.1:{self._port}"
        self._environment = {
            **os.environ,
            "SEQUENCE_PLANNER_DATABASE": f"sqlite:///{folder / 'station.sqlite'}",
            NOTES: str(self._notes),
        }
        self._running: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Parts:
        model, link = str(STATION), ["--socket", str(self._socket)]
        self._spawn("-m", "sequence_planner.cli", "emulate", model)
        self._spawn(__file__, "controller", "controller", model, *link, "--emulated", "--start")
        self._spawn(
            *(
                "-m",
                "sequence_planner.cli",
                "server",
                *link,
                "--model",
                model,
                "--demonstration",
                "--page",
                str(self.folder),
            ),
            *("--port", str(self._port)),
        )
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._running:
            process.terminate()
        for process in self._running:
            process.wait(PATIENCE)

    def measured(self, client: httpx.Client, seconds: float) -> Times:
        """What the controller notes meanwhile."""
        begin = self._notes.stat().st_size
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            acknowledge(client)
            time.sleep(0.1)
        with self._notes.open() as file:
            file.seek(begin)
            notes = [json.loads(line) for line in file if line.endswith("\n")]
        times = Times()
        for name, what in (("step", "turns with ticks"), ("durable", "from there until durable")):
            times[what] = [note[name] for note in notes if name in note]
        return times

    @contextmanager
    def beside(self, what: str, *arguments: str) -> Iterator[None]:
        """Something of this file that goes on meanwhile."""
        process = self._spawn(__file__, what, *arguments)
        try:
            yield
        finally:
            process.terminate()
            process.wait(PATIENCE)
            self._running.remove(process)

    def _spawn(self, *arguments: str) -> subprocess.Popen[bytes]:
        quiet = subprocess.DEVNULL
        process = subprocess.Popen([sys.executable, *arguments], env=self._environment, stdout=quiet, stderr=quiet)
        self._running.append(process)
        return process


def controller(arguments: Sequence[str]) -> None:
    """The controller's command, with its ticks timed."""
    step, journalled = Controller._step, Records._journalled
    waiting: deque[tuple[int, float]] = deque()
    notes = Path(os.environ[NOTES]).open("a", buffering=1)  # noqa: SIM115 - until the process ends

    def timed(self: Controller, moment: Timestamp) -> None:
        before, began = self.execution.ticks, time.perf_counter()
        step(self, moment)
        if self.execution.ticks > before:
            now = time.perf_counter()
            waiting.append((self.records.recorder.last, now))
            notes.write(json.dumps({"step": now - began}) + "\n")

    def heard(self: Records) -> None:
        journalled(self)
        while waiting and waiting[0][0] <= self.writer.durable:
            notes.write(json.dumps({"durable": time.perf_counter() - waiting.popleft()[1]}) + "\n")

    Controller._step = timed  # type: ignore[method-assign]
    Records._journalled = heard  # type: ignore[method-assign]
    sys.argv = ["sequence-planner", *arguments]
    program()


async def look_on(address: str, cookie: str, clients: int) -> None:
    """So many clients of the stream."""

    async def client() -> None:
        url = address.replace("http", "ws") + "/api/v1/stream"
        async with connect(url, additional_headers={"Cookie": cookie}, origin=address) as stream:  # type: ignore[arg-type]
            async for _ in stream:
                pass

    await asyncio.gather(*(client() for _ in range(clients)))


async def ask(address: str, cookie: str, notes: Path) -> None:
    """`RATE` requests a second, each when it is due, answered or not those before it; seconds of each to `notes`."""
    with notes.open("a", buffering=1) as written:
        async with httpx.AsyncClient(base_url=f"{address}/api/v1", headers={"Cookie": cookie}, timeout=10) as client:

            async def request(path: str) -> None:
                began = time.perf_counter()
                (await client.get(path)).raise_for_status()
                written.write(f"{time.perf_counter() - began}\n")

            began = time.monotonic()
            async with asyncio.TaskGroup() as under_way:
                for number, path in enumerate(itertools.cycle(ASKED)):
                    await asyncio.sleep(began + number / RATE - time.monotonic())
                    under_way.create_task(request(path))


def synthesise() -> None:
    """The safe states of the station, over and over, computed anew each time."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "XDG_CACHE_HOME": cache}
        command = [sys.executable, "-m", "sequence_planner.cli", "synthesize", str(STATION)]
        process: list[subprocess.Popen[bytes]] = []

        def end(*_: object) -> None:
            for each in process:
                each.kill()
            sys.exit()

        signal.signal(signal.SIGTERM, end)
        while True:
            process[:] = [subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL)]
            process[0].wait()
            for file in Path(cache).rglob("*.json"):
                file.unlink()


def session(client: httpx.Client) -> str:
    """The cookies of somebody signed in, as a header has them."""
    return "; ".join(f"{name}={value}" for name, value in client.cookies.items())


def acknowledge(client: httpx.Client) -> None:
    """Whatever waits for a person is done."""
    for id_, task in client.get("tasks").json()["tasks"].items():
        client.post(f"tasks/{id_}/acknowledgement", json={"revision": task["revision"]})


def is_live(client: httpx.Client, since: float) -> bool:
    """Whether the station is shown as it was at some tick after that time."""
    with contextlib.suppress(httpx.HTTPError):
        view = client.get("station").json()
        return bool(view.get("tick")) and view["time"] > since + VIEW
    return False


def production(client: httpx.Client) -> str | None:
    """Whether it has been started."""
    with contextlib.suppress(httpx.HTTPError):
        return str(client.get("station").json().get("production"))
    return None


def percentile(times: Sequence[float]) -> float:
    """The 99th of the times."""
    return sorted(times)[min(len(times) - 1, int(len(times) * 0.99))]


def wait_for(condition: Callable[[], bool], every: float = 0.1) -> None:
    """Return when it is true; raises `TimeoutError`."""
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError("the station did not come up")
        time.sleep(every)


if __name__ == "__main__":
    match sys.argv[1:]:
        case []:
            main()
        case ["controller", *rest]:
            controller(rest)
        case ["clients", address, cookie, clients]:
            os.nice(ELSEWHERE)
            asyncio.run(look_on(address, cookie, int(clients)))
        case ["asking", address, cookie, notes]:
            os.nice(ELSEWHERE)
            asyncio.run(ask(address, cookie, Path(notes)))
        case ["synthesising"]:
            synthesise()
