"""What an engineer's work does to a stop: how long Hold takes while somebody edits, without and with the editing.

Run with `make bench`. The bolt tightening station runs as its users run it, with emulated devices and a database of
SQLite on the disk. An operator holds and pauses it every 50 ms, one request after the other, while somebody else does
one kind of work again and again. Then the server is killed again and again, and the operator pauses at once. Times are
on the wall, of the operator. With `killed` it is that alone.
"""

from __future__ import annotations

import os
import shutil
import signal
import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
from access import GIVEN, NAME, PASSWORD, STATION, add_administrator, station
from stations.processes import part

SECONDS = 15.0  # of each kind of work
EVERY = 0.05  # seconds between two stops
KILLS = 20
SETTLING = 15.0  # seconds between two kills: whoever dies sooner is started again only after a pause
VARIABLES = 20_000
# A short text that stands for millions of entries.
BOMB = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 10)}]\n" for before, name in zip("abcdef", "bcdefg", strict=True)
)


class Engineer:
    """Writes one file of the draft, which nobody else does."""

    def __init__(self, client: httpx.Client, file: str) -> None:
        self._client = client
        self._file = file
        self._text: str | None = None
        self.done = 0

    def write(self, text: str | None) -> None:
        """Give the file a text, or take it away."""
        if text != self._text:
            edit = {"kind": "text", "file": self._file, "was": self._text, "text": text}
            self.change(edit)
            self._text = text

    def change(self, edit: dict[str, Any]) -> None:
        """Carry an edit out."""
        answer = self._client.post("/model/changes", json={"title": "to be measured", "edits": [edit]})
        answer.raise_for_status()
        self.done += 1


def variables(count: int, more: str = "") -> str:
    """A resource with so many variables."""
    entries = "".join(f"  v{number}: {{type: bool, initial: false}}\n" for number in range(count))
    return f"title: Many{more}\nestimated:\n{entries}"


def main() -> None:
    """Measure and print."""
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + (os.getpid() + 35) % 100))
    with tempfile.TemporaryDirectory(prefix="stopping-") as folder:
        os.environ["SEQUENCE_PLANNER_DATABASE"] = f"sqlite:///{folder}/station.sqlite"
        model = Path(folder) / "bolt_tightening"
        shutil.copytree(STATION, model)
        add_administrator()
        with (
            station(model) as (address, launcher),
            httpx.Client(base_url=f"{address}/api/v1", timeout=60) as operator,
            httpx.Client(base_url=f"{address}/api/v1", timeout=60) as engineer,
        ):
            operator.post("/session", json={"name": NAME, "password": GIVEN}).raise_for_status()
            operator.put("/session/password", json={"old": GIVEN, "new": PASSWORD}).raise_for_status()
            engineer.post("/session", json={"name": NAME, "password": PASSWORD}).raise_for_status()
            if sys.argv[1:] != ["killed"]:
                for what, work in works(engineer).items():
                    measure(operator, what, work)
            say_how_long([pause_after_kill(operator, launcher) for _ in range(KILLS)])


def works(client: httpx.Client) -> dict[str, Callable[[int], object]]:
    """What is done again and again, by what it is."""
    many, bomb, entries = (Engineer(client, f"resources/{name}.yaml") for name in ("many", "bomb", "entries"))

    def add(turn: int) -> None:
        entries.write(None)
        value = {f"v{number}": {"type": "bool", "initial": turn % 2 == 0} for number in range(VARIABLES)}
        path = ["estimated"]
        entries.change({"kind": "add", "file": "resources/entries.yaml", "path": path, "value": value})
        entries._text = client.get("/model/files", params={"path": "resources/entries.yaml"}).json()["files"][
            "resources/entries.yaml"
        ]["text"]

    def take_away(_: int) -> None:
        bomb.write(None)
        time.sleep(0.1)

    return {
        "nothing": lambda _: time.sleep(0.1),
        "an alias bomb is written": lambda turn: bomb.write(f"{BOMB}# {turn}\n"),
        "and taken away": take_away,
        f"{VARIABLES} variables are written": lambda turn: many.write(variables(VARIABLES, f" {turn}")),
        "all files are read": lambda _: client.get("/model/files").raise_for_status(),
        "versions are compared": lambda _: client.get("/model/comparison?old=running").raise_for_status(),
        "the graph is drawn": lambda _: client.get("/model/graph").raise_for_status(),
        f"{VARIABLES} variables are added as a value": add,
    }


def measure(operator: httpx.Client, what: str, work: Callable[[int], object]) -> None:
    """Print how long stops take while `work` is done."""
    end, turns, wrong = time.monotonic() + SECONDS, [0], list[str]()

    def repeat() -> None:
        try:
            while time.monotonic() < end:
                work(turns[0])
                turns[0] += 1
        except httpx.HTTPError as error:
            wrong.append(str(error))

    working = threading.Thread(target=repeat)
    working.start()
    times: list[float] = []
    while time.monotonic() < end:
        began = time.perf_counter()
        mode = "hold" if len(times) % 2 == 0 else "paused"
        operator.put("/mode", json={"mode": mode}).raise_for_status()
        times.append(time.perf_counter() - began)
        time.sleep(EVERY)
    working.join()
    times.sort()
    half, most, last = (times[min(len(times) - 1, int(len(times) * each))] * 1000 for each in (0.5, 0.99, 1))
    if wrong:
        print(f"  it failed: {wrong[0][:300]}")
    print(
        f"{what}, {turns[0]} times: a stop takes {half:.0f} ms, 99 % {most:.0f} ms, at most {last:.0f} ms", flush=True
    )


def pause_after_kill(operator: httpx.Client, launcher: int) -> float:
    """Seconds from when the server is killed until a Pause is accepted, whatever becomes of requests meanwhile."""
    time.sleep(SETTLING)
    server = part(launcher, "server")
    assert server is not None
    os.kill(server.number, signal.SIGKILL)
    began = time.perf_counter()
    while True:
        try:
            if operator.put("/mode", json={"mode": "paused"}).is_success:
                return time.perf_counter() - began
        except httpx.HTTPError:
            pass  # the connection was the one of the server that is gone
        time.sleep(0.01)


def say_how_long(times: list[float]) -> None:
    """Print how long it took."""
    times = sorted(times)
    print(
        f"killed {len(times)} times: the first Pause is accepted after {statistics.median(times):.2f} s, "
        f"at most {times[-1]:.2f} s",
        flush=True,
    )


if __name__ == "__main__":
    main()
