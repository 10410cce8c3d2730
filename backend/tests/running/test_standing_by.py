"""Two stations for the same devices on one PostgreSQL: one commands, the other takes over, and nobody hears both."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable
from pathlib import Path

import httpx

from running.mortal import Mortal
from running.pairs import pair, standby, takes_over
from sequence_planner.process.parent_watch import OVERTAKEN
from sequence_planner.standby.lease import LASTS
from support.postgresql import Server
from support.waiting import until


def _taken_over(station: Mortal) -> None:
    """A station that stood by is live, and waits for a person."""
    takes_over(station)
    station.wait(lambda: station.production() == "waiting", "it does not wait for a person")


def _until(what: Callable[[], bool]) -> None:
    until(what, seconds=60.0)


def test_the_command_goes_from_one_to_the_other_and_back_and_nothing_is_lost(
    postgresql: Server, tmp_path: Path
) -> None:
    with pair(postgresql, tmp_path) as both:
        (first, second), ear = both.stations, both.ear
        first.wait(lambda: standby(first)["standing_by"] == ["press-b"], "nobody is told who stands by")
        refused = second.ask("PUT", "mode", {"mode": "paused"})
        assert refused.status_code == httpx.codes.SERVICE_UNAVAILABLE
        assert refused.json()["type"] == "/problems/on-standby"
        assert "press-a commands the devices" in refused.json()["detail"]
        first.get_back_to_work()

        # It stands still for longer than its lease lasts, and comes back.
        first.signal("controller", signal.SIGSTOP)
        first.kept.look()
        _taken_over(second)
        first.signal("controller", signal.SIGCONT)
        _until(lambda: first.ended("controller") == OVERTAKEN)
        assert second.production() == "waiting", "a person has not said so yet"
        second.get_back_to_work(at_rest=True)
        assert ear.require_one_after_the_other() == 2
        first.start("controller")
        first.wait(lambda: standby(first)["holder"] == "press-b", "it does not stand by")

        # The one that commands cannot reach the database any more.
        both.links["press-b"].cut()
        cut = time.monotonic()
        _taken_over(first)
        assert ear.last < cut + LASTS, "it went on commanding when its lease was over"
        both.links["press-b"].mend()
        _until(lambda: second.ended("controller") == OVERTAKEN)
        first.get_back_to_work(at_rest=True)
        assert ear.require_one_after_the_other() == 3
        second.start("controller")
        second.wait(lambda: standby(second)["holder"] == "press-a", "it does not stand by")

        # It is killed.
        first.kill("controller")
        first.kept.look()
        _taken_over(second)
        second.get_back_to_work(at_rest=True)
        assert ear.require_one_after_the_other() == 4

        first.kept.look()
        second.kill("controller")
        both.judge()
