"""A long queue of orders, given all at once, and a station whose processes are killed while it works them."""

from __future__ import annotations

import itertools
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
from prometheus_client.parser import text_string_to_metric_families

from running.days import example, mes_key
from running.mortal import PARTS, Mortal, standing
from stations.presses import write_presses

PRESSES = 3
STEPS = ("feed", "stamp", "trim")  # of each order
PATIENCE = 3600.0  # seconds for all
LOOK_EVERY = 1.0  # seconds
PAGES = {
    "GET /job-orders": "job-orders?limit=200",
    "GET /capabilities": "capabilities",
    "GET /schedule": "schedule",
}
TICKS = "sequence_planner_tick_duration_seconds"


@dataclass
class Figures:
    """What was measured, in milliseconds and by what; and ticks by the bound under which they stayed, in seconds."""

    took: dict[str, list[float]] = field(default_factory=dict)
    ticks: Counter[float] = field(default_factory=Counter)
    _of_this_controller: Counter[float] = field(default_factory=Counter)

    @contextmanager
    def measured(self, what: str) -> Iterator[None]:
        """Measure how long a block takes that does not fail."""
        began = time.perf_counter()
        yield
        self.took.setdefault(what, []).append(1000 * (time.perf_counter() - began))

    def look_at_ticks(self, metrics: str) -> None:
        """Take note of the ticks that the controller has counted since it began."""
        found = Counter[float]()
        last = 0
        for family in text_string_to_metric_families(metrics):
            for sample in family.samples:
                if sample.name == f"{TICKS}_bucket":
                    found[float(sample.labels["le"])] = int(sample.value) - last
                    last = int(sample.value)
        if found.total() < self._of_this_controller.total():
            self.ticks += self._of_this_controller  # of one that was killed
        self._of_this_controller = found

    def told(self) -> Counter[str]:
        """All of it; the median of what was measured, and what 99 in 100 took at most."""
        seen = Counter[str]()
        for what, times in self.took.items():
            times.sort()
            seen[f"most ms of {what}, at the median"] = round(times[len(times) // 2])
            seen[f"most ms of {what}, 99 in 100"] = round(times[int(0.99 * (len(times) - 1))])
        ticks = self.ticks + self._of_this_controller
        for share in (50, 99):
            seen[f"most µs of a tick, {share} in 100"] = round(1e6 * _quantile(ticks, share / 100))
        seen["ticks"] = ticks.total()
        return seen


def _quantile(ticks: Counter[float], share: float) -> float:
    """A bound under which that share of them stayed."""
    sums = itertools.accumulate(ticks[bound] for bound in sorted(ticks))
    return next(bound for bound, total in zip(sorted(ticks), sums, strict=True) if total >= share * ticks.total())


@dataclass
class Queue:
    """Orders for several presses in front of their station."""

    station: Mortal
    day: Any  # of the simulator: it reads events on and holds all against the journal at the end
    client: Any  # without patience: what is measured is one answer
    figures: Figures = field(default_factory=Figures)

    def order(self, number: int) -> None:
        """Store so many orders, one after the other."""
        chance = self.station.chance
        for each in range(number):
            id = f"{self.day.name}.{each}"
            content = {"priority": chance.randrange(5), "due": time.time() + chance.uniform(60, 1200)}
            with self.figures.measured("POST /job-orders"):
                self.client.order(id, f"part_{1 + each % PRESSES}", **content)

    def ask(self, when: str) -> None:
        """Read what there is to read, measured."""
        for what, path in PAGES.items():
            with self.figures.measured(f"{what} {when}"):
                self.client.ask("GET", path)

    def look(self) -> None:
        """See how far it is, and let the people do what they have to."""
        with suppress(httpx.HTTPError, KeyError):
            if self.station.production() == "waiting":
                self.station.begin_production()
            self.figures.look_at_ticks(self.station.metrics())
        self.day.read_on()

    def work(self, orders: int, kills: Iterator[int]) -> None:
        """Until so many are over; processes are killed whenever so many as `kills` say are over."""
        end, next_kill, looked = time.monotonic() + PATIENCE, next(kills, None), 0.0
        while len(self.day.over) < orders:
            assert time.monotonic() < end, f"{len(self.day.over)} are over: {self.station.shown()}"
            self.day.read_on()
            if next_kill is not None and len(self.day.over) >= next_kill:
                self.look()
                time.sleep(self.station.chance.uniform(0, 1))
                self.station.kill_and_start(self.station.chance.choice(sorted(PARTS)))
                next_kill = next(kills, None)
            elif time.monotonic() - looked > LOOK_EVERY:
                self.look()
                self.ask("while they are worked")
                looked = time.monotonic()
            time.sleep(0.1)
        self.look()

    def require_all(self, orders: int) -> None:
        """AssertionError where an order is lost or doubled, or not all of it was made once."""
        ids = [f"{self.day.name}.{each}" for each in range(orders)]
        assert self.day.over == set(ids)
        assert self.day.differences() == []
        wanted = [f"{id}/{step}_{1 + number % PRESSES}" for number, id in enumerate(ids) for step in STEPS]
        assert self.day.made == Counter(wanted)
        responses = [self.day.mes.response(id) for id in ids]
        outcomes = Counter(each["outcome"] for each in responses)
        assert outcomes == {"completed": orders}, outcomes
        undone = [each for found in responses for each in found["operations"] if each["started"] is None]
        assert not undone, undone
        numbers = [each["number"] for each in self._all_events()]
        assert numbers == list(range(1, len(numbers) + 1))

    def _all_events(self) -> Iterator[dict[str, Any]]:
        after = 0
        while found := self.client.ask("GET", f"events?after={after}&limit=200")["events"]:
            yield from found
            after = found[-1]["number"]


def queue(seed: str, orders: int, kills: int) -> Counter[str]:
    """So many orders at once, and so many kills. AssertionError when anything was lost, doubled or told wrongly."""
    client, simulator = example("mes_client"), example("mes_simulator")
    with (
        tempfile.TemporaryDirectory() as folder,
        standing(seed, model=write_presses(Path(folder) / "presses", PRESSES)) as station,
    ):
        for part in ("emulate", "server", "controller"):
            station.start(part)
        address, key = f"http://127.0.0.1:{station.port}", mes_key(station)
        day = simulator.Day(client.Mes(address, key), "", 0, 0.0, station.chance, name="queue")
        queue = Queue(station, day, client.Mes(address, key))
        station.wait(lambda: station.production() == "waiting", "it is not up")
        by_order = {"on": True, "reason": "the shift begins"}
        station.wait(lambda: station.ask("PUT", "settings/job-mode", by_order).is_success, "it works freely")
        queue.order(orders)
        for _ in range(20):
            queue.ask("while all are queued")
        before = _memory(station, "at the begin")
        began = time.monotonic()
        station.begin_production()
        queue.work(orders, iter(sorted(station.chance.sample(range(orders // 50, orders), kills))))
        seconds = time.monotonic() - began
        after = _memory(station, "at the end")
        queue.require_all(orders)
        seen: Counter[str] = station.seen + day.told + queue.figures.told() + before + after
        seen["most seconds until all are over"] = round(seconds)
        return seen


def _memory(station: Mortal, when: str) -> Counter[str]:
    """Of the two processes, with nothing beside them."""
    return Counter({f"most MB of the {part} {when}": station.memory(part) for part in ("server", "controller")})
