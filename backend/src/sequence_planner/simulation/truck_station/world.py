"""Physical world of the truck station: robot arm, engine line, AGV, nutrunner, end-effector, operator."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass, field
from typing import Literal

from sequence_planner.simulation.truck_station.poses import (
    AT_ENGINE,
    FRAME_IN_KIT,
    FRAME_ON_ENGINE,
    HOME,
    OIL_FILTER,
    PAIRS,
    POSES,
    TOOL_PLACES,
    Joints,
    named,
)

# The robot arm: joints that move to a goal at a limited speed.

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
        """True if it is switched off by its key: it drops what it was about, and takes no commands."""
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


# The engine on the line, and the AGV that brings its kit. Times in seconds.

LEAVES_IN, COMES_IN, READS_IN, DRIVES_IN = 2.5, 3.0, 0.7, 6.0


@dataclass
class TruckEngine:
    """One engine: what has truly been done to it."""

    number: int = 1
    frame: bool = False
    bolts: dict[str, str] = field(default_factory=lambda: dict.fromkeys(PAIRS, "empty"))
    oil_filter: bool = False

    @property
    def faults(self) -> list[str]:
        """The things that are not as they should be on an engine that leaves."""
        found = [] if self.frame else ["no ladder frame"]
        found += [f"{pair} {state}" for pair, state in self.bolts.items() if state != "tightened"]
        return found if self.oil_filter else [*found, "oil filter loose"]


@dataclass
class Line:
    """The line: an engine is in place until it is released; the next one comes when release is withdrawn."""

    engine: TruckEngine | None = field(default_factory=TruckEngine)
    came: int = 1
    release: bool = False
    read: bool = False
    tag: str = ""
    _since: float = 0.0
    _reading: float | None = None

    def advance(self, now: float) -> TruckEngine | None:
        """Let time pass; an engine that has just left is returned."""
        if self.engine is None:
            if not self.release and now - self._since >= COMES_IN:
                self.came += 1
                self.engine = TruckEngine(self.came)
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


# The nutrunner with its lift, the end-effector, and the person who works with them. Times in seconds.

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
class WatchWearer:
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


# What happened in the world, told by nobody but the world.

WRONG = ("collision", "dropped", "wrong", "over-torque", "on air")  # an event with one of these words must never be


@dataclass
class Verdict:
    """Events in their order, each with the seconds of the world at which it was."""

    events: list[tuple[float, str]] = field(default_factory=list)

    def add_event(self, now: float, event: str) -> None:
        """Take down an event."""
        self.events.append((round(now, 3), event))

    @property
    def wrong(self) -> list[str]:
        """The events that must never be."""
        return [event for _, event in self.events if any(word in event for word in WRONG)]

    @property
    def counted(self) -> Counter[str]:
        """The number of times that each event occurred."""
        return Counter(event for _, event in self.events)


# What is true in the station, and what becomes of it when signals are set: also when they are set wrongly.
#
# `advance` lets time pass in small steps. Each device has signals that its computer sets and reads; the rest follows
# from where things are. What must never be is noted in the verdict and does not stop the world.

CONTACT = 0.02  # rad within which of a saved pose the arm touches what is there
LONGEST_ON_AIR, LONGEST_ON_TIGHT = 0.5, 0.3  # seconds


@dataclass
class World:
    """The whole station. Times are seconds since it began."""

    seed: int = 0
    now: float = 0.0
    arm: Arm = field(default_factory=Arm)
    scene: list[str] = field(default_factory=list)
    nutrunner: Nutrunner = field(default_factory=Nutrunner)
    effector: EndEffector = field(default_factory=EndEffector)
    line: Line = field(default_factory=Line)
    agv: Agv = field(default_factory=Agv)
    person: WatchWearer = field(default_factory=WatchWearer)
    verdict: Verdict = field(default_factory=Verdict)
    held: str | None = None  # the tool at the coupling of the robot, locked or not
    away: set[str] = field(default_factory=set)  # tools that are not at their places
    frame_held: bool = False

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)
        self._at: str | None = named(self.arm.joints, CONTACT)
        self._turned = 0.0  # seconds for which the tool has turned on the bolts at which it is
        self._needed = 0.0  # seconds for which it has to

    def advance(self, seconds: float) -> None:
        """Let so much time pass, at most some hundredths of a second."""
        self.now += seconds
        self.arm.off = self.person.takes_over
        if self.arm.off and self._at not in TOOL_PLACES.values():
            self.arm.push(POSES[HOME])
        self.arm.advance(seconds)
        self._meet(named(self.arm.joints, CONTACT))
        self.nutrunner.advance(self.now)
        for moved in self.effector.advance(self.now):
            self._moved(moved)
        self._turn(seconds)
        self._serve(self.person.advance(self.now))
        before = self.agv.position
        self.agv.advance(seconds)
        if before == "station" and self.agv.position != "station" and self._at == FRAME_IN_KIT:
            self._record("collision: the AGV leaves with the robot at its kit")
        if (gone := self.line.advance(self.now)) is not None:
            self._leave(gone)
        if self.person.busy_at and self._at in (self.person.busy_at, FRAME_ON_ENGINE):
            self._once(f"collision: the robot and a hand at {self._at}")

    def _record(self, event: str) -> None:
        self.verdict.add_event(self.now, event)

    def _once(self, event: str) -> None:
        if not self.verdict.events or self.verdict.events[-1][1] != event:
            self._record(event)

    def _meet(self, at: str | None) -> None:
        """The arm touches what is at `at`, or lets go of what was where it was."""
        if at == self._at:
            return
        left, self._at = self._at, at
        if left in TOOL_PLACES.values():
            self._leave_place()
        if at is None:
            return
        if at in TOOL_PLACES.values():
            self._reach_place(at)
        elif at in PAIRS:
            self._reach_bolts(at)
        elif at == FRAME_ON_ENGINE and self.frame_held and self.line.engine and self.line.engine.frame:
            self._record("collision: two ladder frames on one engine")
        elif at == OIL_FILTER and self.line.engine is not None:
            if self.held == "OFTOOL" and self.line.engine.frame:
                self.line.engine.oil_filter = True
                self._record("oil filter tightened")
            else:
                self._record("collision: no filter tool at the oil filter")

    def _leave_place(self) -> None:
        tool = self.held
        if tool is None:
            return
        if not self.effector.locked:
            self.held = None
        elif (tool == "LFTOOL" and self.effector.closed) or (tool == "ATLASTOOL" and self.nutrunner.lift == "hold"):
            self._record(f"collision: {tool} is pulled while its place holds it")
        else:
            self.away.add(tool)

    def _reach_place(self, place: str) -> None:
        tool = next(name for name, where in TOOL_PLACES.items() if where == place)
        if self.held is not None and self.held != tool:
            self._record(f"collision: {self.held} is driven into the place of {tool}")
        elif self.held is None and self.effector.locked:
            self._record(f"collision: a locked coupling is driven onto {tool}")
        elif self.held == "LFTOOL" and (self.effector.closed or self.frame_held):
            self._record("collision: a closed gripper is driven into the dock")
        elif self.held is None and tool not in self.away:
            self.held = tool
        else:
            self.away.discard(tool)

    def _reach_bolts(self, pair: str) -> None:
        self._turned, self._needed = 0.0, self._random.uniform(1.5, 2.5)
        engine = self.line.engine
        if self.held != "ATLASTOOL":
            self._record(f"collision: no nutrunner at {pair}")
        elif engine is not None and engine.bolts[pair] == "placed" and not self.nutrunner.turning:
            self._record(f"collision: a standing tool is driven onto the bolts of {pair}")

    def _moved(self, moved: str) -> None:
        """A valve of the end-effector has moved."""
        tool = self.held
        if moved == "unlock" and tool is not None:
            at_place = self._at == TOOL_PLACES[tool]
            is_held = {"LFTOOL": self.effector.closed, "ATLASTOOL": self.nutrunner.lift == "hold"}.get(tool, True)
            if not (at_place and is_held):
                self._record(f"tool dropped: {tool}")
            if not at_place:
                self.held = None
        elif moved == "close" and tool == "LFTOOL" and self._at == FRAME_IN_KIT:
            if self.agv.position == "station" and self.agv.frame:
                self.agv.frame, self.frame_held = False, True
                self._record("ladder frame gripped")
        elif moved == "open" and self.frame_held:
            self.frame_held = False
            engine = self.line.engine
            if self._at == FRAME_ON_ENGINE and engine is not None and not engine.frame:
                engine.frame = True
                self._record("ladder frame mounted")
            else:
                self._record("ladder frame dropped")

    def _turn(self, seconds: float) -> None:
        """The nutrunner turns on what is below it."""
        engine, tool = self.line.engine, self.nutrunner
        if self._at not in PAIRS or self.held != "ATLASTOOL" or engine is None or not tool.turning:
            return
        pair = self._at
        self._turned += seconds
        if engine.bolts[pair] == "placed" and self._turned >= self._needed:
            engine.bolts[pair], tool.torque, tool.turning, self._turned = "tightened", True, False, 0.0
            self._record(f"bolt tightened: {pair}")
        elif engine.bolts[pair] == "tightened" and self._turned > LONGEST_ON_TIGHT:
            self._once(f"over-torque: {pair}")
        elif engine.bolts[pair] == "empty" and self._turned > LONGEST_ON_AIR:
            self._once(f"the tool runs on air: {pair}")

    def _serve(self, done: str | None) -> None:
        """The person has done what was asked, as far as it can be done."""
        engine, pair = self.line.engine, self.person.pair
        if done is None:
            return
        state = engine.bolts.get(pair) if engine is not None else None
        if done == "place":
            if engine is None or state != "empty" or not engine.frame or self.agv.position != "station":
                self._record(f"wrong task: no bolts can be placed at {pair}")
                return
            engine.bolts[pair] = "placed"
            self.agv.pairs -= 1
            self._record(f"bolts placed: {pair}")
        elif done == "free":
            self._free()
        elif engine is None or state == "empty" or self.nutrunner.lift != "float" or self.held == "ATLASTOOL":
            self._record(f"wrong task: nothing can be tightened by hand at {pair}")
        elif state == "tightened":
            self._record(f"bolt found tight: {pair} by hand")  # the tool stops at once
        else:
            engine.bolts[pair] = "tightened"
            self._record(f"bolt tightened: {pair} by hand")

    def _free(self) -> None:
        """The nutrunner comes off the robot by hand, and is hung back."""
        if not self.arm.off or self.held != "ATLASTOOL" or self.nutrunner.turning or self.nutrunner.lift != "float":
            self._record("wrong task: no nutrunner can be taken off the robot")
            return
        self.effector.locked = self.effector.lock_wanted = False
        self.held = None
        self.away.discard("ATLASTOOL")
        self.arm.push(POSES[HOME])
        self._record("nutrunner taken off by hand")

    def _leave(self, engine: TruckEngine) -> None:
        if self._at in AT_ENGINE:
            self._record("collision: the engine leaves with the robot at it")
        faults = engine.faults
        self._record("engine done" if not faults else f"engine wrong: {', '.join(faults)}")
        if self.person.busy_at:
            self._record("collision: the engine leaves with a person at it")
