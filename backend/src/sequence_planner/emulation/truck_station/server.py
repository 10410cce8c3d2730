"""The world in a process of its own, on a TCP port of the loopback: one JSON document a line, one answer to each.

A node sends `{"node": "ur10", "put": {..}}` and gets `{"read": {..}, "fault": {..}}`. Whoever judges or disturbs sends
`{"verdict": true}`, `{"fault": {"node": .., "kind": .., "seconds": .., "fields": {..}}}` or `{"world": {..}}`, which
sets what a person at the station could: `takes_over` (the key of the robot), `slowness`, `jammed` (names of devices),
`tripped` (the robot drops what it was told), `bolts` (what a hand makes of pairs).
"""

from __future__ import annotations

import asyncio
import json
import time
from dataclasses import dataclass, field

from sequence_planner.emulation.truck_station.poses import PAIRS
from sequence_planner.emulation.truck_station.signals import COMPUTERS, put, read
from sequence_planner.emulation.truck_station.world import World

STEP = 0.01  # seconds of the world between two looks at it
FAULTS = ("silent", "stuck", "wrong", "offline")
LONGEST_LINE = 1 << 16


@dataclass
class Fault:
    """What is the matter with a node: `fields` are the wrong values of its message. Until a time of the clock."""

    kind: str
    until: float
    fields: dict[str, object] = field(default_factory=dict)


class WorldServer:
    """Keeps a world going, `speed` times as fast as the clock."""

    def __init__(self, world: World, speed: float = 1.0) -> None:
        self.world = world
        self._speed = speed
        self._faults: dict[str, Fault] = {}
        self._frozen: dict[str, dict[str, object]] = {}

    async def serve(self, port: int) -> None:
        """Serve until cancelled. Raises OSError when the port is taken."""
        server = await asyncio.start_server(self.connected, "127.0.0.1", port, limit=LONGEST_LINE)
        async with server:
            await self._live()

    async def _live(self) -> None:
        last = time.monotonic()
        while True:
            await asyncio.sleep(STEP / self._speed)
            now = time.monotonic()
            passed, last = (now - last) * self._speed, now
            while passed > 0:  # a process that was held up catches up in small steps
                self.world.advance(min(STEP, passed))
                passed -= STEP

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer the lines of one connection."""
        try:
            while line := await reader.readline():
                writer.write(json.dumps(self.answer(json.loads(line))).encode() + b"\n")
                await writer.drain()
        except (ConnectionError, ValueError):
            return  # whoever spoke is gone, or does not speak this language
        except asyncio.CancelledError:
            return  # the world ends, and with it this task
        finally:
            writer.close()

    def answer(self, question: object) -> dict[str, object]:
        """Answer one document."""
        match question:
            case {"node": str(node), "put": dict(signals)} if node in COMPUTERS:
                return self._exchanged(node, signals)
            case {"fault": {"node": str(node), "kind": str(kind), "seconds": float() | int() as seconds, **more}}:
                fields = more.get("fields")
                return self._disturbed(node, kind, float(seconds), fields if isinstance(fields, dict) else {})
            case {"world": dict(changes)}:
                return self._changed(changes)
            case {"verdict": True}:
                verdict = self.world.verdict
                return {"now": self.world.now, "events": verdict.events, "wrong": verdict.wrong}
        return {"error": "not understood"}

    def _exchanged(self, node: str, signals: dict[str, object]) -> dict[str, object]:
        fault = self._faults.get(node)
        if fault is not None and time.monotonic() >= fault.until:
            del self._faults[node]
            self._frozen.pop(node, None)
            fault = None
        if fault is not None and fault.kind == "stuck":
            return {"read": self._frozen.setdefault(node, read(self.world, node)), "fault": {"kind": "stuck"}}
        put(self.world, node, signals)
        told = {} if fault is None else {"kind": fault.kind, "fields": fault.fields}
        return {"read": read(self.world, node), "fault": told}

    def _disturbed(self, node: str, kind: str, seconds: float, fields: dict[str, object]) -> dict[str, object]:
        if node not in COMPUTERS or kind not in FAULTS:
            return {"error": f"there are the nodes {', '.join(COMPUTERS)} and the faults {', '.join(FAULTS)}"}
        self._faults[node] = Fault(kind, time.monotonic() + seconds, fields)
        return {"done": True}

    def _changed(self, changes: dict[str, object]) -> dict[str, object]:
        world = self.world
        if isinstance(takes_over := changes.get("takes_over"), bool):
            world.person.takes_over = takes_over
        if isinstance(slowness := changes.get("slowness"), (int, float)):
            world.person.slowness = float(slowness)
        if isinstance(jammed := changes.get("jammed"), list):
            world.arm.jammed, world.agv.jammed = "arm" in jammed, "agv" in jammed
            world.nutrunner.jammed, world.effector.jammed = "nutrunner" in jammed, "effector" in jammed
        if changes.get("tripped") is True:
            world.arm.trip()
        if isinstance(bolts := changes.get("bolts"), dict) and world.line.engine is not None:
            world.line.engine.bolts.update({pair: str(bolts[pair]) for pair in PAIRS if pair in bolts})
        return {"done": True}
