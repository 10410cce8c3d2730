"""Emulated devices: running them, and what a person does to them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.emulated import say
from sequence_planner.cli.options import UNUSABLE, StationFolder, refuse
from sequence_planner.cli.parts import (
    Launched,
    Network,
    RosbridgeOption,
    TransportOption,
    begin,
    prepare,
    until_interrupted,
)
from sequence_planner.emulation.fault_script import read_script
from sequence_planner.emulation.live import BY_HAND_TOPIC, FAULTS_TOPIC
from sequence_planner.emulation.possible import emulation_findings
from sequence_planner.emulation.process import Emulation, emulate
from sequence_planner.emulation.standing import read
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.lifeline import NOT_EMULATED
from sequence_planner.model.source import ModelError


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
    stand_as: Annotated[Path | None, typer.Option(hidden=True, help="How other devices stood, if it is there.")] = None,
    keep_in: Annotated[Path | None, typer.Option(hidden=True, help="Where it is kept how these stand.")] = None,
    launched: Launched = False,
) -> None:
    """Run emulated devices for a station, in place of real ones."""
    begin(launched)
    impossible = NOT_EMULATED if launched else UNUSABLE
    station = prepare(model, impossible)
    if findings := emulation_findings(station):
        refuse("\n".join(map(str, findings)), impossible)
    emulation = Emulation(
        station,
        speed,
        seed,
        jitter,
        frozenset(resource) if resource else None,
        standing=None if stand_as is None else read(stand_as),
        kept_in=keep_in,
    )
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
    network = Network(station, transport, rosbridge)
    until_interrupted(lambda connect: emulate(emulation, connect), network)


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
