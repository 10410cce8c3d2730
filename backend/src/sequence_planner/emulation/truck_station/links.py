"""How a node reaches its device: the world's port, and for the bridge to the AGV the AGV's own REST interface."""

from __future__ import annotations

import asyncio
import json
import time
from dataclasses import dataclass
from typing import Any, Protocol

from sequence_planner.emulation.truck_station.drivers import Signals
from sequence_planner.emulation.truck_station.rest import GOAL, STATUS, request

PATIENCE = 15.0  # seconds in which the world may start


class WorldEndedError(Exception):
    """The world is gone, and with it the device."""


@dataclass(frozen=True)
class Answer:
    """What the device's signals are, and what is the matter with the node."""

    read: dict[str, object]
    fault: dict[str, Any]


class Link(Protocol):
    """A way to a device."""

    async def exchange(self, put: Signals) -> Answer:
        """Set signals, and read those of the device. Raises `WorldEndedError` when it is gone."""

    def close(self) -> None:
        """Leave it."""


class WorldLink:
    """A node's connection to the world."""

    def __init__(self, node: str, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._node = node
        self._reader = reader
        self._writer = writer

    @classmethod
    async def to(cls, node: str, port: int) -> WorldLink:
        """Connect, once there is a world. Raises OSError when there is none after `PATIENCE`."""
        until = time.monotonic() + PATIENCE
        while True:
            try:
                return cls(node, *await asyncio.open_connection("127.0.0.1", port))
            except OSError:
                if time.monotonic() > until:
                    raise
                await asyncio.sleep(0.1)

    async def exchange(self, put: Signals) -> Answer:
        """See `Link.exchange`."""
        self._writer.write(json.dumps({"node": self._node, "put": put}).encode() + b"\n")
        try:
            line = await self._reader.readline()
        except ConnectionError as error:
            raise WorldEndedError from error
        if not line:
            raise WorldEndedError
        answer = json.loads(line)
        return Answer(answer["read"], answer["fault"])

    def close(self) -> None:
        """See `Link.close`."""
        self._writer.close()


class RestLink:
    """The bridge's way: the AGV over HTTP at `port`. The world is asked only what is the matter with the bridge."""

    def __init__(self, world: WorldLink, port: int) -> None:
        self._world = world
        self._port = port

    async def exchange(self, put: Signals) -> Answer:
        """See `Link.exchange`."""
        answer = await self._world.exchange({})
        if answer.fault.get("kind") == "stuck":
            return answer
        try:
            if (goal := put.get("goal")) is not None:
                await request(self._port, "PUT", GOAL, {"goal": goal})
            status = await request(self._port, "GET", STATUS)
            position = status["position"]
        except (OSError, ValueError, KeyError):
            return Answer({}, {"kind": "silent"})  # a bridge that knows nothing says nothing
        return Answer({"position": position}, answer.fault)

    def close(self) -> None:
        """See `Link.close`."""
        self._world.close()
