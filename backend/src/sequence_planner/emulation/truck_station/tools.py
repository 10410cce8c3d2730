"""The nutrunner with its lift, the end-effector, and the person who works with them. Times in seconds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Run = Literal["idle", "forward", "reverse", "inhibit"]

STARTS_IN, VALVE_TAKES = 0.3, 0.4
LASTS = {"place": 3.0, "guide": 6.0, "free": 8.0}


@dataclass
class Nutrunner:
    """A spindle that turns a moment after it was told to and stops at its torque, and the lift that bears it."""

    run: Run = "idle"
    lift: Literal["hold", "float"] = "hold"
    turning: bool = False
    torque: bool = False  # from the torque until it is told to be idle
    jammed: bool = False
    _due: float | None = None

    def advance(self, now: float) -> None:
        """Let time pass."""
        if self.run == "idle":
            self.torque = False
        wanted = self.run in ("forward", "reverse") and not self.torque
        if self.jammed or wanted == self.turning:
            self._due = None
        elif self._due is None:
            self._due = now + STARTS_IN
        elif now >= self._due:
            self.turning, self._due = wanted, None


@dataclass
class EndEffector:
    """Two valves: of the lock and of the gripper. They move a moment after they were told to."""

    lock_wanted: bool = False
    close_wanted: bool = True
    locked: bool = False
    closed: bool = True
    jammed: bool = False
    _lock_due: float | None = None
    _grip_due: float | None = None

    def advance(self, now: float) -> list[str]:
        """Let time pass; says what moved: `lock`, `unlock`, `close`, `open`."""
        moved: list[str] = []
        if self.jammed:
            return moved
        self._lock_due = _due(self._lock_due, self.lock_wanted != self.locked, now)
        if self._lock_due is not None and now >= self._lock_due:
            self.locked, self._lock_due = self.lock_wanted, None
            moved.append("lock" if self.locked else "unlock")
        self._grip_due = _due(self._grip_due, self.close_wanted != self.closed, now)
        if self._grip_due is not None and now >= self._grip_due:
            self.closed, self._grip_due = self.close_wanted, None
            moved.append("close" if self.closed else "open")
        return moved


def _due(due: float | None, wanted: bool, now: float) -> float | None:
    if not wanted:
        return None
    return now + VALVE_TAKES if due is None else due


@dataclass
class Person:
    """Somebody who does what the watch asks for, and acknowledges it until the watch asks no more."""

    task: str = "none"
    pair: str = ""
    acknowledged: bool = False
    takes_over: bool = False  # has switched the robot off by its key and pushes it out of the way
    slowness: float = 1.0
    busy_at: str = ""  # the pair at which the hands are
    _due: float | None = None

    def advance(self, now: float) -> str | None:
        """Let time pass; returns the task that has just been done."""
        if self.task == "none":
            self.acknowledged, self._due, self.busy_at = False, None, ""
        elif not self.acknowledged:
            if self._due is None:
                self._due = now + self.slowness * LASTS[self.task]
                self.busy_at = "" if self.task == "free" else self.pair
            elif now >= self._due:
                self.acknowledged, self._due, self.busy_at = True, None, ""
                return self.task
        return None
