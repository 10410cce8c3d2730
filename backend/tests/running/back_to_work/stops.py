"""How a station at work is stopped, so that it does not go on by itself: what every station has in common.

A way is named by the way back that is meant for it: what is offered of that kind is taken before anything else.
"""

from __future__ import annotations

import os
import random
import signal
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

from running.back_to_work.person import Person
from support.station import RunningStation
from support.waiting import PATIENCE, until

RESTART, CORRECTION, PHYSICAL, RESET = "restart", "correction", "physical", "reset"
KINDS = (RESTART, CORRECTION, PHYSICAL, RESET)
LONGEST = 45.0  # seconds in which a moment for a stop comes

Ways = dict[str, tuple[str, Callable[[], None]]]


@dataclass
class Stops(ABC):
    """Whoever stops a station, at moments that `chance` draws."""

    station: RunningStation
    person: Person
    chance: random.Random
    pairs: ClassVar[Sequence[str]]  # of bolts

    @abstractmethod
    def ways(self) -> Ways:
        """Each way to stop it by its name, with the way back that is meant."""

    def drawn(self, number: int) -> list[str]:
        """The names of so many ways: of each kind one, then any, in any order."""
        ways = self.ways()
        found = [self.chance.choice([name for name, (each, _) in ways.items() if each == kind]) for kind in KINDS]
        found += self.chance.choices(sorted(ways), k=max(0, number - len(found)))
        self.chance.shuffle(found)
        return found[:number]

    def moment(self, what: Callable[[], bool]) -> None:
        """Wait for a moment that has to come; where the station stands before it, it is got back to work for it."""
        for _ in range(3):
            if self.person.until(what, LONGEST):
                return
            self.person.tell("it stands by itself")
            self.person.get_back()
        raise AssertionError(f"no moment to stop it: {self.person.get('alarms')['alarms']}")

    def work_a_little(self) -> None:
        """Some operations are done first."""
        self.person.works(operations=self.chance.randrange(1, 3))

    def notice(self) -> None:
        """The station notices that it stands, and says so."""
        self.moment(lambda: any(alarm["ended"] is None for alarm in self.person.get("alarms")["alarms"].values()))

    def goes(self) -> bool:
        """Whether the robot is sent from one pose to another."""
        state = self.person.get("state")["variables"]
        return bool(state["robot.target_pose"]["value"] != state["robot.previous_pose"]["value"])

    def otherwise(self, believed: str, true: str) -> None:
        """In a pause, a hand makes something of a pair that the station does not know."""
        found: list[str] = []

        def there() -> bool:
            state = self.person.get("state")["variables"]
            found[:] = [pair for pair in self.pairs if state[f"bolts[{pair}]"]["value"] == believed]
            return bool(found)

        while True:
            self.moment(there)
            self.person.do("PUT", "mode", {"mode": "paused"})
            self.person.wait_for_rest()
            if there():
                break
            self.person.do("PUT", "mode", {"mode": "automatic"})
        pair = self.chance.choice(found)
        self.person.tell(f"{pair} is {true}")
        self.person.hands.make_true(f"bolts[{pair}]", true)
        self.person.hands.known[f"bolts[{pair}]"] = true

    def resets(self, stop: str, wanted: Callable[[str], bool]) -> None:
        """Held or paused in the middle of an operation, which is then reset."""
        self.moment(lambda: any(map(wanted, self.active())))
        self.person.do("PUT", "mode", {"mode": stop, "reason": "a doubt"})
        operations = list(filter(wanted, self.active()))
        self.person.do("POST", "restart/enter", {})
        self.person.wait_for_rest()
        for operation in operations:
            self.person.reset(operation)

    def active(self) -> list[str]:
        """The operations that are active."""
        return [name for name, each in self.person.get("operations")["operations"].items() if each["active"]]

    def killed(self) -> None:
        """The controller dies, and is started again by its launcher."""
        self.work_a_little()
        os.kill(self.station.child("controller"), signal.SIGKILL)
        until(lambda: not self.station.up())
        until(self.station.up, seconds=3 * PATIENCE)
