"""An emulated rosbridge server: its protocol, version 2, on a real socket of the loopback, in a thread of its own.

It knows the topics that its clients and `publish` bring into being, as the ROS 1 behind a real one would, and answers
what it does not understand with a status, as a real one does.
"""

from __future__ import annotations

import asyncio
import json
import re
import threading
import time
from collections.abc import Coroutine
from dataclasses import dataclass, field
from typing import Any, TypeVar

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed

TYPE = re.compile(r"[a-z]\w*/[A-Z]\w*")
PATIENCE = 10.0  # seconds
T = TypeVar("T")


class Refused(Exception):
    """An operation that the server does not carry out; the text goes into its status."""


@dataclass
class Subscription:
    """What a client wants of a topic: at most one message in `throttle` seconds."""

    throttle: float
    next: float = 0.0


@dataclass(eq=False)
class Client:
    """A client, with what it publishes and wants."""

    socket: ServerConnection
    publishes: dict[str, bool] = field(default_factory=dict)  # topic: latched
    wants: dict[str, Subscription] = field(default_factory=dict)


class RosbridgeServer:
    """A server that can go away and come back at the same address. What it was sent is in `operations`."""

    def __init__(self) -> None:
        self.operations: list[dict[str, Any]] = []
        self.port = 0
        self._types: dict[str, str] = {}
        self._latched: dict[str, object] = {}
        self._clients: set[Client] = set()
        self._server: Server | None = None
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="rosbridge", daemon=True)
        self._thread.start()
        self.start()

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self.port}"

    def start(self) -> None:
        """Answer clients."""
        self._do(self._start())

    def stop(self) -> None:
        """Go away, and forget everything as the ROS 1 behind does."""
        self._do(self._stop())

    def freeze(self, seconds: float) -> None:
        """Do nothing for so long, with all connections as they are; comes back at once."""
        self._loop.call_soon_threadsafe(time.sleep, seconds)

    def close(self) -> None:
        """Go away for ever."""
        self.stop()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def publish(self, topic: str, type_name: str, message: object) -> None:
        """Publish as a node of ROS 1 behind the bridge."""
        self._do(self._publish(topic, type_name, message))

    def send(self, frame: str) -> None:
        """Send a frame, whatever is in it, to all clients."""
        self._do(self._send_all(frame))

    def published(self, topic: str) -> list[Any]:
        """The messages that clients have published on a topic."""
        return [o["msg"] for o in self.operations if (o.get("op"), o.get("topic")) == ("publish", topic)]

    def subscribed(self, topic: str) -> int:
        """How many clients want a topic."""
        return sum(topic in client.wants for client in list(self._clients))

    def _do(self, action: Coroutine[Any, Any, T]) -> T:
        return asyncio.run_coroutine_threadsafe(action, self._loop).result(PATIENCE)

    async def _start(self) -> None:
        self._server = await serve(self._attend, "127.0.0.1", self.port)
        self.port = next(iter(self._server.sockets)).getsockname()[1]

    async def _stop(self) -> None:
        if self._server is not None:
            self._server.close()
            await self._server.wait_closed()
            self._server = None
        self._types.clear()
        self._latched.clear()

    async def _attend(self, socket: ServerConnection) -> None:
        client = Client(socket)
        self._clients.add(client)
        try:
            async for frame in socket:
                try:
                    await self._carry_out(client, frame)
                except (Refused, ValueError) as refusal:
                    await socket.send(json.dumps({"op": "status", "level": "error", "msg": str(refusal)}))
        except ConnectionClosed:
            pass
        finally:
            self._clients.discard(client)

    async def _carry_out(self, client: Client, frame: str | bytes) -> None:
        operation = json.loads(frame)
        self.operations.append(operation)
        topic = operation.get("topic")
        match operation:
            case {"op": "advertise", "topic": str(), "type": str(type_name)}:
                self._agree(topic, type_name)
                client.publishes[topic] = operation.get("latch", False)
            case {"op": "unadvertise", "topic": str()}:
                client.publishes.pop(topic, None)
            case {"op": "publish", "topic": str(), "msg": dict(message)}:
                if topic not in client.publishes:
                    raise Refused(f"{topic} is not advertised")
                if client.publishes[topic]:
                    self._latched[topic] = message
                await self._pass_on(topic, message)
            case {"op": "subscribe", "topic": str()}:
                self._agree(topic, operation.get("type", self._types.get(topic, "")))
                client.wants[topic] = Subscription(_whole(operation, "throttle_rate") / 1000)
                _whole(operation, "queue_length")
                if topic in self._latched:
                    await client.socket.send(_frame(topic, self._latched[topic]))
            case {"op": "unsubscribe", "topic": str()}:
                client.wants.pop(topic, None)
            case _:
                raise Refused(f"not an operation: {str(operation)[:100]}")

    def _agree(self, topic: str, type_name: str) -> None:
        if not TYPE.fullmatch(type_name):
            raise Refused(f"{type_name!r} is not a type of ROS 1")
        known = self._types.setdefault(topic, type_name)
        if known != type_name:
            raise Refused(f"{topic} is {known} and not {type_name}")

    async def _publish(self, topic: str, type_name: str, message: object) -> None:
        self._agree(topic, type_name)
        await self._pass_on(topic, message)

    async def _pass_on(self, topic: str, message: object) -> None:
        for client in list(self._clients):
            wanted = client.wants.get(topic)
            if wanted is not None and time.monotonic() >= wanted.next:
                wanted.next = time.monotonic() + wanted.throttle
                await client.socket.send(_frame(topic, message))

    async def _send_all(self, frame: str) -> None:
        for client in list(self._clients):
            await client.socket.send(frame)


def _frame(topic: str, message: object) -> str:
    return json.dumps({"op": "publish", "topic": topic, "msg": message})


def _whole(operation: dict[str, Any], name: str) -> int:
    value = operation.get(name, 0)
    if not isinstance(value, int) or value < 0:
        raise Refused(f"{name} is {value!r}: a whole number is expected")
    return value
