"""The robot arm: joints that move to a goal at a limited speed."""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.emulation.truck_station.poses import HOME, POSES, Joints

FULL_SPEED = 2.0  # rad/s of the joint that has the farthest way, at a speed scaling of 1


@dataclass
class Arm:
    """Six joints. What it was told last it carries out to the end, whether or not its driver still lives."""

    joints: Joints = POSES[HOME]
    goal: Joints = POSES[HOME]
    scaling: float = 0.1
    speeds: Joints = (0.0,) * 6
    jammed: bool = False  # it stands still with its goal before it
    told: tuple[Joints, float] | None = None  # the last command; the same one again is none
    _off: bool = False

    @property
    def off(self) -> bool:
        """Whether it is switched off by its key: it drops what it was about, and takes no commands."""
        return self._off

    @off.setter
    def off(self, off: bool) -> None:
        if off and not self._off:
            self.goal = self.joints
        self._off = off

    def command(self, goal: Joints, scaling: float) -> None:
        """Set out for `goal`. A scaling outside 0 to 1 is brought there. A command while it is off is lost."""
        self.told = (goal, scaling)
        if not self.off:
            self.goal, self.scaling = goal, min(max(scaling, 0.0), 1.0)

    def trip(self) -> None:
        """It stops where it is, as when it was touched, and waits for another command."""
        self.goal = self.joints

    def push(self, joints: Joints) -> None:
        """Somebody pushes it there by hand, as long as it is off."""
        if self.off:
            self.joints = self.goal = joints

    def advance(self, seconds: float) -> None:
        """Move on for so long."""
        ways = [b - a for a, b in zip(self.joints, self.goal, strict=True)]
        farthest = max(map(abs, ways))
        if farthest == 0 or self.jammed or seconds <= 0:
            self.speeds = (0.0,) * 6
            return
        share = min(1.0, FULL_SPEED * self.scaling * seconds / farthest)
        before = self.joints
        self.joints = self.goal if share == 1.0 else tuple(a + share * way for a, way in zip(before, ways, strict=True))
        self.speeds = tuple((b - a) / seconds for a, b in zip(before, self.joints, strict=True))
