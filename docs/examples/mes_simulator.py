"""A MES that orders for a day, changes its mind, and holds what it was told against the journal at the end.

    make run                                             # in one terminal: a station with emulated devices
    python docs/examples/mes_simulator.py --demonstration      # in another

At a station of its own it has a key, `STATION_KEY`, with the scopes `orders-read`, `orders-write` and `audit`, and
people there let the station work by order and do their tasks. With `--demonstration` it is those people too.

Orders come at times drawn by the seed over `--seconds`, into which a day is pressed. Some are sent twice, as if no
answer had come; some are changed, paused, stopped or aborted. At the end the abilities and operations of all responses
must be exactly those that the journal has, each once: the exit code is 1 if they are not.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from mes_client import Mes, Refused

LOOK_EVERY = 0.25  # seconds
OVER = ("job-order-ended", "job-order-aborted")
WHY = "the day is like that"


@dataclass
class Day:
    """The orders of a day and what has become of them. `people` do what they are asked to do at the station."""

    mes: Mes
    work_master: str
    orders: int
    seconds: float
    chance: random.Random
    people: Callable[[], object] = lambda: None
    name: str = field(default_factory=lambda: f"day-{int(time.time())}")
    told: Counter[str] = field(default_factory=Counter)  # events, by kind
    over: set[str] = field(default_factory=set)
    made: Counter[str] = field(default_factory=Counter)  # operations by the events, as `order/operation`

    def run(self, patience: float) -> None:
        """Order, until all is over. Raises `TimeoutError` when that takes longer than so many seconds after the day."""
        began = time.time()
        coming = sorted((self.chance.uniform(0, self.seconds), f"{self.name}.{n}") for n in range(self.orders))
        later: list[tuple[float, str, str]] = []
        mine = {id for _, id in coming}
        while mine - self.over:
            now = time.time() - began
            if now > self.seconds + patience:
                raise TimeoutError(f"not over yet: {self.waiting(mine)}")
            while coming and coming[0][0] <= now:
                later += self.order(coming.pop(0)[1], now)
            for due in [each for each in later if each[0] <= now]:
                later.remove(due)
                self.act(due[1], due[2])
            self.people()
            self.read_on()
            time.sleep(LOOK_EVERY)

    def order(self, id: str, now: float) -> Iterator[tuple[float, str, str]]:
        """Order something; what will be done about it, and when."""
        content = {
            "priority": self.chance.randrange(5),
            "due": time.time() + self.chance.uniform(0.1, 1.0) * self.seconds,
            "description": f"Order {id}",
        }
        for _ in range(self.chance.choice([1, 1, 2])):
            self.mes.order(id, self.work_master, **content)
        what = self.chance.choice(["", "", "", "", "change", "Pause", "Stop", "Abort"])
        if what:
            yield now + self.chance.uniform(0, 0.3) * self.seconds, id, what
        if what == "Pause":
            yield now + 0.5 * self.seconds, id, "Resume"

    def act(self, id: str, what: str) -> None:
        """Do something about an order; what it does not allow by now is left."""
        try:
            if what == "change":
                self.mes.change(id, priority=9, description="It is urgent now")
            else:
                self.mes.command(id, what, WHY)
            self.told[f"done: {what}"] += 1
        except Refused as refused:
            if refused.status != 409:
                raise
            self.told[f"too late: {what}"] += 1

    def read_on(self) -> None:
        """What has happened since."""
        for event in self.mes.events():
            if not event["job_order"].startswith(f"{self.name}."):
                continue
            self.told[event["kind"]] += 1
            if event["kind"] in OVER:
                self.over.add(event["job_order"])
            if event["kind"] == "operation-completed":
                self.made[f"{event['job_order']}/{event['content']['operation']}"] += 1

    def waiting(self, ids: set[str]) -> str:
        """What is not over, and why."""
        return "; ".join(f"{id}: {self.mes.get(id)['waits_for']}" for id in sorted(ids - self.over))

    def differences(self) -> list[str]:
        """What responses, events and journal do not agree on."""
        responses = [self.mes.response(id) for id in sorted(self.over)]
        starts = Counter((each["record"], each["ability"]) for found in responses for each in found["abilities"])
        completed = Counter(
            f"{found['job_order']}/{each['operation']}"
            for found in responses
            for each in found["operations"]
            if each["ended"] is not None
        )
        self.told["abilities started for orders"] = starts.total()
        self.told["operations completed"] = completed.total()
        journal = Journal(f"{self.name}.")
        with self.mes.open("GET", "history/export") as lines:
            for line in lines:
                journal.read(json.loads(line))
        return [
            *_different("starts in responses and journal", starts, journal.starts),
            *_different("completions in responses and journal", completed, journal.completed),
            *_different("completions in responses and events", completed, self.made),
        ]


class Journal:
    """What the run's journal says of the orders whose ids begin so: read here by its own rules, of
    `docs/journal.md`."""

    def __init__(self, ids: str) -> None:
        self._ids = ids
        self._jobs: dict[str, dict[str, Any]] = {}
        self.starts: Counter[tuple[int, str]] = Counter()  # while one of their operations was active
        self.completed: Counter[str] = Counter()

    def read(self, record: dict[str, Any]) -> None:
        """The next record."""
        content = record["content"]
        if record["kind"] in ("begun", "snapshot"):
            self._jobs = {}
        for id, job in content.get("jobs", {}).items():
            before = set((self._jobs.get(id) or {}).get("completed", {}))
            self._jobs[id] = job or {}
            if job and id.startswith(self._ids) and record["kind"] not in ("begun", "snapshot"):
                self.completed.update(f"{id}/{name}" for name in set(job.get("completed", {})) - before)
        if record["kind"] == "ticked" and any(map(self._is_active, self._jobs)):
            self.starts.update((record["number"], name) for name in content.get("started", ()))

    def _is_active(self, id: str) -> bool:
        job = self._jobs[id]
        started = set(job.get("started", {})) - set(job.get("completed", {}))
        return id.startswith(self._ids) and job.get("state") == "running" and bool(started)


def _different(what: str, one: Counter[Any], other: Counter[Any]) -> list[str]:
    if one == other:
        return []
    return [f"{what} differ: {dict((one - other).most_common(5))} against {dict((other - one).most_common(5))}"]


def demonstration(mes: Mes) -> Callable[[], object]:
    """Be the people of a demonstration: they let the station work by order, and do at once what they are asked to
    do."""
    with mes.open("POST", "session/demonstration", {}) as answer:
        mes.headers["Cookie"] = answer.headers["Set-Cookie"].partition(";")[0]
    mes.ask("PUT", "control", {"over": None})
    mes.ask("PUT", "work-by-order", {"on": True, "reason": WHY})

    def work() -> None:
        for id, task in mes.ask("GET", "tasks")["tasks"].items():
            try:
                mes.ask("POST", f"tasks/{id}/acknowledgement", {"revision": task["revision"]})
            except Refused as refused:
                if refused.status not in (404, 409):  # it has changed meanwhile
                    raise

    return work


def main() -> int:
    """The command line."""
    arguments = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    arguments.add_argument("--station", default="http://127.0.0.1:8000", help="its address")
    arguments.add_argument("--demonstration", action="store_true", help="it is one: be its people too")
    arguments.add_argument("--work-master", default="", help="what is ordered; by default the first that there is")
    arguments.add_argument("--orders", type=int, default=10)
    arguments.add_argument("--seconds", type=float, default=120.0, help="that the day takes")
    arguments.add_argument("--patience", type=float, default=900.0, help="seconds after the day until all must be over")
    arguments.add_argument("--seed", type=int, default=1)
    given = arguments.parse_args()
    mes = Mes(given.station, os.environ.get("STATION_KEY", ""))
    people = demonstration(mes) if given.demonstration else lambda: None
    master = given.work_master or next(iter(mes.ask("GET", "capabilities")["work_masters"]))
    day = Day(mes, master, given.orders, given.seconds, random.Random(given.seed), people)
    day.run(given.patience)
    differences = day.differences()
    for what, number in sorted(day.told.items()):
        print(f"{number:6} {what}")
    print("\n".join(differences) or "The responses are what the journal says.")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
