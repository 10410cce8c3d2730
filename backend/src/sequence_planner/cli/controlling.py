"""Running the controller."""

from __future__ import annotations

from typing import Annotated

import typer

from sequence_planner.analysis.process import SynthesisEndedError
from sequence_planner.cli.options import DatabaseOption, StationFolder, database_url, refuse
from sequence_planner.cli.parts import (
    Launched,
    Network,
    RosbridgeOption,
    Socket,
    TransportOption,
    begin,
    prepare,
    until_interrupted,
)
from sequence_planner.control.deploying import DeployedError
from sequence_planner.control.process import Running, control
from sequence_planner.lifeline import DEPLOYED, OVERTAKEN, is_needed
from sequence_planner.standby.keeper import LeaseLostError


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
    spare: Annotated[bool, typer.Option("--spare", hidden=True, help="Wait until the launcher says so.")] = False,
) -> None:
    """Run the controller alone; `run` does this."""
    if spare and not is_needed():
        return
    begin(launched, socket.parent)
    station = prepare(model)
    network = Network(station, transport, rosbridge)
    url = database_url(model, database)
    again = again or spare
    try:
        until_interrupted(
            lambda connect: control(Running(station, model, socket, connect, emulated, start, url, hot_standby, again)),
            network,
        )
    except SynthesisEndedError as error:
        refuse(str(error))
    except DeployedError:
        raise typer.Exit(DEPLOYED) from None
    except LeaseLostError:
        raise typer.Exit(OVERTAKEN) from None
