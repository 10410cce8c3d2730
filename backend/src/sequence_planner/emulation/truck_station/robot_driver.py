"""The computer of the robot: poses by name, and a memory of the last command, so that it is carried out once."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.emulation.truck_station.drivers import Listening, Record, Signals
from sequence_planner.emulation.truck_station.poses import POSES, named

MOVING = 0.01  # rad/s of any of the first five joints
FORGET = ("UNKNOWN", "RESET")
FIELDS = ("action", "robot_type", "robot_name", "pose_type", "pose_name", "speed_scaling", "acc_scaling")
ROBOT_TYPE, ROBOT_NAME = "UR10", "TARS"


class RobotDriver(Listening):
    """A command that equals the one before it is ignored, until a pose named UNKNOWN or RESET makes it forget."""

    def __init__(self) -> None:
        super().__init__()
        self._taken: Record | None = None
        self._errors: list[str] = []
        self._previous = "UNKNOWN"
        self._target = "UNKNOWN"

    def hear(self, command: Record, now: float) -> None:
        """See `Driver.hear`."""
        super().hear(command, now)
        pose = str(command.get("pose_name", ""))
        self._errors = _errors(command)
        if pose in FORGET:
            self._taken = None
        elif command != self._taken and not self._errors:
            self._taken = command
            self._target = pose

    def signals(self, now: float) -> Signals:
        """See `Driver.signals`."""
        if (command := self._taken) is None:
            return {}
        speed = command.get("speed_scaling")
        return {
            "pose": command.get("pose_name"),
            "action": command.get("action"),
            "scaling": float(speed) if isinstance(speed, (int, float)) else 0.0,
        }

    def say(self, read: Record, now: float) -> dict[str, object]:
        """See `Driver.say`."""
        moving = any(abs(speed) >= MOVING for speed in _numbers(read["speeds"])[:5])
        pose = named(_numbers(read["joints"]))
        if not moving and pose is not None:
            self._previous = pose
        return {
            "info": {"robot_name": ROBOT_NAME, "fresh_msg": self.fresh(now), "error_list": self._errors},
            "ricochet": {f"got_{name}": str(self.command(now).get(name, "")) for name in FIELDS},
            "moving": moving,
            "actual_pose": f"moving from {self._previous} to {self._target}" if moving else pose or "UNKNOWN",
        }


def _errors(command: Record) -> list[str]:
    errors = [] if command.get("robot_type") == ROBOT_TYPE else [f"robot type mismatch: {command.get('robot_type')}"]
    if command.get("robot_name") != ROBOT_NAME:
        errors.append(f"robot name mismatch: {command.get('robot_name')}")
    if (pose := command.get("pose_name")) not in (*POSES, *FORGET):
        errors.append(f"no such pose is saved: {pose}")
    return errors


def _numbers(values: object) -> tuple[float, ...]:
    return tuple(float(value) for value in values) if isinstance(values, Sequence) else ()
