"""Stops that were accepted, and what may become of a station right after: no start follows before a person says so."""

from __future__ import annotations

import json
import signal
import sqlite3
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from running.mortal import Mortal, mortal
from running.pairs import Pair, pair, standby
from running.takeovers import automatic
from sequence_planner.db.database import Database
from sequence_planner.execution.record.codec import TICKED
from sequence_planner.journal import run_journal
from sequence_planner.process.parent_watch import OVERTAKEN
from support.postgresql import binaries, running_server
from support.waiting import until

MILLISECONDS = 0.005  # until a controller is killed after the answer, at most
WATCHED = 16.0  # seconds: whoever takes over by itself waits until the other has left the network, about 10 s


@dataclass
class Witness:
    """What a person has asked for, and when: stops that were accepted, and starts, which count from when they were
    sent, on the clock of the records.
    """

    stops: list[tuple[float, float]] = field(default_factory=list)  # sent, answered
    starts: list[float] = field(default_factory=list)

    def stop(self, station: Mortal, mode: str) -> httpx.Response | None:
        """Pause or hold; None where nobody answers."""
        sent = time.time()
        try:
            answer = station.browser.put("mode", json={"mode": mode}, timeout=10)
        except httpx.HTTPError:
            return None
        if answer.is_success:
            self.stops.append((sent, time.time()))
        return answer

    def start(self, station: Mortal) -> None:
        """A person lets the station work, until it does. After a takeover it may have gone on by itself."""
        self.starts.append(time.time())
        station.wait(lambda: station.production() in ("waiting", "started"), "it is not up")

        def started() -> bool:
            station.decide()
            answer = station.ask("POST", "production/start", {"reason": "looked at"})
            return answer.is_success or station.production() == "started"

        station.wait(started, "production cannot be started")
        station.kept.look()
        station.ask("PUT", "mode", {"mode": "automatic"}).raise_for_status()
        station.go_on()

    def judge(self, database: Database) -> int:
        """How many ticks have started something; AssertionError when one did after an accepted stop."""
        found, number = 0, 0
        with database.reading() as connection:
            while page := run_journal.after(connection, number, 1000, [TICKED]):
                number = page[-1].number
                for record in page:
                    if started := json.loads(record.content).get("started"):
                        found += 1
                        wrong = [each for each in self.stops if self._holds(each, record.time)]
                        assert not wrong, f"record {record.number} starts {started} after the stop of {wrong}"
        return found

    def _holds(self, stop: tuple[float, float], at: float) -> bool:
        sent, answered = stop
        return answered < at and not any(sent <= each <= at for each in self.starts)


@contextmanager
def _held_up(station: Mortal) -> Iterator[None]:
    """Another program holds the database of a station meanwhile, and nothing can be written to it."""
    with closing(sqlite3.connect(station.folder / "station.sqlite", isolation_level=None, timeout=60)) as other:
        other.execute("BEGIN IMMEDIATE")
        yield
        other.execute("ROLLBACK")


def kills(seed: str, number: int) -> Counter[str]:
    """So many stops of one station whose controller is killed within milliseconds after it has accepted them."""
    witness = Witness()
    with mortal(seed) as station:
        for left in reversed(range(number)):
            mode, away = _drawn(station, left), station.chance.random() < 0.5
            witness.start(station)
            if away:
                with _held_up(station):
                    _stop_and_kill(station, witness, mode)
            else:
                _stop_and_kill(station, witness, mode)
            station.seen["stopped while nothing could be recorded" if away else "stopped"] += 1
            station.start("controller")
            station.wait(lambda: station.production() == "waiting", "it is not up")
            assert station.mode() == mode, f"it was {mode}, and is {station.mode()} after a start"
            if "begins-at-rest" in station.alarms():
                station.seen["the file beside the journal knew of it"] += 1
            else:
                assert not away, "it is not said why it begins at rest"
        station.kill("controller")
        station.seen["ticks that started something"] += witness.judge(station.database)
        return station.seen


def _drawn(station: Mortal, left: int) -> str:
    """Pause or hold: that can lead out of the safe states, from which it takes a way back, so it is only the last."""
    return "paused" if left else station.chance.choice(["paused", "hold"])


def _stop_and_kill(station: Mortal, witness: Witness, mode: str) -> None:
    time.sleep(station.chance.uniform(0, 0.5))
    answer = witness.stop(station, mode)
    assert answer is not None and answer.is_success, answer
    time.sleep(station.chance.uniform(0, MILLISECONDS))
    station.kill("controller")
    station.seen[
        "the answer said that it is recorded"
        if answer.status_code == httpx.codes.NO_CONTENT
        else "the answer said that it is not recorded yet"
    ] += 1


