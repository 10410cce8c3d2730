"""`python -m sequence_planner.emulation.truck_station world|<node>`: one process of the station."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import signal
from pathlib import Path

from sequence_planner.emulation.truck_station.node import NODE_TYPES, live
from sequence_planner.emulation.truck_station.server import WorldServer
from sequence_planner.emulation.truck_station.world import World
from sequence_planner.ros.choice import open_transport
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import Transport

PORT, MIR_PORT = 8700, 8701


def main() -> None:
    """Run the world, or one node of it, until a signal ends it."""
    parser = argparse.ArgumentParser(prog="truck_station", description=__doc__)
    parser.add_argument("what", choices=("world", *NODE_TYPES))
    parser.add_argument("--port", type=int, default=PORT, help="of the world, on the loopback")
    parser.add_argument("--mir-port", type=int, default=MIR_PORT, help="of the AGV's own interface")
    parser.add_argument("--messages", type=Path, help="folder of the message definitions; needed for a node")
    parser.add_argument("--speed", type=float, default=1.0, help="of the world")
    parser.add_argument("--seed", type=int, default=0, help="of the world")
    given = parser.parse_args()
    if given.what != "world" and given.messages is None:
        parser.error("a node needs --messages")
    with contextlib.suppress(asyncio.CancelledError):
        asyncio.run(_run(given))


async def _run(given: argparse.Namespace) -> None:
    loop, task = asyncio.get_running_loop(), asyncio.current_task()
    assert task is not None
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, task.cancel)
    if given.what == "world":
        await WorldServer(World(given.seed), given.speed).serve(given.port, given.mir_port)
        return
    registry = MessageRegistry.from_folder(given.messages)

    def connect(name: str) -> Transport:
        return open_transport("auto", registry, name, loop)

    await live(given.what, given.port, given.mir_port, registry, connect)


if __name__ == "__main__":
    main()
