"""The truck engine station as its users run it: real processes, real DDS on the loopback, real HTTP."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import secrets
import signal
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import httpx

from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import open_session
from sequence_planner.core.actor import SYSTEM, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.db.location import default_url
from sequence_planner.ros.transport import Transport
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from support.network import DOMAIN, free_port
from support.places import REPOSITORY
from support.waiting import until

MODEL = Path("models") / "bolt_tightening"


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "sequence_planner.cli", *arguments]


def environment() -> dict[str, str]:
    return {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN)}


def finished(*arguments: str, seconds: float = 60) -> subprocess.CompletedProcess[str]:
    """Run a command to its end."""
    return subprocess.run(
        command(*arguments),
        cwd=REPOSITORY,
        env=environment(),
        text=True,
        capture_output=True,
        timeout=seconds,
        check=False,
    )


@dataclass
class RunningStation:
    """A station that runs, seen through its REST interface."""

    process: subprocess.Popen[bytes]
    port: int
    log: Path

    @cached_property
    def browser(self) -> httpx.Client:
        """Somebody is signed in there, and may do whatever there is to do at a station."""
        arguments = self.process.args
        assert isinstance(arguments, list)
        return signed_in(REPOSITORY / str(arguments[arguments.index("run") + 1]), self.port)

    def get(self, part: str, path: str = "") -> Any:  # noqa: ANN401 - JSON
        """The `part` of the answer at `path`, which mostly bears its name."""
        answer = self.browser.get(path or part)
        answer.raise_for_status()
        return answer.json()[part]

    def post(self, path: str, body: object) -> httpx.Response:
        """What is answered; control is taken where it is needed."""
        answer = self.browser.post(path, json=body)
        if answer.status_code == httpx.codes.CONFLICT and answer.json()["type"] == "/problems/control-needed":
            self.browser.put("control-lock", json={"over": None}).raise_for_status()
            answer = self.browser.post(path, json=body)
        return answer

    def up(self) -> bool:
        return self.production() in ("waiting", "started")

    def production(self) -> Any:  # noqa: ANN401 - JSON
        """How production stands; None while nobody tells."""
        assert self.process.poll() is None, "the station has ended"
        try:
            return self.browser.get("station").json().get("production")
        except httpx.HTTPError:
            return None

    def analysed(self) -> Any:  # noqa: ANN401 - JSON
        """What synthesis has found of the station; None before that is all."""
        assert self.process.poll() is None, "the station has ended"
        try:
            answer = self.browser.get("analysis")
        except httpx.HTTPError:
            return None
        analysis = answer.json().get("analysis") if answer.status_code == httpx.codes.OK else None
        return analysis if analysis is not None and analysis["pending"] is None else None

    def value(self, name: str) -> object:
        return self.get("variables", "state")[name]["value"]

    def acknowledge(self) -> None:
        """Acknowledge whatever waits for a person."""
        for id_, task in self.get("tasks").items():
            self.post(f"tasks/{id_}/acknowledgement", {"revision": task["revision"]})

    def work_on(self, tightened: int) -> None:
        """Acknowledge every task until so many more bolt pairs are tightened."""
        names = [f"tighten_bolt_pair(bolt_pair_{number})" for number in (1, 2, 3)]
        wanted = sum(map(self.completed, names)) + tightened

        def done() -> bool:
            self.acknowledge()
            return sum(map(self.completed, names)) >= wanted

        until(done)

    def completed(self, operation: str) -> int:
        return int(self.get("operations")[operation]["completed"])

    def child(self, name: str) -> int:
        """The process id of the part that runs the command `name`. Raises ValueError when there is none."""
        first, *_ = self.children(name)
        return first

    def children(self, name: str) -> list[int]:
        """The process ids of those that run the command `name`, the oldest first."""
        return [each.number for each in descendants(self.process.pid) if each.runs(name)]


@dataclass(frozen=True)
class Descendant:
    """A process that another one has started, itself or by one in between; `title` is what `ps` shows."""

    number: int
    title: str

    def runs(self, name: str) -> bool:
        """Whether it is the part of a station that runs the command `name`, forked or executed."""
        return re.search(rf"(?:^sequence-planner|sequence_planner\.cli) {name} ", self.title) is not None


def descendants(number: int) -> list[Descendant]:
    """What the process of that number has started, the oldest first."""
    columns = ["-ww", "-e", "--sort=start_time", "-o", "pid=,ppid=,args="]  # -ww: whatever COLUMNS says
    listed = subprocess.run(["ps", *columns], capture_output=True, text=True, check=True).stdout
    rows = [
        (int(pid), int(parent), title) for pid, parent, title in (row.split(None, 2) for row in listed.splitlines())
    ]
    found = {number}
    while more := {pid for pid, parent, _ in rows if parent in found} - found:
        found |= more
    return [Descendant(pid, title) for pid, _, title in rows if pid in found - {number}]


@contextmanager
def process(log: Path, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """A process of ours, ended by its id."""
    with log.open("ab") as out:
        running = subprocess.Popen(command(*arguments), cwd=REPOSITORY, env=environment(), stdout=out, stderr=out)
    try:
        yield running
    finally:
        running.send_signal(signal.SIGTERM)
        running.wait(timeout=20)


@contextmanager
def station(folder: Path, *options: str, model: Path = MODEL) -> Iterator[RunningStation]:
    """A station that is up, with `options` for `run`."""
    port = free_port()
    log = folder / "station.log"
    with process(log, "run", str(model), "--port", str(port), *options) as running:
        seen = RunningStation(running, port, log)
        try:
            until(seen.up)
        except AssertionError as error:
            raise AssertionError(log.read_text()) from error
        yield seen
    assert running.returncode == 0, log.read_text()


@asynccontextmanager
async def foreign_node(
    messages: Path = REPOSITORY / MODEL / "messages",
) -> AsyncIterator[tuple[Transport, MessageRegistry]]:
    """Another ROS 2 node on the station's network, built with the definitions in the folder `messages`."""
    registry = MessageRegistry.from_folder(messages)
    transport = open_transport("cyclonedds", registry, "stranger", asyncio.get_running_loop(), DOMAIN)
    try:
        yield transport, registry
    finally:
        transport.close()


def signed_in(model: Path, port: int, url: str | None = None) -> httpx.Client:
    """The browser of an engineer at the station in the folder `model`; its database is at `url`, or by default."""
    now, name = time.time(), f"Engineer {secrets.token_hex(4)}"
    with contextlib.closing(Database.open(url or default_url(model))) as database:
        database.upgrade()
        with database.writing() as connection:
            person = users.create(connection, name, Role.ENGINEER, "none", SYSTEM, now, temporary=False)
            kind = ActorKind.PERSON
            token, _ = open_session(connection, person, now, kind=kind, address="127.0.0.1", agent="tests")
    # A connection for each request: the server may die between two.
    return httpx.Client(
        base_url=f"http://127.0.0.1:{port}/api/v1/",
        cookies={f"sequence-planner-{port}": token},
        limits=httpx.Limits(max_keepalive_connections=0),
    )
