"""Servers of the simulated truck station: the world over TCP, and the AGV's REST interface (MiR)."""

from __future__ import annotations

import asyncio
import json
import time
from dataclasses import dataclass, field
from http import HTTPStatus

from sequence_planner.simulation.truck_station.drivers import DeviceLink, Signals, WorldEndedError, WorldLink
from sequence_planner.simulation.truck_station.poses import PAIRS
from sequence_planner.simulation.truck_station.rest import GOAL, STATUS
from sequence_planner.simulation.truck_station.signals import COMPUTERS, read, set_signals
from sequence_planner.simulation.truck_station.world import World

# The AGV, a computer of its own behind the bridge `mircom`: its REST interface (see `rest`) as a small HTTP server.

NAME = "mir"
GOALS = ("kitting", "station")
LONGEST_BODY = 1 << 12


async def serve(port: int, mir_port: int) -> None:
    """Be the AGV, whose interface is at `mir_port`, until cancelled or until the world at `port` ends.

    Raises OSError when there is no world, or the port is taken.
    """
    link = await WorldLink.to(NAME, port)
    agv = MirServer(link)
    server = await asyncio.start_server(agv.connected, "127.0.0.1", mir_port)
    try:
        async with server:
            await agv.ended.wait()
    finally:
        link.close()


class MirServer:
    """Answers requests about the AGV behind a link, one a connection. `ended` is set once the world has."""

    def __init__(self, link: DeviceLink) -> None:
        self._link = link
        self._turn = asyncio.Lock()
        self.ended = asyncio.Event()

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer one request."""
        try:
            head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
            lengths = [line.partition(":")[2] for line in head if line.lower().startswith("content-length:")]
            length = int(lengths[0]) if lengths else 0
            body = await reader.readexactly(length) if 0 < length <= LONGEST_BODY else b""
            method, path, _ = head[0].split()
            answered = await self.answer(method, path, body)
            if answered is None:
                return
            status, answer = answered
            content = json.dumps(answer).encode()
            writer.write(
                f"HTTP/1.1 {status.value} {status.phrase}\r\nContent-Type: application/json\r\n"
                f"Content-Length: {len(content)}\r\nConnection: close\r\n\r\n".encode()
                + content
            )
            await writer.drain()
        except (asyncio.IncompleteReadError, asyncio.LimitOverrunError, ConnectionError, ValueError, TypeError):
            return  # what came is no HTTP, or whoever sent it is gone
        finally:
            writer.close()

    async def answer(self, method: str, path: str, body: bytes) -> tuple[HTTPStatus, dict[str, object]] | None:
        """The status and the document for a request; None where the AGV says nothing."""
        if (method, path) == ("GET", STATUS):
            if (read := await self._exchanged({})) is None:
                return None
            position = read["position"]
            return HTTPStatus.OK, {"position": position, "state_text": "Executing" if position == "moving" else "Ready"}
        if (method, path) != ("PUT", GOAL):
            return HTTPStatus.NOT_FOUND, {"error": f"there are GET {STATUS} and PUT {GOAL}"}
        try:
            goal = json.loads(body)["goal"]
        except (ValueError, KeyError, TypeError):
            goal = None
        if goal not in GOALS:
            return HTTPStatus.BAD_REQUEST, {"error": f"`goal` is one of {', '.join(GOALS)}"}
        return None if await self._exchanged({"goal": goal}) is None else (HTTPStatus.OK, {"goal": goal})

    async def _exchanged(self, put: Signals) -> dict[str, object] | None:
        """Return what the AGV's signals are after these are set; None when it is switched off, or the world has
        ended.
        """
        async with self._turn:  # the link knows one question at a time
            try:
                answer = await self._link.exchange(put)
            except WorldEndedError:
                self.ended.set()
                return None
        if answer.fault.get("kind") in ("silent", "offline"):
            return None
        wrong: dict[str, object] = answer.fault.get("fields", {})
        return answer.read | wrong


# The world in a process of its own, on a TCP port of the loopback: one JSON document a line, one answer to each.
#
# A node sends `{"node": "ur10", "put": {..}}` and gets `{"read": {..}, "fault": {..}}`. Whoever judges or disturbs
# sends `{"verdict": true}`, `{"fault": {"node": .., "kind": .., "seconds": .., "fields": {..}}}` or `{"world": {..}}`,
# which sets what a person at the station could: `takes_over` (the key of the robot), `slowness`, `jammed` (names of
# devices), `tripped` (the robot drops what it was told), `bolts` (what a hand makes of pairs).

STEP = 0.01  # seconds of the world between two looks at it
FAULTS = ("silent", "stuck", "wrong", "offline")
LONGEST_LINE = 1 << 16


@dataclass
class NodeFault:
    """A fault of a node: `fields` are the wrong values of its message. Until a time of the clock."""

    kind: str
    until: float
    fields: dict[str, object] = field(default_factory=dict)


class WorldServer:
    """Keeps a world going, `speed` times as fast as the clock."""

    def __init__(self, world: World, speed: float = 1.0) -> None:
        self.world = world
        self._speed = speed
        self._faults: dict[str, NodeFault] = {}
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
        set_signals(self.world, node, signals)
        told = {} if fault is None else {"kind": fault.kind, "fields": fault.fields}
        return {"read": read(self.world, node), "fault": told}

    def _disturbed(self, node: str, kind: str, seconds: float, fields: dict[str, object]) -> dict[str, object]:
        if node not in COMPUTERS or kind not in FAULTS:
            return {"error": f"there are the nodes {', '.join(COMPUTERS)} and the faults {', '.join(FAULTS)}"}
        self._faults[node] = NodeFault(kind, time.monotonic() + seconds, fields)
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
