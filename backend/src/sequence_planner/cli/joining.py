"""Looking at the ROS network from the command line, as a node of its own that publishes nothing."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable
from typing import Annotated, TypeVar

import typer

from sequence_planner.logs import configure_logs
from sequence_planner.ros.choice import TransportChoice, open_transport
from sequence_planner.ros.environment import DOMAIN_ID
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Transport

T = TypeVar("T")

Domain = Annotated[
    int | None, typer.Option(min=0, max=232, help=f"The ROS domain; without it that of {DOMAIN_ID}, or 0.")
]
Seconds = Annotated[float, typer.Option(min=0.1, max=60, help="How long to look around.")]


def look(
    what: Callable[[Transport], Awaitable[T]], registry: MessageRegistry, choice: TransportChoice, domain: int | None
) -> T:
    """Join the network, and return what `what` does. Raises `TransportError`."""
    configure_logs()

    async def joined() -> T:
        node = f"sequence_planner_look_{os.getpid()}"
        transport = open_transport(choice, registry, node, asyncio.get_running_loop(), domain)
        try:
            return await what(transport)
        finally:
            transport.close()

    return asyncio.run(joined())
