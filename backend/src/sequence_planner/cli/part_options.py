"""The things that the commands that run a station's parts have in common. What keeps one from running is said on
standard error.

The exit code is 2 then.
"""

from __future__ import annotations

import asyncio
import contextlib
import signal
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sequence_planner.cli.options import UNUSABLE, refuse
from sequence_planner.core.logging import configure_logs
from sequence_planner.core.storage_error import StorageError
from sequence_planner.process.parent_watch import end_with_launcher, leave_last_words
from sequence_planner.process.unix_socket import SocketTakenError
from sequence_planner.ros.transport import Transport, TransportError
from sequence_planner.ros.transports.choice import TransportChoice, open_transport
from sequence_planner.ros.transports.routing import ROSBRIDGE, open_routed

if TYPE_CHECKING:
    from sequence_planner.station import ReadyStation

TransportOption = Annotated[
    TransportChoice, typer.Option(help="How to speak ROS 2; auto takes rclpy where it can be imported.")
]
RosbridgeOption = Annotated[
    str | None,
    typer.Option(
        envvar=ROSBRIDGE,
        help="Address of the rosbridge server for topics of ROS 1, such as ws://127.0.0.1:9090.",
        show_envvar=True,
    ),
]
Launched = Annotated[
    bool, typer.Option("--launched", hidden=True, help="End when standard input does; `run` sets this.")
]
Socket = Annotated[Path, typer.Option(help="The local socket between controller and server.")]


def begin(launched: bool, folder: Path | None = None) -> None:
    """Set up a process of the station; `folder` is one that the launcher has made for it."""
    configure_logs()
    if launched:
        end_with_launcher(folder)


def prepare(folder: Path, code: int = UNUSABLE) -> ReadyStation:
    """The station in `folder`, or the end of this process with `code`."""
    from sequence_planner.model.source import ModelError  # noqa: PLC0415
    from sequence_planner.station import prepare_station  # noqa: PLC0415

    try:
        return prepare_station(folder)
    except ModelError as error:
        refuse(str(error), code)


@dataclass(frozen=True)
class Network:
    """The way in which a station's processes join its network."""

    station: ReadyStation
    choice: TransportChoice
    rosbridge: str | None

    def join(self, node: str, loop: asyncio.AbstractEventLoop) -> Transport:
        """Join as the node of this name; see `open_transport` and `open_routed`."""
        registry = self.station.registry
        return open_routed(
            lambda: open_transport(self.choice, registry, node, loop),
            self.station.ros_1,
            self.rosbridge,
            registry,
            node,
            loop,
        )


def until_interrupted(life: Callable[[Callable[[str], Transport]], Awaitable[None]], network: Network | None) -> None:
    """Run a coroutine that connects to the network, until SIGTERM or SIGINT; trouble ends with exit code 2."""

    def join(node: str, loop: asyncio.AbstractEventLoop) -> Transport:
        assert network is not None  # what has no network does not join it
        return network.join(node, loop)

    async def live() -> None:
        loop = asyncio.get_running_loop()
        running = asyncio.ensure_future(life(lambda node: join(node, loop)))
        for number in (signal.SIGTERM, signal.SIGINT):
            loop.add_signal_handler(number, running.cancel)
        with contextlib.suppress(asyncio.CancelledError):
            await running

    try:
        asyncio.run(live())
    except (TransportError, SocketTakenError, StorageError) as error:
        refuse(str(error))
    except Exception as error:
        leave_last_words(f"{type(error).__name__}: {error}")
        raise
