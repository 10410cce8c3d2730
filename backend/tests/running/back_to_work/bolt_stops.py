"""How the bolt tightening station is stopped."""

from __future__ import annotations

from dataclasses import dataclass

from running.back_to_work.bolts import PAIRS, BoltHands
from running.back_to_work.stops import CORRECTION, PHYSICAL, RESET, RESTART, Stops, Ways


@dataclass
class BoltStops(Stops):
    """Its devices stand still, are away, or are moved by hand."""

    hands: BoltHands
    pairs = PAIRS

    def ways(self) -> Ways:
        """See `Stops.ways`."""
        return {
            "the robot stops between two poses": (RESTART, self.between),
            "bolts are taken out": (CORRECTION, lambda: self.otherwise("placed", "empty")),
            "bolts are placed unasked": (CORRECTION, lambda: self.otherwise("empty", "placed")),
            "bolts are tightened by hand": (CORRECTION, lambda: self.otherwise("placed", "tightened")),
            "tight bolts are taken out": (CORRECTION, lambda: self.otherwise("tightened", "empty")),
            "the nutrunner does not turn": (PHYSICAL, self.stands),
            "the robot is gone": (PHYSICAL, lambda: self.gone("robot")),
            "the nutrunner is gone": (PHYSICAL, lambda: self.gone("nutrunner")),
            "the robot is pushed away": (PHYSICAL, self.pushed),
            "held in the middle of a bolt": (RESET, self.held),
            "the scene is to be made anew": (RESET, self.scene),
            "the controller is killed": ("", self.killed),
        }

    def between(self) -> None:
        """The one before is another one than that which it was sent to."""
        self.work_a_little()
        while True:
            self.moment(self.goes)
            self.hands.stop("robot")
            if self.goes():
                break
            self.hands.told_anew({"robot"})  # it was there before
        self._off()

    def pushed(self) -> None:
        """It stands wherever it is, and is pushed from there."""
        self.work_a_little()
        self.hands.stop("robot")
        self._off()

    def _off(self) -> None:
        self.hands.bolts.guided = True
        self.hands.push({"robot.pose": "unknown", "robot.moving": False})
        self.notice()

    def stands(self) -> None:
        """It is told to turn, and does not."""
        self.work_a_little()
        self.hands.stop("nutrunner")
        self.notice()

    def gone(self, resource: str) -> None:
        """Its devices are not on the network."""
        self.work_a_little()
        self.hands.fault(f"{resource} offline")
        self.notice()

    def held(self) -> None:
        """The tool turns, and is told to stop."""
        self.moment(lambda: self.person.get("abilities")["abilities"]["nutrunner.run_nut"]["executing"] is True)
        self.resets("hold", lambda operation: operation.startswith("tighten"))

    def scene(self) -> None:
        """Somebody thinks that the motion planner should be told again what the robot holds."""
        self.work_a_little()
        self.person.do("POST", "restart/enter", {})
        self.person.wait_for_rest()
        self.person.reset("prepare_planning_scene")
