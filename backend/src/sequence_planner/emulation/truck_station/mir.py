"""The AGV's own REST interface, as a small HTTP server beside the world, and the client of it in the bridge.

`GET /api/v2.0.0/status` answers `{"position": .., "state_text": ..}`; `PUT /api/v2.0.0/goal` takes `{"goal": ..}`.
"""

from __future__ import annotations

import asyncio
import json
from http import HTTPStatus

from sequence_planner.emulation.truck_station.signals import put, read
from sequence_planner.emulation.truck_station.world import World

STATUS, GOAL = "/api/v2.0.0/status", "/api/v2.0.0/goal"
GOALS = ("kitting", "station")
LONGEST_BODY = 1 << 12


class MirServer:
    """Answers requests about the AGV of a world, one a connection."""

    def __init__(self, world: World) -> None:
        self._world = world

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer one request."""
        try:
            head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
            lengths = [line.partition(":")[2] for line in head if line.lower().startswith("content-length:")]
            length = int(lengths[0]) if lengths else 0
            body = await reader.readexactly(length) if 0 < length <= LONGEST_BODY else b""
            method, path, _ = head[0].split()
            status, answer = self.answer(method, path, body)
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

    def answer(self, method: str, path: str, body: bytes) -> tuple[HTTPStatus, dict[str, object]]:
        """The status and the document for a request."""
        if (method, path) == ("GET", STATUS):
            position = read(self._world, "mircom")["position"]
            return HTTPStatus.OK, {"position": position, "state_text": "Executing" if position == "moving" else "Ready"}
        if (method, path) != ("PUT", GOAL):
            return HTTPStatus.NOT_FOUND, {"error": f"there are GET {STATUS} and PUT {GOAL}"}
        try:
            goal = json.loads(body)["goal"]
        except (ValueError, KeyError, TypeError):
            goal = None
        if goal not in GOALS:
            return HTTPStatus.BAD_REQUEST, {"error": f"`goal` is one of {', '.join(GOALS)}"}
        put(self._world, "mircom", {"goal": goal})
        return HTTPStatus.OK, {"goal": goal}


async def request(port: int, method: str, path: str, body: dict[str, object] | None = None) -> dict[str, object]:
    """Ask the AGV at `port` of the loopback. Raises OSError when it is not there or does not answer like HTTP."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        content = b"" if body is None else json.dumps(body).encode()
        head = f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: {len(content)}\r\n\r\n"
        writer.write(head.encode() + content)
        answered, _, document = (await reader.read()).partition(b"\r\n\r\n")
        if not answered.startswith(b"HTTP/1.1 200 "):
            raise OSError(f"{method} {path}: {answered.splitlines()[:1]}")
        parsed = json.loads(document)
        if not isinstance(parsed, dict):
            raise OSError(f"{method} {path}: no JSON object")
        return parsed
    finally:
        writer.close()
