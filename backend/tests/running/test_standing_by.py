"""Two stations for the same devices on one PostgreSQL: one commands, the other takes over, and nobody hears both."""

from __future__ import annotations

import random
import signal
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

import httpx
import pytest

from control.rig import truck_engine
from running.judging import Judge
from running.mortal import Mortal
from running.relay import Relay, relay
from running.stations import eventually
from running.wire import Wire, listening
from sequence_planner.lifeline import OVERTAKEN
from sequence_planner.ros.transport import Sample
from sequence_planner.standby.lease import LASTS
from sequence_planner.storage.database import Database
from storage.servers import Server


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
    first: Mortal
    second: Mortal
    links: dict[str, Relay]
    ear: Ear
    database: Database
    wire: Wire


@pytest.fixture
def pair(postgresql: Server, tmp_path: Path) -> Iterator[Pair]:
    url = postgresql.new_database()
    with ExitStack() as stack:
        database = Database.open(url)
        stack.callback(database.close)
        database.upgrade()
        ear = Ear()
        wire = stack.enter_context(listening(truck_engine()[0], ear.take))
        links, both = {}, []
        for name in ("press-a", "press-b"):
            folder = tmp_path / name
            folder.mkdir()
            links[name] = stack.enter_context(relay(postgresql.folder, folder))
            own = url.replace(str(postgresql.folder).replace("/", "%2F"), str(folder).replace("/", "%2F"))
            assert own != url
            both.append(Mortal(folder, database, random.Random(name), own, name))
        first, second = both
        stack.callback(second.end)
        stack.callback(first.end)
        first.start("emulate")
        for each in both:
            each.start("server")
        first.start("controller")
        first.wait(lambda: first.production() == "waiting", "the first is not up")
        second.start("controller")
        second.wait(lambda: _standby(second)["holder"] == "press-a", "the second does not stand by")
        yield Pair(first, second, links, ear, database, wire)


def _standby(station: Mortal) -> dict[str, object]:
    try:
        answer = station.browser.get("station")
    except httpx.HTTPError:
        return {"holder": None, "active": False, "standing_by": []}
    found: dict[str, object] = (answer.json() if answer.is_success else {}).get("standby") or {}
    return {"holder": None, "active": False, "standing_by": [], **found}


def _taken_over(station: Mortal) -> float:
    """Seconds until a station that stood by is live, and waits for a person."""
    began = time.monotonic()
    station.wait(lambda: _standby(station)["active"] is True and station.production() == "waiting", "nobody takes over")
    return time.monotonic() - began


def _until(what: Callable[[], bool]) -> None:
    eventually(what, 60.0)


def test_the_command_goes_from_one_to_the_other_and_back_and_nothing_is_lost(pair: Pair) -> None:
    first, second, ear = pair.first, pair.second, pair.ear
    first.wait(lambda: _standby(first)["standing_by"] == ["press-b"], "nobody is told who stands by")
    refused = second.ask("PUT", "mode", {"mode": "paused"})
    assert refused.status_code == httpx.codes.SERVICE_UNAVAILABLE
    assert refused.json()["type"] == "/problems/stands-by"
    assert "press-a commands the devices" in refused.json()["detail"]
    first.get_back_to_work()

    # It stands still for longer than its lease lasts, and comes back.
    first.signal("controller", signal.SIGSTOP)
    first.kept.look()
    _taken_over(second)
    first.signal("controller", signal.SIGCONT)
    _until(lambda: first.ended("controller") == OVERTAKEN)
    assert second.production() == "waiting", "a person has not said so yet"
    second.get_back_to_work()
    assert ear.require_one_after_the_other() == 2
    first.start("controller")
    first.wait(lambda: _standby(first)["holder"] == "press-b", "it does not stand by")

    # The one that commands cannot reach the database any more.
    pair.links["press-b"].cut()
    cut = time.monotonic()
    _taken_over(first)
    assert ear.last < cut + LASTS, "it went on commanding when its lease was over"
    pair.links["press-b"].mend()
    _until(lambda: second.ended("controller") == OVERTAKEN)
    first.get_back_to_work()
    assert ear.require_one_after_the_other() == 3
    second.start("controller")
    second.wait(lambda: _standby(second)["holder"] == "press-a", "it does not stand by")

    # It is killed.
    first.kill("controller")
    first.kept.look()
    _taken_over(second)
    second.get_back_to_work()
    assert ear.require_one_after_the_other() == 4

    first.kept.look()
    second.kill("controller")
    station, supervisor, _ = truck_engine()
    judge = Judge(station.automaton, supervisor)
    judge.judge(pair.database)
    for topic, heard in pair.wire.heard.items():
        judge.require_decided(topic, heard)
    assert judge.starts.total() > 0
