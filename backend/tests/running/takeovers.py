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
from running.stations import MODEL, REPOSITORY, eventually
from sequence_planner.lifeline import OVERTAKEN
from storage.servers import binaries, running_server

SOON = 5.0  # seconds in which the other has to command
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
            what = chance.choice(["killed", "stopped", "cut off"])
            seen[f"{what} while it commanded"] += 1
            took = _trouble(both, commands, other, what)
            seen[f"the other commands within {STEP * (1 + took // STEP):.1f} s"] += 1
            assert took < SOON, f"{what}: the other took {took:.1f} s"
            seen["a person decided what an output shall be" if _goes_on(other) else "it went on by itself"] += 1
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
    if what == "killed":
        station.kill("controller")
    elif what == "stopped":
        station.signal("controller", signal.SIGSTOP)
    else:
        both.links[str(station.standby)].cut()
    station.kept.look()
    return takes_over(other)


def _goes_on(station: Mortal) -> bool:
    """Production goes on, once a person has decided on outputs, where somebody has to; whether that was so."""
    decided = []

    def started() -> bool:
        if station.production() == "waiting":
            decided.append(station.decide())
        return station.production() == "started"

    station.wait(started, "it does not go on")
    return any(decided)


def _back(both: Pair, station: Mortal, what: str) -> None:
    """It stands by after that."""
    if what == "stopped":
        station.signal("controller", signal.SIGCONT)
    elif what == "cut off":
        both.links[str(station.standby)].mend()
    if what != "killed":
        eventually(lambda: station.ended("controller") == OVERTAKEN, 60.0)
    station.start("controller")
    station.wait(lambda: standby(station)["holder"] not in (None, station.standby), "it does not stand by")
