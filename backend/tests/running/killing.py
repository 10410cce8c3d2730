"""A station of which processes are killed at moments drawn by seed, and which then has to go on as if nothing was."""

from __future__ import annotations

import contextlib
import os
import resource
import signal
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from running.judging import Judge
from running.mortal import Mortal, mortal
from running.wire import Wire, listening
from support.simulated import truck_engine

UNTIL_KILLED = 1.5  # seconds for which it works at most, until it is killed
AT_WORK, AT_ONCE = "while it worked", "while it started"
STANDSTILL = 1.0  # seconds in which nothing may happen while nothing can be recorded


@dataclass
class Killing:
    """What is done to a station, while somebody listens on the wire to its devices."""

    station: Mortal
    wire: Wire

    def killed(self) -> None:
        """The controller is killed at some moment and started again; AssertionError if anything is lost by that."""
        shown: dict[str, object] = {}
        if self.station.chance.random() < 0.85:
            self.station.get_back_to_work()
            end = time.monotonic() + self.station.chance.uniform(0, UNTIL_KILLED)
            while time.monotonic() < end:
                self.station.acknowledge()
                shown = self.station.browser.get("history?limit=1").json()["records"][0]
                time.sleep(self.station.chance.uniform(0, 0.1))
            self.station.seen[f"controllers killed {AT_WORK}"] += 1
        else:
            time.sleep(self.station.chance.uniform(0, 4 * UNTIL_KILLED))
            self.station.seen[f"controllers killed {AT_ONCE}"] += 1
        self.station.kill("controller")
        self.station.kept.look()
        assert not shown or self.station.kept.has(shown), f"a record that was shown is gone: {shown}"
        self.station.start("controller")

    def troubled(self) -> None:
        """Something beside the controller dies, or there is no room left on the disk; then work goes on by itself."""
        trouble = self.station.chance.choice([self.kill_workers, self.lose_server, self.fill_disk])
        trouble()
        self.station.seen[trouble.__name__.replace("_", " ")] += 1
        self.station.kept.look()
        self.station.go_on()

    def lose_server(self) -> None:
        """The server dies and is started again, while production goes on."""
        self.station.kill("server")
        time.sleep(self.station.chance.uniform(0, UNTIL_KILLED))
        self.station.start("server")
        self.station.wait(
            lambda: self.station.production() == "started", "production does not go on without the server"
        )

    def fill_disk(self) -> None:
        """The controller can write to no file any more: it says so, and commands nothing until it can again."""
        controller = self.station.pid("controller")
        resource.prlimit(controller, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
        try:
            self.station.wait(
                lambda: "unjournalled" in self.station.alarms(), "nobody is told that nothing can be recorded"
            )
            self.station.kept.look()
            heard = self.commands
            time.sleep(STANDSTILL)
            assert not self.station.kept.look(), "something was recorded on a full disk"
            assert self.commands == heard, "something was commanded that is not recorded"
        finally:
            unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
            resource.prlimit(controller, resource.RLIMIT_FSIZE, unlimited)
        self.station.wait(
            lambda: "unjournalled" not in self.station.alarms(), "nothing can be recorded, though there is room again"
        )

    def kill_workers(self) -> None:
        """What the controller has started beside itself, such as its planner, is killed."""
        for worker in self.station.children("controller"):
            with contextlib.suppress(ProcessLookupError):
                os.kill(worker, signal.SIGKILL)
                self.station.seen["workers killed"] += 1

    @property
    def commands(self) -> int:
        """How many commands were heard on the wire."""
        return sum(map(len, self.wire.heard.values()))

    def judged(self) -> Counter[str]:
        """All that has been met; AssertionError when something happened twice, or should not have."""
        self.station.kill("controller")  # or it would command more than the journal had when that was read
        self.station.kept.look()
        station, supervisor, _ = truck_engine()
        judge = Judge(station.automaton, supervisor)
        judge.judge(self.station.database)
        for topic, heard in self.wire.heard.items():
            judge.require_decided(topic, heard)
            self.station.seen["commands heard by devices"] += len(heard)
        self.station.seen["records"] += self.station.kept.end.number
        self.station.seen["starts"] += judge.starts.total()
        return self.station.seen


@contextlib.contextmanager
def _killing(seed: str) -> Iterator[Killing]:
    with listening(truck_engine()[0]) as wire, mortal(seed) as station:
        yield Killing(station, wire)


def lives(seed: str, kills: int) -> Counter[str]:
    """A station whose controller is killed so many times. AssertionError when anything is not as it should be."""
    with _killing(seed) as killing:
        for _ in range(kills):
            killing.killed()
        killing.station.get_back_to_work()
        return killing.judged()


def troubles(seed: str, number: int) -> Counter[str]:
    """A station at work, in trouble so many times. AssertionError when anything is not as it should be."""
    with _killing(seed) as killing:
        killing.station.get_back_to_work()
        for _ in range(number):
            killing.troubled()
        return killing.judged()
