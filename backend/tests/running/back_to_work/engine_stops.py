"""How the truck engine station in the hall is stopped."""

from __future__ import annotations

from dataclasses import dataclass

from running.back_to_work.engine import HallHands
from running.back_to_work.stops import CORRECTION, PHYSICAL, RESET, RESTART, Stops, Ways
from sequence_planner.simulation.truck_station.poses import PAIRS


@dataclass
class EngineStops(Stops):
    """Its devices stand still, and their computers are killed."""

    hands: HallHands
    pairs = PAIRS

    def ways(self) -> Ways:
        """See `Stops.ways`."""
        return {
            "the robot trips between two poses": (RESTART, self.trips),
            "bolts are tightened by hand": (CORRECTION, lambda: self.otherwise("placed", "tightened")),
            "bolts are placed unasked": (CORRECTION, lambda: self.otherwise("empty", "placed")),
            "tight bolts are loosened": (CORRECTION, lambda: self.otherwise("tightened", "placed")),
            "the robot's computer is gone": (PHYSICAL, lambda: self.gone("robot")),
            "the end-effector's computer is gone": (PHYSICAL, lambda: self.gone("end_effector")),
            "the computer of the scene is gone": (PHYSICAL, lambda: self.gone("scene")),
            "the nutrunner's computer is gone": (PHYSICAL, lambda: self.gone("nutrunner")),
            "a valve is stuck": (PHYSICAL, lambda: self.stands("end_effector")),
            "the nutrunner does not turn": (PHYSICAL, lambda: self.stands("nutrunner")),
            "paused in the middle of an operation": (RESET, lambda: self.resets("paused", bool)),
            "held in the middle of an operation": (RESET, lambda: self.resets("hold", bool)),
            "the controller is killed": ("", self.killed),
        }

    def trips(self) -> None:
        """Somebody has touched it on its way."""
        self.work_a_little()
        while True:
            self.moment(lambda: self.goes() and self.person.value("robot.moving") is True)
            self.hands.trip()
            self.person.wait_for_rest()
            if self.goes() and self.person.value("robot.pose") == "UNKNOWN":
                return
            self.person.tell("it was there before")

    def gone(self, resource: str) -> None:
        """Its computer is gone, whatever its device does."""
        self.work_a_little()
        self.hands.kill(resource)
        self.notice()

    def stands(self, resource: str) -> None:
        """It does nothing of what it is told."""
        self.work_a_little()
        self.hands.jam(resource)
        self.notice()
