"""The truck engine station in the hall: what is true is known to its world alone, and hands reach it there."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from sequence_planner.simulation.truck_station.poses import PAIRS
from stations.hall import Hall, controlled, hall
from support.station import RunningStation

SPEED = 4.0
KEY = "operator.takes_over"
# The node behind each resource, by whose loss it is gone.
NODE_OF = {
    "robot": "ur10",
    "nutrunner": "tool_ecu",
    "end_effector": "rsp_ecu",
    "dock": "dock_ecu",
    "agv": "mircom",
    "engine": "rfidcam",
    "scene": "scene",
    "operator": "watch",
}
DEVICE_OF = {"nutrunner": "nutrunner", "end_effector": "effector", "agv": "agv", "robot": "arm"}


class HallHands:
    """Somebody beside the station, who also was who disturbed it."""

    def __init__(self, place: Hall) -> None:
        self._place = place
        self.known: dict[str, object] = {}
        self._stands = False  # a device that was jammed, until somebody has set it free

    def trip(self) -> None:
        """The robot stops where it is, and goes on only with a new command."""
        self._place.ask({"world": {"tripped": True}})

    def jam(self, resource: str) -> None:
        """A device stands still until somebody has looked at it."""
        self._place.ask({"world": {"jammed": [DEVICE_OF[resource]]}})
        self._stands = True

    def kill(self, resource: str) -> None:
        """The computer of a device is gone until somebody starts it again."""
        self._place.kill(NODE_OF[resource])

    def can_bring(self, changes: Mapping[str, object]) -> bool:
        """Nobody carries tools or brings the robot to a pose, but what stands still does so when it is set free."""
        return self._stands or not changes.keys() - {KEY}

    def bring(self, changes: Mapping[str, object]) -> None:
        """The key of the robot is turned; what stood still is set free, and does what it should have done."""
        if isinstance(key := changes.get(KEY), bool):
            self._place.ask({"world": {"takes_over": key}})
        if changes.keys() - {KEY}:
            self._place.ask({"world": {"jammed": []}})
            self._stands = False

    def online(self, resource: str) -> None:
        if self._place.nodes[NODE_OF[resource]].poll() is not None:  # else it is only being started
            self._place.start(NODE_OF[resource])

    def told_anew(self, resources: Collection[str]) -> None:
        """What is jammed stays so whatever it is told."""

    def make_true(self, estimate: str, value: object) -> bool:
        pair = estimate.removeprefix("bolts[").removesuffix("]")
        if pair not in PAIRS:
            return False
        self._place.ask({"world": {"bolts": {pair: value}}})
        return True

    def serve(self, task: Mapping[str, object]) -> None:
        """The person of the world does it, and has a watch."""

    @property
    def wrong(self) -> list[str]:
        return self._place.wrong

    @property
    def built(self) -> int:
        return self._place.counted["engine done"]


@contextmanager
def engine_station(folder: Path, seed: int) -> Iterator[tuple[RunningStation, HallHands]]:
    """The eight nodes, their world and the controller, with hands in the hall."""
    with hall(folder, SPEED, seed) as place, controlled(folder) as station:
        yield station, HallHands(place)
