"""A station in front of which several people stand, each with a browser and a password."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx

from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.db.location import default_url
from support.network import free_port
from support.people import CHEAP
from support.places import REPOSITORY
from support.station import MODEL, RunningStation, process
from support.waiting import until

PEOPLE = {"Ada": Role.ADMINISTRATOR, "Bo": Role.OPERATOR}
PASSWORD = "a long enough one"
SPEED = "      - override: {name: speed, fields: {speed_scaling: {between: [0.05, 0.5]}}, expires: 60}\n"


@dataclass
class Hall:
    """The station, and browsers in front of it."""

    station: RunningStation
    model: Path

    def browser(self) -> httpx.Client:
        """A browser that makes a connection for each request: the server may die between two."""
        limits = httpx.Limits(max_keepalive_connections=0)
        return httpx.Client(base_url=f"http://127.0.0.1:{self.station.port}/api/v1/", limits=limits)

    @contextlib.contextmanager
    def signed_in(self, name: str) -> Iterator[httpx.Client]:
        with self.browser() as browser:
            answer = browser.post("session", json={"name": name, "password": PASSWORD})
            assert answer.status_code == 200, answer.text
            yield browser
            browser.delete("session")

    def killed(self, part: str) -> None:
        """Kill one of the processes, and wait until the launcher has started it again."""
        before = self.station.child(part)
        os.kill(before, signal.SIGKILL)
        until(lambda: self._child(part) not in (None, before))
        until(self.station.up)

    def _child(self, part: str) -> int | None:
        with contextlib.suppress(ValueError):
            return self.station.child(part)
        return None


@contextlib.contextmanager
def opened(folder: Path) -> Iterator[Hall]:
    """The bolt tightening station with an override of the robot's speed, and two people who may sign in."""
    model, log, port = folder / "bolt_tightening", folder / "log", free_port()
    shutil.copytree(REPOSITORY / MODEL, model)
    robot, constant = model / "resources" / "robot.yaml", "      - constant: {speed_scaling: 0.25}\n"
    text = robot.read_text(encoding="utf-8")
    assert constant in text
    robot.write_text(text.replace(constant, constant + SPEED), encoding="utf-8")
    with contextlib.closing(Database.open(default_url(model))) as database:
        database.upgrade()
        with database.writing() as connection:
            for name, role in PEOPLE.items():
                hashed = CHEAP.hash(PASSWORD)
                users.create(connection, name, role, hashed, SYSTEM, time.time(), temporary=False)
    with process(log, "run", str(model), "--port", str(port), "--emulator", "--emulator-speed", "5") as running:
        station = RunningStation(running, port, log)
        try:
            until(station.up)
        except AssertionError as error:
            raise AssertionError(log.read_text()) from error
        yield Hall(station, model)
    assert running.returncode == 0, log.read_text()
