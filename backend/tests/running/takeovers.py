"""Takeovers that nobody needs to confirm, one after the other, between two stations."""

from __future__ import annotations

import random
import shutil
import signal
import tempfile
from collections import Counter
from pathlib import Path

from running.mortal import Mortal
from running.pairs import Pair, pair, standby, takes_over
from sequence_planner.process.parent_watch import OVERTAKEN
from support.places import REPOSITORY
from support.postgresql import binaries, running_server
from support.station import MODEL
from support.waiting import until

SOON = 5.0  # seconds in which the other has to command
AGAIN = "killed and started again at once"
STEP = 0.5  # seconds of what is told of that


def automatic(folder: Path) -> Path:
    """The bolt tightening station, which goes on by itself where the other took over."""
    model = folder / "model"
    shutil.copytree(REPOSITORY / MODEL, model)
    station = model / "station.yaml"
    station.write_text(f"{station.read_text(encoding='utf-8')}\ntakeover: automatic\n", encoding="utf-8")
    return model


def takeovers(seed: str, number: int) -> Counter[str]:
    """So many; AssertionError when both were heard by turns, something is lost, or the other does not come soon."""
    chance, seen = random.Random(seed), Counter[str]()
    programs = binaries()
    assert programs is not None, "PostgreSQL is not here"
    with (
        running_server(programs) as postgresql,
        tempfile.TemporaryDirectory() as folder,
        pair(postgresql, Path(folder), automatic(Path(folder))) as both,
    ):
        commands, other = both.stations
        commands.get_back_to_work()
        for count in range(number):
            what = chance.choice([AGAIN, "killed", "stopped", "cut off"])
            seen[f"{what} while it commanded"] += 1
            took = _trouble(both, commands, other, what)
            seen[f"the other commands within {STEP * (1 + took // STEP):.1f} s"] += 1
            assert took < SOON, f"{what}: the other took {took:.1f} s"
            seen[_goes_on(other, by_itself=what == AGAIN)] += 1
            other.go_on()
            assert both.ear.require_one_after_the_other() == count + 2
            _back(both, commands, what)
            commands, other = other, commands
        commands.kept.look()
        commands.kill("controller")
        both.judge()
        seen["commands heard by devices"] += sum(map(len, both.wire.heard.values()))
    return seen


def _trouble(both: Pair, station: Mortal, other: Mortal, what: str) -> float:
    """Seconds until the other commands."""
    if what in (AGAIN, "killed"):
        station.kill("controller")
        if what == AGAIN:
            station.start("controller")
    elif what == "stopped":
        station.signal("controller", signal.SIGSTOP)
    else:
        both.links[str(station.standby)].cut()
    station.kept.look()
    return takes_over(other)


def _goes_on(station: Mortal, *, by_itself: bool) -> str:
    """How production goes on: by itself only where it was told in time that all is recorded, once a person has decided
    on outputs where somebody has to. Else it says that it begins paused, and a person lets it go on.
    """
    decided = []

    def at_rest() -> bool:
        return station.production() == "waiting" and "begins-at-rest" in station.alarms()

    def goes_on() -> bool:
        if not at_rest() and station.production() == "waiting":
            decided.append(station.decide())
        return at_rest() or station.production() == "started"

    station.wait(goes_on, "it does not go on")
    if not at_rest():
        assert by_itself, "nobody knows whether somebody has stopped it"
        return "a person decided what an output shall be" if any(decided) else "it went on by itself"
    assert station.mode() == "paused"
    station.begin_production()
    station.ask("PUT", "mode", {"mode": "automatic"}).raise_for_status()
    return "it was told too late that all is recorded" if by_itself else "a person let it go on"


def _back(both: Pair, station: Mortal, what: str) -> None:
    """It stands by after that."""
    if what == "stopped":
        station.signal("controller", signal.SIGCONT)
    elif what == "cut off":
        both.links[str(station.standby)].mend()
    if what == AGAIN:
        station.kill("controller")
    elif what != "killed":
        until(lambda: station.ended("controller") == OVERTAKEN, seconds=60.0)
    station.start("controller")
    station.wait(lambda: standby(station)["holder"] not in (None, station.standby), "it does not stand by")
