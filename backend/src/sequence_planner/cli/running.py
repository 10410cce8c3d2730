"""Running a station's parts. What keeps one from running is said on standard error, with exit code 2."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.analysis.process import SynthesisEndedError
from sequence_planner.cli.emulated import say
from sequence_planner.cli.options import DatabaseOption, StationFolder, database_url, refuse
from sequence_planner.control.unix_socket import SocketTakenError
from sequence_planner.emulation.fault_script import read_script
from sequence_planner.emulation.live import BY_HAND_TOPIC, FAULTS_TOPIC
from sequence_planner.emulation.possible import emulation_findings
from sequence_planner.emulation.process import Emulation, emulate
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.lifeline import end_with_launcher, is_needed
from sequence_planner.logs import configure_logs
from sequence_planner.model.loading import load_station
from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.building import load_messages
from sequence_planner.ros.ament import write_ament_package
from sequence_planner.ros.choice import TransportChoice, open_transport
from sequence_planner.ros.routing import ROSBRIDGE, open_routed
from sequence_planner.ros.transport import Transport, TransportError
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.storage.error import StorageError

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


def emulate_command(
    model: StationFolder,
    transport: TransportOption = "auto",
    rosbridge: RosbridgeOption = None,
    speed: Annotated[float, typer.Option(min=0.1, max=100, help="Go so much faster than real devices.")] = 1.0,
    seed: Annotated[int, typer.Option(help="Draws all that is random.")] = 0,
    jitter: Annotated[float, typer.Option(min=0, max=60, help="Effects and reports come up to so many s late.")] = 0.0,
    resource: Annotated[
        list[str] | None, typer.Option(help="Emulate this resource's devices, and no others; can be repeated.")
    ] = None,
    faults: Annotated[Path | None, typer.Option(help="A file of faults and when they begin.")] = None,
    launched: Launched = False,
) -> None:
    """Run emulated devices for a station, in place of real ones."""
    begin(launched)
    station = prepare(model)
    if findings := emulation_findings(station):
        refuse("\n".join(map(str, findings)))
    emulation = Emulation(station, speed, seed, jitter, frozenset(resource) if resource else None)
    there = Emulation(station).emulated
    for name in resource or ():
        if name not in there:
            refuse(
                f"`{name}` has no devices here{suggestion(name, there)}; there are those of {', '.join(sorted(there))}"
            )
    if faults is not None:
        try:
            emulation = replace(emulation, script=read_script(faults, emulation.reader()))
        except ModelError as error:
            refuse(str(error))
    network = _Network(station, transport, rosbridge)
    _until_interrupted(lambda connect: emulate(emulation, connect), network)


def by_hand(
    change: Annotated[str, typer.Argument(help='Such as "robot.pose := home".')], transport: TransportOption = "auto"
) -> None:
    """Move an emulated device by hand, as somebody might move a real one."""
    say(BY_HAND_TOPIC, change, transport)


def fault(
    fault: Annotated[str, typer.Argument(help='Such as "robot silent for 5 s", or "clear".')],
    transport: TransportOption = "auto",
) -> None:
    """Let an emulated device have a fault, or end faults."""
    say(FAULTS_TOPIC, fault, transport)


def messages(
    model: StationFolder,
    ament: Annotated[Path, typer.Option(help="Folder to write the ROS 2 packages of its messages to.")],
) -> None:
    """Write the station's message definitions as packages that colcon builds, for ROS 2 with rclpy."""
    try:
        station = load_station(model)
        load_messages(station)
    except ModelError as error:
        refuse(str(error))
    try:
        for package in write_ament_package(station.messages, ament):
            typer.echo(package)
    except OSError as error:
        refuse(f"{ament} cannot be written to: {error.strerror}")


def controller(
    model: StationFolder,
    socket: Socket,
    transport: TransportOption = "auto",
    rosbridge: RosbridgeOption = None,
    emulated: Annotated[bool, typer.Option("--emulated")] = False,
    start: Annotated[bool, typer.Option("--start")] = False,
    database: DatabaseOption = None,
    launched: Launched = False,
    spare: Annotated[bool, typer.Option("--spare", hidden=True, help="Wait until the launcher says so.")] = False,
) -> None:
    """Run the controller alone; `run` does this."""
    # Each process imports what it runs: the controller no web server, the server no planner, `check` neither.
    from sequence_planner.control.process import Running, control  # noqa: PLC0415

    if spare and not is_needed():
        return
    begin(launched, socket.parent)
    station = prepare(model)
    network = _Network(station, transport, rosbridge)
    url = database_url(model, database)
    _until_interrupted(lambda connect: control(Running(station, socket, connect, emulated, start, url)), network)


def begin(launched: bool, folder: Path | None = None) -> None:
    """Set up a process of the station; `folder` is one that the launcher has made for it."""
    configure_logs()
    if launched:
        end_with_launcher(folder)


def prepare(folder: Path) -> ReadyStation:
    """The station in `folder`, or the end of this process."""
    try:
        return prepare_station(folder)
    except ModelError as error:
        refuse(str(error))


@dataclass(frozen=True)
class _Network:
    """How a station's processes join its network."""

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


def _until_interrupted(life: Callable[[Callable[[str], Transport]], Awaitable[None]], network: _Network) -> None:
    """Run a coroutine that connects to the network, until SIGTERM or SIGINT; trouble ends with exit code 2."""

    async def live() -> None:
        loop = asyncio.get_running_loop()
        running = asyncio.ensure_future(life(lambda node: network.join(node, loop)))
        for number in (signal.SIGTERM, signal.SIGINT):
            loop.add_signal_handler(number, running.cancel)
        with contextlib.suppress(asyncio.CancelledError):
            await running

    try:
        asyncio.run(live())
    except (TransportError, SynthesisEndedError, SocketTakenError, StorageError) as error:
        refuse(str(error))
