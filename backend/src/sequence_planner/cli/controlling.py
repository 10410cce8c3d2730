"""Running the controller."""

from __future__ import annotations

from pathlib import Path
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
    until_interrupted,
)
from sequence_planner.control.deploying import DeployedError
from sequence_planner.control.preparation import Unusable
from sequence_planner.control.process import NotStartedError, Running, control
from sequence_planner.lifeline import DEPLOYED, OVERTAKEN
from sequence_planner.model.source import ModelError
from sequence_planner.standby.keeper import LeaseLostError
from sequence_planner.station import ReadyStation, prepare_station


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
    network = None if isinstance(station, Unusable) else Network(station, transport, rosbridge)
    url = database_url(model, database)
    try:
        until_interrupted(
            lambda connect: control(Running(station, model, socket, connect, emulated, start, url, hot_standby, again)),
            network,
        )
    except (SynthesisEndedError, NotStartedError) as error:
        refuse(str(error))
    except DeployedError:
        raise typer.Exit(DEPLOYED) from None
    except LeaseLostError:
        raise typer.Exit(OVERTAKEN) from None


def _usable(model: Path, launched: bool) -> ReadyStation | Unusable:
    """The station in the folder `model`, or why it cannot be used; without a page to repair it that is refused."""
    try:
        return prepare_station(model)
    except ModelError as error:
        if not launched:
            refuse(str(error))
        return Unusable(model.resolve().name, tuple(error.findings))
