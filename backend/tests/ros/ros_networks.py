"""A network for a test to play on: transports of one kind that meet each other and nobody else."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from functools import cache

from sequence_planner.ros.transport import Transport
from sequence_planner.ros.transports.choice import TransportChoice, open_transport
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.ros.types.messages import MessageRegistry
from support.network import DOMAIN


@cache
def standard() -> MessageRegistry:
    return MessageRegistry.from_folder(None)


class Network:
    """Transports of one kind; all methods belong on the event loop's thread."""

    def __init__(self, kind: str, loop: asyncio.AbstractEventLoop) -> None:
        self._kind = kind
        self._loop = loop
        self._memory = MemoryNetwork()
        self._joined: list[Transport] = []

    def join(self, node_name: str, registry: MessageRegistry | None = None) -> Transport:
        registry = registry or standard()
        transport: Transport
        if self._kind == "memory":
            transport = self._memory.join(registry, node_name, self._loop)
        else:
            choice: TransportChoice = "rclpy" if self._kind == "rclpy" else "cyclonedds"
            transport = open_transport(choice, registry, node_name, self._loop, DOMAIN)
        self._joined.append(transport)
        return transport

    def close(self) -> None:
        for transport in self._joined:
            transport.close()


def play(kind: str, scenario: Callable[[Network], Awaitable[None]]) -> None:
    """Run `scenario` on a fresh network and event loop."""

    async def run() -> None:
        network = Network(kind, asyncio.get_running_loop())
        try:
            await scenario(network)
        finally:
            network.close()

    asyncio.run(run())


async def settle() -> None:
    """Wait long enough for something that should not arrive to have arrived."""
    await asyncio.sleep(0.3)
