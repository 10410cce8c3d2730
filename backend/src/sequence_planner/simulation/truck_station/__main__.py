"""`python -m sequence_planner.simulation.truck_station world|<node>|all`: a process of the station, or all of them."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import shlex
import signal
import sys
from collections.abc import Mapping
from pathlib import Path

from sequence_planner.ros.transport import Transport
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.truck_station import world_server
from sequence_planner.simulation.truck_station.nodes import NODE_TYPES, live
from sequence_planner.simulation.truck_station.world import World
from sequence_planner.simulation.truck_station.world_server import WorldServer

PORT, MIR_PORT = 8700, 8701


def main() -> None:
    """Run the world, one node of it, or all of them as processes of their own, until a signal ends it."""
    parser = argparse.ArgumentParser(prog="truck_station", description=__doc__)
    parser.add_argument("what", choices=("world", world_server.NAME, *NODE_TYPES, "all"))
    parser.add_argument("--port", type=int, default=PORT, help="of the world, on the loopback")
    parser.add_argument("--mir-port", type=int, default=MIR_PORT, help="of the AGV, on the loopback")
    parser.add_argument("--messages", type=Path, help="folder of the message definitions; needed for a node")
    parser.add_argument("--speed", type=float, default=1.0, help="of the world")
    parser.add_argument("--seed", type=int, default=0, help="of the world")
    given = parser.parse_args()
    if given.what not in ("world", world_server.NAME) and given.messages is None:
        parser.error("a node that speaks ROS 2 needs --messages")
    with contextlib.suppress(asyncio.CancelledError):
        asyncio.run(_run(given))


async def _run(given: argparse.Namespace) -> None:
    loop, task = asyncio.get_running_loop(), asyncio.current_task()
    assert task is not None
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, task.cancel)
    if given.what == "world":
        await WorldServer(World(given.seed), given.speed).serve(given.port)
        return
    if given.what == world_server.NAME:
        await world_server.serve(given.port, given.mir_port)
        return
    if given.what == "all":
        await _run_all(given)
        return
    registry = MessageRegistry.from_folder(given.messages)

    def connect(name: str) -> Transport:
        return open_transport("auto", registry, name, loop)

    await live(given.what, given.port, given.mir_port, registry, connect)


async def _run_all(given: argparse.Namespace) -> None:
    """The world and its nodes, until this one ends, or the world does. A node may end as a computer may: it is said."""
    common = ("--port", str(given.port), "--mir-port", str(given.mir_port), "--messages", str(given.messages))
    world = ("--speed", str(given.speed), "--seed", str(given.seed))
    module = ("-m", "sequence_planner.simulation.truck_station")
    processes = {}
    for what in ("world", world_server.NAME, *NODE_TYPES):
        arguments = (*module, what, *common, *(world if what == "world" else ()))
        processes[what] = await asyncio.create_subprocess_exec(sys.executable, *arguments)
    again = {what: shlex.join((sys.executable, *module, what, *common)) for what in processes}
    await outlived(processes, again)


async def outlived(processes: Mapping[str, asyncio.subprocess.Process], again: Mapping[str, str]) -> None:
    """Wait for the end of the world, and end all others then. How a node that ends before is started again is said."""

    async def watch(what: str) -> None:
        await processes[what].wait()
        sys.stderr.write(f"{what} has ended, the others go on; to start it again: {again[what]}\n")
        sys.stderr.flush()

    watching = [asyncio.create_task(watch(what)) for what in processes if what != "world"]
    try:
        await processes["world"].wait()
    finally:
        for each in watching:
            each.cancel()
        for process in processes.values():
            with contextlib.suppress(ProcessLookupError):
                process.terminate()
        await asyncio.gather(*(process.wait() for process in processes.values()))


if __name__ == "__main__":
    main()