def takeovers(seed: str, number: int) -> Counter[str]:
    """So many stops of a station that another may take over from by itself, through outages, kills and takeovers."""
    programs = binaries()
    assert programs is not None, "PostgreSQL is not here"
    with (
        running_server(programs) as postgresql,
        tempfile.TemporaryDirectory() as folder,
        pair(postgresql, Path(folder), automatic(Path(folder))) as both,
    ):
        lives = _Lives(both)
        for left in reversed(range(number)):
            lives.live(left)
        commands = both.stations[0]
        commands.kept.look()
        for each in both.stations:
            if each.ended("controller") is None:
                each.kill("controller")
        commands.seen["ticks that started something"] += lives.witness.judge(both.database)
        both.judge()
        return lives.seen + commands.seen


class _Lives:
    """What happens to a pair of stations."""

    def __init__(self, both: Pair) -> None:
        self._both = both
        self._chance = both.stations[0].chance
        self.witness = Witness()
        self.seen = Counter[str]()

    def live(self, left: int) -> None:
        """It works, somebody stops it, things happen in some order, and for a while nobody says anything. So many lives
        are left then.
        """
        commands = self._commanding()
        self.witness.judge(self._both.database)  # what has come late, too: no start of now makes it right
        self.witness.start(commands)
        events = [self._chance.choice([self._cut, self._outage, self._kill, self._halt])]
        events += self._chance.sample(
            [self._mend, self._kill, self._start_again, self._cut], self._chance.randint(0, 3)
        )
        when = self._chance.randint(0, 1)  # the stop comes first, or after the first event
        if when == 1:
            events[0](commands)
            time.sleep(self._chance.uniform(0, 4.0))
        accepted = self._stop(commands, left)
        for event in events[when:]:
            time.sleep(self._chance.choice([0.0, self._chance.uniform(0, MILLISECONDS), self._chance.uniform(0, 5.0)]))
            event(commands)
        self._watch(WATCHED)
        self._bring_back()
        self._watch(WATCHED if accepted else 0.0)
        self.witness.judge(self._both.database)

    def _stop(self, station: Mortal, left: int) -> bool:
        answer = self.witness.stop(station, _drawn(station, left))
        said = {None: "nobody answered", 204: "accepted and recorded", 200: "accepted and not recorded yet"}
        status = None if answer is None else answer.status_code
        self.seen[f"stop {said.get(status, f'refused with {status}')}"] += 1
        return answer is not None and answer.is_success

    def _commanding(self) -> Mortal:
        """The station that commands."""
        found: list[Mortal] = []

        def commands() -> bool:
            found[:] = [each for each in self._both.stations if standby(each)["active"] is True]
            return bool(found) and found[0].production() in ("waiting", "started")

        until(commands, seconds=240.0)
        return found[0]

    def _cut(self, station: Mortal) -> None:
        self.seen["cut off"] += 1
        self._both.links[str(station.standby)].cut()

    def _outage(self, _: Mortal) -> None:
        self.seen["outage"] += 1
        for each in self._both.links.values():
            each.cut()

    def _mend(self, _: Mortal) -> None:
        for each in self._both.links.values():
            each.cut()
            each.mend()

    def _kill(self, station: Mortal) -> None:
        if station.ended("controller") is None:
            self.seen["killed"] += 1
            station.kill("controller")

    def _halt(self, station: Mortal) -> None:
        if station.ended("controller") is None:
            self.seen["stopped (SIGSTOP)"] += 1
            station.signal("controller", signal.SIGSTOP)

    def _start_again(self, station: Mortal) -> None:
        if station.ended("controller") is not None:
            self.seen["started again at once"] += 1
            station.start("controller")

    def _watch(self, seconds: float) -> None:
        """Nobody says anything, but that tasks are done."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for each in self._both.stations:
                try:
                    each.acknowledge()
                except (httpx.HTTPError, KeyError, ValueError):
                    continue  # it does not answer now
            time.sleep(0.3)

    def _bring_back(self) -> None:
        """Everything is mended, and both are there."""
        self._mend(self._both.stations[0])
        for each in self._both.stations:
            if each.ended("controller") is None:
                each.signal("controller", signal.SIGCONT)
        time.sleep(2.0)
        for each in self._both.stations:
            if (code := each.ended("controller")) is not None:
                self.seen["overtaken"] += code == OVERTAKEN
                each.start("controller")
