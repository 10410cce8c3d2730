"""The stations at which a MES orders for a day: what their people do, and what goes wrong there.

Nobody but the people and `kill -9` is beside the MES: all of it happens in one thread, one thing after the other.
"""

from __future__ import annotations

import subprocess
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, ClassVar

import httpx

from running.back_to_work.engine import DEVICE_OF, NODE_OF, SPEED, HallHands
from running.back_to_work.person import Person
from running.mortal import PARTS, Mortal, mortal, standing
from stations.disturbing import Trouble, summed
from stations.hall import MODEL, Hall, hall
from support.station import command, environment
from support.waiting import until

BOLT_FAULTS = ("nutrunner silent for 3 s", "robot silent for 2 s", "robot slow 3 for 5 s", "nutrunner stuck for 3 s")
Responses = Sequence[Mapping[str, Any]]
RELEASE = "engine.release"
STANDS_AFTER = 20.0  # seconds without progress
LONGEST_STANDSTILL = 60.0  # seconds in which emulated devices are back, and a killed process


class DayStation(ABC):
    """The station of a day, at which so many troubles come at moments drawn by its seed."""

    work_master: ClassVar[str]
    seconds: ClassVar[float]  # of the day
    patience: ClassVar[float]  # seconds after it
    troubles: ClassVar[tuple[str, ...]] = ("fault", "fault", *PARTS)

    def __init__(self, station: Mortal, troubles: int) -> None:
        self.station = station
        self._began: float | None = None
        chance = station.chance
        self._coming = sorted(chance.uniform(2, self.seconds) for _ in range(troubles))
        self._progress: tuple[object, float] = (None, time.monotonic())  # how far it was, and since when

    def people(self) -> None:
        """Do the tasks, and bring back to work what was killed; and let happen what is due."""
        now = time.monotonic()
        self._began = now if self._began is None else self._began
        if self._coming and now - self._began > self._coming[0]:
            self._coming.pop(0)
            self._trouble(self.station.chance.choice(self.troubles))
        with suppress(httpx.HTTPError, KeyError):  # the server, or what it hears of, is away
            self.work()

    def _trouble(self, what: str) -> None:
        if what not in PARTS:
            self.station.seen[f"fault: {self.fault()}"] += 1
            return
        self.station.kill_and_start(what)

    @abstractmethod
    def fault(self) -> str:
        """Let a device have a fault; which."""

    @abstractmethod
    def work(self) -> None:
        """What people do here whenever they look."""

    @abstractmethod
    def judge(self, responses: Responses) -> None:
        """AssertionError where something else is true here than these responses say."""

    @property
    def story(self) -> str:
        """For who reads why it went wrong."""
        return self.station.log("controller")


class BoltStation(DayStation):
    """Bolt tightening with emulated devices, which come back by themselves."""

    work_master = "truck_engine"
    seconds, patience = 40.0, 300.0

    def fault(self) -> str:
        """See `DayStation.fault`."""
        line = self.station.chance.choice(BOLT_FAULTS)
        done = subprocess.run(command("fault", line), env=environment(), capture_output=True, timeout=60, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return line.partition(" for")[0]

    def work(self) -> None:
        """See `DayStation.work`. AssertionError, with what the station says, where it works an order and stands."""
        if self.station.production() == "waiting":
            self.station.begin_production()
        self.station.acknowledge()
        browser, now = self.station.browser, time.monotonic()
        number = browser.get("history?limit=1").json()["records"][0]["number"]
        if number != self._progress[0] or not browser.get("job-orders?state=Running").json()["job_orders"]:
            self._progress = number, now
        stands = now - self._progress[1]
        assert stands < LONGEST_STANDSTILL, f"it stands: {browser.get('alarms').text} {self.station.shown()}"

    def judge(self, responses: Responses) -> None:
        """What is made of bolts no emulated device knows."""


class EngineStation(DayStation):
    """The truck engine station: eight nodes, and a world that knows what is true.

    Its watch acknowledges tasks. Some devices go on only when somebody has seen to them, some only by a way back.
    """

    work_master = "engine"
    seconds, patience = 240.0, 900.0

    def __init__(self, station: Mortal, place: Hall, troubles: int) -> None:
        super().__init__(station, troubles)
        self._place = place
        self._disturbance = Trouble(place, station.chance)
        self._hands = HallHands(place)
        self.person = Person(station, self._hands, serves=False)

    def fault(self) -> str:
        """See `DayStation.fault`. Half of them pass by themselves."""
        chance, hands = self.station.chance, self._hands
        lasting: dict[str, Callable[[], None]] = {"the robot trips": hands.trip}
        for resource in DEVICE_OF:
            lasting[f"the {resource} stands still"] = partial(hands.jam, resource)
        for resource in NODE_OF:
            lasting[f"the computer of the {resource} is gone"] = partial(hands.kill, resource)
        if chance.random() < 0.5:
            before = self._disturbance.seen.copy()
            self._disturbance.make()
            return next(iter(self._disturbance.seen - before))
        name = chance.choice(sorted(lasting))
        self.person.tell(f"-- {name}")
        lasting[name]()
        return name

    def work(self) -> None:
        """See `DayStation.work`. Where an order is worked and nothing goes on, somebody asks the station for advice."""
        station = self.person.get("station")
        if station["production"] == "waiting":
            self.person.tell("production is started")
            self.person.start_production(station)
        running = self.person.get("job-orders?state=Running")["job_orders"]
        progress = [self.person.completed(), [each["id"] for each in running]]
        now = time.monotonic()
        if progress != self._progress[0] or not running:
            self._progress = progress, now
        if now - self._progress[1] > STANDS_AFTER or station["mode"] in ("restart", "hold"):
            self.person.seen["looks at a station that stands"] += 1
            if self.person.look_and_act(""):
                self.person.seen["stations that were let go on"] += 1
                self._progress = progress, time.monotonic()

    def judge(self, responses: Responses) -> None:
        """See `DayStation.judge`. The engine of an order that was not completed is that of the next one."""
        released = sum(each["ability"] == RELEASE for found in responses for each in found["abilities"])
        assert released >= sum(found["outcome"] == "completed" for found in responses)
        until(lambda: self._place.counted["engine done"] >= released)
        assert not self._place.wrong, (self._place.wrong, self._place.ask({"verdict": True})["events"][-20:])
        counted = summed(self._place.counted)
        assert counted["engine done"] == released, counted
        self.station.seen += counted + self.person.seen

    @property
    def story(self) -> str:
        """See `DayStation.story`."""
        return "\n".join([*self.person.story, str(self._place.counted), super().story])


@contextmanager
def bolt_station(seed: str, troubles: int, *server: str) -> Iterator[DayStation]:
    """Bolt tightening, about to start; `server` are more options of that."""
    with mortal(seed, *server) as station:
        yield BoltStation(station, troubles)


@contextmanager
def engine_station(seed: str, troubles: int, *server: str) -> Iterator[DayStation]:
    """The truck engine station, likewise."""
    with (
        standing(seed, *server, model=MODEL, emulated=False) as station,
        hall(station.folder, SPEED, station.chance.randrange(1000)) as place,
    ):
        for part in ("server", "controller"):
            station.start(part)
        yield EngineStation(station, place, troubles)
