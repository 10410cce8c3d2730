"""Two stations for the same devices on one PostgreSQL, and a foreign subscriber that hears both."""

from __future__ import annotations

import random
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from running.judging import Judge
from running.mortal import Mortal
from running.relay import Relay, relay
from running.wire import Wire, listening
from sequence_planner.db.database import Database
from sequence_planner.ros.transport import Sample
from support.postgresql import Server
from support.simulated import truck_engine
from support.station import MODEL

NAMES = ("press-a", "press-b")
SOON = 5.0  # seconds within which the other has taken over


@dataclass
class Ear:
    """Who has spoken on each topic, one after the other, as a foreign subscriber hears it, and when last."""

    speakers: dict[str, list[int]] = field(default_factory=lambda: defaultdict(list))
    last: float = 0.0

    def take(self, samples: Sequence[Sample]) -> None:
        for each in samples:
            self.last = each.received
            if self.speakers[each.topic][-1:] != [each.source]:
                self.speakers[each.topic].append(each.source)

    def require_one_after_the_other(self) -> int:
        """How many have spoken; AssertionError when somebody did again after another."""
        for topic, speakers in self.speakers.items():
            assert len(speakers) == len(set(speakers)), f"{topic} was commanded by turns: {speakers}"
        return max(map(len, self.speakers.values()))


@dataclass
class Pair:
    """Which of them commands changes; each has a link of its own to the database, that can be cut."""

    stations: tuple[Mortal, Mortal]
    ear: Ear
    database: Database
    wire: Wire
    links: dict[str, Relay]

    def judge(self) -> None:
        """Both have ended. AssertionError when something happened twice, or was commanded and not decided."""
        station, supervisor, _ = truck_engine()
        judge = Judge(station.automaton, supervisor)
        judge.judge(self.database)
        for topic, heard in self.wire.heard.items():
            judge.require_decided(topic, heard)
        assert judge.starts.total() > 0


@contextmanager
def pair(postgresql: Server, folder: Path, model: Path = MODEL) -> Iterator[Pair]:
    """Both are there, and the first commands."""
    url = postgresql.new_database()
    with ExitStack() as stack:
        database = Database.open(url)
        stack.callback(database.close)
        database.upgrade()
        ear = Ear()
        wire = stack.enter_context(listening(truck_engine()[0], ear.take))
        links, both = {}, []
        for name in NAMES:
            own = folder / name
            own.mkdir()
            links[name] = stack.enter_context(relay(postgresql.folder, own))
            over = url.replace(str(postgresql.folder).replace("/", "%2F"), str(own).replace("/", "%2F"))
            assert over != url
            both.append(Mortal(own, database, random.Random(name), over, name, model=model))
        first, second = both
        stack.callback(second.end)
        stack.callback(first.end)
        first.start("emulate")
        for each in both:
            each.start("server")
        first.start("controller")
        first.wait(lambda: first.production() is not None, "the first is not up")
        first.wait(lambda: standby(first)["active"] is True, "the first does not command")
        second.start("controller")
        second.wait(lambda: standby(second)["holder"] == NAMES[0], "the second does not stand by")
        yield Pair((first, second), ear, database, wire, links)


def standby(station: Mortal) -> dict[str, object]:
    """What a station says of who commands."""
    try:
        answer = station.browser.get("station")
    except httpx.HTTPError:
        return {"holder": None, "active": False, "standing_by": []}
    found: dict[str, object] = (answer.json() if answer.is_success else {}).get("standby") or {}
    return {"holder": None, "active": False, "standing_by": [], **found}


def takes_over(station: Mortal) -> float:
    """Seconds until a station that stood by commands."""
    began = time.monotonic()
    station.wait(lambda: standby(station)["active"] is True, "nobody takes over")
    return time.monotonic() - began
