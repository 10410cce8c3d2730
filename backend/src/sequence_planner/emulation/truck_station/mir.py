"""The AGV, a computer of its own behind the bridge `mircom`: its REST interface (see `rest`) as a small HTTP server."""

from __future__ import annotations

import asyncio
import json
from http import HTTPStatus

from sequence_planner.emulation.truck_station.drivers import Signals
from sequence_planner.emulation.truck_station.links import Link, WorldEndedError, WorldLink
from sequence_planner.emulation.truck_station.rest import GOAL, STATUS

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

    def __init__(self, link: Link) -> None:
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
        """What the AGV's signals are after these are set; None when it is switched off, or the world has ended."""
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
