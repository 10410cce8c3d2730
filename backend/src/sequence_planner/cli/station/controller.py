"""`controller` and `look`: run the controller alone, or inspect the ROS network without publishing."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from sequence_planner.cli.options import DatabaseOption, StationFolder, database_url, refuse
from sequence_planner.cli.part_options import (
    Launched,
    Network,
    RosbridgeOption,
    Socket,
    TransportOption,
    begin,
    until_interrupted,
)
from sequence_planner.controller.preparation import DeployedError, UnusableModel
from sequence_planner.controller.service import NotStartedError, Running, control
from sequence_planner.core.logging import configure_logs
from sequence_planner.model.source import ModelError
from sequence_planner.process.parent_watch import DEPLOYED, OVERTAKEN
from sequence_planner.process.task import WorkerError
from sequence_planner.ros.environment import DOMAIN_ID
from sequence_planner.ros.transport import Transport
from sequence_planner.ros.transports.choice import TransportChoice, open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.standby.lease import LeaseLostError
from sequence_planner.station import ReadyStation, prepare_station

# Running the controller.


def controller(
    model: StationFolder,
    socket: Socket,
    transport: TransportOption = "auto",
    rosbridge: RosbridgeOption = None,
    emulated: Annotated[bool, typer.Option("--emulated")] = False,
    start: Annotated[bool, typer.Option("--start")] = False,
    database: DatabaseOption = None,
    hot_standby: Annotated[str | None, typer.Option("--hot-standby")] = None,
    launched: Launched = False,
    again: Annotated[bool, typer.Option("--again", hidden=True, help="One that ran before has ended.")] = False,
) -> None:
    """Run the controller alone; `run` does this."""
    begin(launched, socket.parent)
    station = _usable(model, launched)
    network = None if isinstance(station, UnusableModel) else Network(station, transport, rosbridge)
    url = database_url(model, database)
    try:
        until_interrupted(
            lambda connect: control(Running(station, model, socket, connect, emulated, start, url, hot_standby, again)),
            network,
        )
    except (WorkerError, NotStartedError) as error:
        refuse(str(error))
    except DeployedError:
        raise typer.Exit(DEPLOYED) from None
    except LeaseLostError:
        raise typer.Exit(OVERTAKEN) from None


def _usable(model: Path, launched: bool) -> ReadyStation | UnusableModel:
    """The station in the folder `model`, or why it cannot be used; without a page to repair it that is refused."""
    try:
        return prepare_station(model)
    except ModelError as error:
        if not launched:
            refuse(str(error))
        return UnusableModel(model.resolve().name, tuple(error.findings))


# Looking at the ROS network from the command line, as a node of its own that publishes nothing.

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
