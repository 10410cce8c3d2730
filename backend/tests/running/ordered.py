"""Jobs that are ordered of a controller which is killed again and again.

Who orders them does as a server does: it commits that a job has ended before it lets the controller forget it, and asks
again for what was not answered.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
import sys
import tempfile
from collections import Counter
from pathlib import Path

from running.forked import Child, Hall, log_to_standard_error
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.jobs import ForgetJob, SetByOrder, TakeJob
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.journal import run_journal

JOBS = 2
MASTER = "truck_engine"


class OrderedChild(Child):
    """Its orders are in a file, which outlives it."""

    async def _operate(self) -> None:
        await asyncio.gather(super()._operate(), self._order())

    async def _order(self) -> None:
        outcomes = outcomes_of(self._url)
        while True:
            await asyncio.sleep(0.02)
            with contextlib.suppress(CommandRefused):
                view = self._controller.view()
                if not view.by_order:
                    await self._controller.command(SetByOrder(actor=SYSTEM, on=True, reason="so"))
                    continue
                for name, job in view.jobs.items():
                    if job.ended is not None and name not in outcomes.read_text().split():
                        with outcomes.open("a") as written:
                            written.write(f"{name}\n")
                ended = outcomes.read_text().split()
                for name in ended:
                    await self._controller.command(ForgetJob(actor=SYSTEM, job=name))
                self._say("ended", len(ended))
                if len(ended) < JOBS:
                    name = f"job-{len(ended) + 1}"
                    await self._controller.command(TakeJob(actor=SYSTEM, job=name, title=name, work_master=MASTER))


class OrderedHall(Hall):
    """The devices of such a station."""

    def __init__(self, folder: Path, seed: str) -> None:
        super().__init__(folder, seed)
        outcomes_of(self._url).touch()
        self.ended = 0

    def child(self, line: socket.socket, number: int) -> Child:
        return OrderedChild(self._url, line, f"{self._seed}.{number}")

    def heard(self, what: str, about: list[object]) -> None:
        if what == "ended":
            self.ended = int(str(about[0]))

    def goes_on(self, worked: bool) -> bool:
        """The last life lasts until all jobs have ended."""
        return not worked if self.killed else self.ended < JOBS


def outcomes_of(url: str) -> Path:
    """Where it is kept which jobs have ended."""
    return Path(f"{url.removeprefix('sqlite:///')}.outcomes")


def completed(database: Database, of: dict[str, frozenset[str]]) -> Counter[str]:
    """How often each operation of each job was completed, as `job/operation`.

    AssertionError where what comes before it was not, or what was completed once is not any more.
    """
    done: dict[str, set[str]] = {}
    seen: Counter[str] = Counter()
    with database.reading() as connection:
        records = run_journal.after(connection, 0, 1_000_000)
    for record in records:
        for name, job in json.loads(record.content).get("jobs", {}).items():
            before, now = done.get(name, set()), set((job or {}).get("completed", ()))
            assert job is None or before <= now, f"record {record.number}: {name} has {before - now} to do again"
            for operation in now - before:
                assert of[operation] <= before, f"record {record.number}: it was not the turn of {operation}"
                seen[f"{name}/{operation}"] += 1
            if job is None:
                assert before == of.keys(), f"record {record.number}: {name} was put away too early"
            else:
                done[name] = before | now
    return seen


def lives(seed: str, kills: int) -> Counter[str]:
    """So many lives of a controller, and one until all jobs have ended; how often each operation was completed."""
    with tempfile.TemporaryDirectory() as folder:
        hall = OrderedHall(Path(folder), seed)
        for number in range(kills):
            hall.live(number)
        hall.live(kills, kill=False)
        hall.judged()
        with contextlib.closing(Database.open(hall._url)) as database:
            return completed(database, dict(hall._station.automaton.work_masters[MASTER].operations))


if __name__ == "__main__":
    log_to_standard_error()
    sys.stdout.write(json.dumps(lives(sys.argv[1], int(sys.argv[2]))) + "\n")
