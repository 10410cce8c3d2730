"""The station in the hall under random faults from which it recovers by itself, judged by what is true there alone."""

from __future__ import annotations

import random
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from sequence_planner.simulation.truck_station.signals import NODES
from stations.hall import Hall, controlled, hall

CALM = (1.5, 5.0)  # seconds between two faults
# Seconds for which a fault lasts. A nutrunner whose driver has heard nothing for longer than 3 s stands still, wherever
# the robot is driving it: the way out of that is for restart mode, so this driver is only silent, or started again.
LASTS = (0.3, 2.0)
LONGEST_WITHOUT_PROGRESS = 90.0  # seconds without an event of the world
# What a node says that means nothing.
NONSENSE: dict[str, dict[str, object]] = {
    "ur10": {"actual_pose": "nowhere"},
    "rsp_ecu": {"robot_not_connected_to_tool": True, "robot_connected_to_lf_tool": True},
    "mircom": {"act_pos": "in the lift"},
}


@dataclass
class Trouble:
    """Somebody who disturbs the nodes of a hall again and again."""

    place: Hall
    chance: random.Random
    seen: Counter[str] = field(default_factory=Counter)

    def make(self) -> None:
        """One fault."""
        acts: tuple[Callable[[], None], ...] = (self._fault, self._fault, self._nonsense, self._restart, self._jam)
        self.chance.choice(acts)()

    def _fault(self) -> None:
        kind = self.chance.choice(("silent", "stuck", "offline"))
        node = self.chance.choice(NODES)
        self._set(node, "silent" if node == "tool_ecu" else kind, {})

    def _nonsense(self) -> None:
        node = self.chance.choice(sorted(NONSENSE))
        self._set(node, "wrong", NONSENSE[node])

    def _set(self, node: str, kind: str, fields: dict[str, object]) -> None:
        seconds = self.chance.uniform(*LASTS)
        self.place.ask({"fault": {"node": node, "kind": kind, "seconds": seconds, "fields": fields}})
        self.seen[f"{kind} nodes"] += 1

    def _restart(self) -> None:
        node = self.chance.choice(NODES)
        self.place.kill(node)
        self.place.start(node)
        self.seen["nodes killed and started again"] += 1

    def _jam(self) -> None:
        jammed = self.chance.choice(("arm", "agv", "effector"))
        self.place.ask({"world": {"jammed": [jammed], "slowness": self.chance.uniform(0.5, 2.0)}})
        time.sleep(self.chance.uniform(*LASTS))
        self.place.ask({"world": {"jammed": []}})
        self.seen["devices that stood still for a while"] += 1


def assembled(seconds: float, seed: str, speed: float, engines: int | None = None) -> Counter[str]:
    """Let the station work under faults for so long, or until so many engines are done.

    AssertionError when a wrong step was taken, a wrong engine left, or nothing goes on any more.
    """
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder, hall(Path(folder), speed, chance.randrange(1000)) as place:
        trouble = Trouble(place, chance)
        with controlled(Path(folder)) as controller:
            end, calm_until = time.monotonic() + seconds, 0.0
            events, progress = 0, time.monotonic()
            while (now := time.monotonic()) < end:
                if now >= calm_until:
                    trouble.make()
                    calm_until = time.monotonic() + chance.uniform(*CALM)
                time.sleep(0.2)
                counted = place.counted
                assert not place.wrong, (place.wrong, place.ask({"verdict": True})["events"][-10:])
                if counted.total() > events:
                    events, progress = counted.total(), now
                stands = f"nothing goes on: {controller.get('alarms')}" if now - progress > 60 else ""
                assert now - progress < LONGEST_WITHOUT_PROGRESS, stands
                if engines is not None and counted["engine done"] >= engines:
                    break
        return trouble.seen + summed(place.counted)


def summed(events: Counter[str]) -> Counter[str]:
    """Events by their kind: what stands before the colon."""
    kinds: Counter[str] = Counter()
    for event, number in events.items():
        kinds[event.partition(":")[0]] += number
    return kinds
