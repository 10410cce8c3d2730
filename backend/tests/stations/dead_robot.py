"""The robot dies in the middle of a bolt, and the bolts are tightened by hand: real processes, and REST alone.

What is done follows from what the station says. The world is asked only at the end what was truly done.
"""

from __future__ import annotations

import random
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from sequence_planner.simulation.truck_station.poses import PAIRS
from stations.disturbing import summed
from stations.hall import Hall, controlled, hall
from support.station import RunningStation
from support.waiting import until

SPEED = 3.0
LONG_ENOUGH = 120.0  # seconds
TAKE_OVER = "operator.takes_over"


@dataclass
class Operator:
    """Somebody beside the station, with its page."""

    place: Hall
    station: RunningStation
    asked: list[object] = field(default_factory=list)  # what the watch has asked for, each once in a row

    def do(self, path: str, body: Mapping[str, object]) -> int:
        """Ask for something with `PUT`."""
        return self.station.browser.put(path, json=body).status_code

    def watches(self) -> None:
        """Look at the watch."""
        task = self.station.value("operator.task")
        if task != "none" and self.asked[-1:] != [task]:
            self.asked.append(task)

    def are_tight(self, pairs: Sequence[str]) -> bool:
        """Whether the station believes that these bolts are."""
        variables = self.station.get("variables", "state")
        return all(variables[f"bolts[{pair}]"]["value"] == "tightened" for pair in pairs)

    def is_at_one_of(self, pairs: Sequence[str]) -> bool:
        """Whether the robot has been sent down to some of these bolts, and they are not tight yet."""
        target = str(self.station.value("robot.target_pose"))
        return target in pairs and not self.are_tight([target])

    def robot_dies(self, pairs: Sequence[str]) -> str:
        """At one of these it stands still and its computer is gone; the operator presses Hold. The pair."""
        while True:
            until(lambda: self.is_at_one_of(pairs), seconds=LONG_ENOUGH)
            self.place.ask({"world": {"jammed": ["arm"]}})
            assert self.do("mode", {"mode": "hold"}) == httpx.codes.NO_CONTENT
            if self.is_at_one_of(pairs):
                self.place.kill("ur10")
                return str(self.station.value("robot.target_pose"))
            self.place.ask({"world": {"jammed": []}})  # it was tight just before
            assert self.do("mode", {"mode": "automatic"}) == httpx.codes.NO_CONTENT

    def is_told_to_take_over(self) -> bool:
        """Whether the first advice that leaves out nothing is to take over."""
        answer = self.station.browser.get("recovery/proposals", timeout=30)
        offers = [offer for offer in answer.json().get("offers", ()) if not offer["left_out"]]
        acts = offers[0]["physical"] if offers else []
        if [(each["name"], each["then"]) for each in acts] != [(TAKE_OVER, True)]:
            return False
        assert "key" in acts[0]["by_hand"]["arguments"]["how"]["words"]["en"], "it is told how that is done"
        return True

    def goes_on(self) -> None:
        """As soon as the station allows that."""
        until(lambda: self.do("mode", {"mode": "automatic"}) == httpx.codes.NO_CONTENT)

    def put_robot(self, *, in_service: bool) -> None:
        """Take it out of service, or put it back."""
        body = {"in_service": in_service, "reason": "its computer is dead" if not in_service else "it was repaired"}
        assert self.do("availability/resource/robot", body) == httpx.codes.NO_CONTENT

    def robot_is_repaired(self) -> None:
        """Its computer is started again, it stands at home, and its key is turned back."""
        self.place.ask({"world": {"jammed": []}})
        self.place.start("ur10")
        until(lambda: self.station.value("robot.pose") == "HomeJOINTPose")
        assert self.station.value("robot.target_pose") == "HomeJOINTPose"
        self.place.ask({"world": {"takes_over": False}})


def worked_around(seed: str) -> Counter[str]:
    """One engine, at one of whose bolts the robot dies. AssertionError when it is not rightly built by hand."""
    chance = random.Random(seed)
    first = chance.randrange(len(PAIRS) - 2)  # one that gets tight just before Hold is not the last
    with (
        tempfile.TemporaryDirectory() as folder,
        hall(Path(folder), SPEED, chance.randrange(1000)) as place,
        controlled(Path(folder)) as station,
    ):
        operator = Operator(place, station)
        pair = operator.robot_dies(PAIRS[first:])
        operator.put_robot(in_service=False)
        until(operator.is_told_to_take_over)
        place.ask({"world": {"takes_over": True}})
        operator.goes_on()

        def all_are_tight() -> bool:
            operator.watches()
            return operator.are_tight(PAIRS)

        until(all_are_tight, seconds=LONG_ENOUGH)
        assert operator.asked == ["free", "guide"]
        operator.robot_is_repaired()
        operator.put_robot(in_service=True)
        until(lambda: station.completed("release_engine") == 1, seconds=LONG_ENOUGH)
        until(lambda: place.counted["engine done"] == 1)
        assert not place.wrong, place.wrong
        counted, number = place.counted, PAIRS.index(pair)
        by_hand = [each for each in PAIRS if counted[f"bolt tightened: {each} by hand"]]
        if counted[f"bolt found tight: {pair} by hand"]:  # its torque was reached as the tool was told to stop
            by_hand.insert(0, pair)
        assert by_hand == list(PAIRS[number:])
        assert all(counted[f"bolt tightened: {each}"] for each in PAIRS[:number])
        return summed(counted) + Counter({"robots that died in the middle of a bolt": 1})
