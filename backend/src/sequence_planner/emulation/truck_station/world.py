"""What is true in the station, and what becomes of it when signals are set: also when they are set wrongly.

`advance` lets time pass in small steps. Each device has signals that its computer sets and reads; the rest follows from
where things are. What must never be is noted in the verdict and does not stop the world.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field

from sequence_planner.emulation.truck_station.arm import Arm
from sequence_planner.emulation.truck_station.engine import Agv, Engine, Line
from sequence_planner.emulation.truck_station.poses import (
    AT_ENGINE,
    FRAME_IN_KIT,
    FRAME_ON_ENGINE,
    HOME,
    OIL_FILTER,
    PAIRS,
    POSES,
    TOOL_PLACES,
    named,
)
from sequence_planner.emulation.truck_station.tools import EndEffector, Nutrunner, Person
from sequence_planner.emulation.truck_station.verdict import Verdict

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
    person: Person = field(default_factory=Person)
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
            self._note("collision: the AGV leaves with the robot at its kit")
        if (gone := self.line.advance(self.now)) is not None:
            self._leave(gone)
        if self.person.busy_at and self._at in (self.person.busy_at, FRAME_ON_ENGINE):
            self._once(f"collision: the robot and a hand at {self._at}")

    def _note(self, event: str) -> None:
        self.verdict.note(self.now, event)

    def _once(self, event: str) -> None:
        if not self.verdict.events or self.verdict.events[-1][1] != event:
            self._note(event)

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
            self._note("collision: two ladder frames on one engine")
        elif at == OIL_FILTER and self.line.engine is not None:
            if self.held == "OFTOOL" and self.line.engine.frame:
                self.line.engine.oil_filter = True
                self._note("oil filter tightened")
            else:
                self._note("collision: no filter tool at the oil filter")

    def _leave_place(self) -> None:
        tool = self.held
        if tool is None:
            return
        if not self.effector.locked:
            self.held = None
        elif (tool == "LFTOOL" and self.effector.closed) or (tool == "ATLASTOOL" and self.nutrunner.lift == "hold"):
            self._note(f"collision: {tool} is pulled while its place holds it")
        else:
            self.away.add(tool)

    def _reach_place(self, place: str) -> None:
        tool = next(name for name, where in TOOL_PLACES.items() if where == place)
        if self.held is not None and self.held != tool:
            self._note(f"collision: {self.held} is driven into the place of {tool}")
        elif self.held is None and self.effector.locked:
            self._note(f"collision: a locked coupling is driven onto {tool}")
        elif self.held == "LFTOOL" and (self.effector.closed or self.frame_held):
            self._note("collision: a closed gripper is driven into the dock")
        elif self.held is None and tool not in self.away:
            self.held = tool
        else:
            self.away.discard(tool)

    def _reach_bolts(self, pair: str) -> None:
        self._turned, self._needed = 0.0, self._random.uniform(1.5, 2.5)
        engine = self.line.engine
        if self.held != "ATLASTOOL":
            self._note(f"collision: no nutrunner at {pair}")
        elif engine is not None and engine.bolts[pair] == "placed" and not self.nutrunner.turning:
            self._note(f"collision: a standing tool is driven onto the bolts of {pair}")

    def _moved(self, moved: str) -> None:
        """A valve of the end-effector has moved."""
        tool = self.held
        if moved == "unlock" and tool is not None:
            at_place = self._at == TOOL_PLACES[tool]
            is_held = {"LFTOOL": self.effector.closed, "ATLASTOOL": self.nutrunner.lift == "hold"}.get(tool, True)
            if not (at_place and is_held):
                self._note(f"tool dropped: {tool}")
            if not at_place:
                self.held = None
        elif moved == "close" and tool == "LFTOOL" and self._at == FRAME_IN_KIT:
            if self.agv.position == "station" and self.agv.frame:
                self.agv.frame, self.frame_held = False, True
                self._note("ladder frame gripped")
        elif moved == "open" and self.frame_held:
            self.frame_held = False
            engine = self.line.engine
            if self._at == FRAME_ON_ENGINE and engine is not None and not engine.frame:
                engine.frame = True
                self._note("ladder frame mounted")
            else:
                self._note("ladder frame dropped")

    def _turn(self, seconds: float) -> None:
        """The nutrunner turns on what is below it."""
        engine, tool = self.line.engine, self.nutrunner
        if self._at not in PAIRS or self.held != "ATLASTOOL" or engine is None or not tool.turning:
            return
        pair = self._at
        self._turned += seconds
        if engine.bolts[pair] == "placed" and self._turned >= self._needed:
            engine.bolts[pair], tool.torque, tool.turning, self._turned = "tightened", True, False, 0.0
            self._note(f"bolt tightened: {pair}")
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
                self._note(f"wrong task: no bolts can be placed at {pair}")
                return
            engine.bolts[pair] = "placed"
            self.agv.pairs -= 1
            self._note(f"bolts placed: {pair}")
        elif done == "free":
            self._free()
        elif engine is None or state == "empty" or self.nutrunner.lift != "float" or self.held == "ATLASTOOL":
            self._note(f"wrong task: nothing can be tightened by hand at {pair}")
        elif state == "tightened":
            self._note(f"bolt found tight: {pair} by hand")  # the tool stops at once
        else:
            engine.bolts[pair] = "tightened"
            self._note(f"bolt tightened: {pair} by hand")

    def _free(self) -> None:
        """The nutrunner comes off the robot by hand, and is hung back."""
        if not self.arm.off or self.held != "ATLASTOOL" or self.nutrunner.turning or self.nutrunner.lift != "float":
            self._note("wrong task: no nutrunner can be taken off the robot")
            return
        self.effector.locked = self.effector.lock_wanted = False
        self.held = None
        self.away.discard("ATLASTOOL")
        self.arm.push(POSES[HOME])
        self._note("nutrunner taken off by hand")

    def _leave(self, engine: Engine) -> None:
        if self._at in AT_ENGINE:
            self._note("collision: the engine leaves with the robot at it")
        faults = engine.faults
        self._note("engine done" if not faults else f"engine wrong: {', '.join(faults)}")
        if self.person.busy_at:
            self._note("collision: the engine leaves with a person at it")
