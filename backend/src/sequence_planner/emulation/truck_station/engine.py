"""The engine on the line, and the AGV that brings its kit. Times in seconds."""

from __future__ import annotations

from dataclasses import dataclass, field

from sequence_planner.emulation.truck_station.poses import PAIRS

LEAVES_IN, COMES_IN, READS_IN, DRIVES_IN = 2.5, 3.0, 0.7, 6.0


@dataclass
class Engine:
    """One engine: what has truly been done to it."""

    number: int = 1
    frame: bool = False
    bolts: dict[str, str] = field(default_factory=lambda: dict.fromkeys(PAIRS, "empty"))
    oil_filter: bool = False

    @property
    def faults(self) -> list[str]:
        """What is not as it should be on an engine that leaves."""
        found = [] if self.frame else ["no ladder frame"]
        found += [f"{pair} {state}" for pair, state in self.bolts.items() if state != "tightened"]
        return found if self.oil_filter else [*found, "oil filter loose"]


@dataclass
class Line:
    """The line: an engine is in place until it is released; the next one comes when release is withdrawn."""

    engine: Engine | None = field(default_factory=Engine)
    came: int = 1
    release: bool = False
    read: bool = False
    tag: str = ""
    _since: float = 0.0
    _reading: float | None = None

    def advance(self, now: float) -> Engine | None:
        """Let time pass; an engine that has just left is returned."""
        if self.engine is None:
            if not self.release and now - self._since >= COMES_IN:
                self.came += 1
                self.engine = Engine(self.came)
            return None
        if not self.release:
            self._since = now
        elif now - self._since >= LEAVES_IN:
            gone, self.engine, self.tag, self._reading, self._since = self.engine, None, "", None, now
            return gone
        if not self.read or self.tag:
            self._reading = None
        elif self._reading is None:
            self._reading = now
        elif now - self._reading >= READS_IN:
            self.tag = f"D13-{self.engine.number:05d}"
        return None


@dataclass
class Agv:
    """An AGV between the kitting area, where it gets a full kit, and the station. `position` is `moving` on the way."""

    goal: str = "kitting"
    position: str = "kitting"
    frame: bool = True
    pairs: int = len(PAIRS)  # of bolts in the kit
    jammed: bool = False
    _left: float = 0.0  # seconds still to drive

    def advance(self, seconds: float) -> None:
        """Let time pass."""
        if self.position == self.goal or self.jammed:
            return
        if self.position != "moving":
            self.position, self._left = "moving", DRIVES_IN
        self._left -= seconds
        if self._left <= 0:
            self.position = self.goal
            if self.position == "kitting":
                self.frame, self.pairs = True, len(PAIRS)
