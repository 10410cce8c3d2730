"""Commands for emulated devices: run them, move them by hand, and inject faults."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.cli.options import UNUSABLE, StationFolder, refuse
from sequence_planner.cli.part_options import (
    Launched,
    Network,
    RosbridgeOption,
    TransportOption,
    begin,
    prepare,
    until_interrupted,
)
from sequence_planner.core.logging import configure_logs
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.model.source import ModelError
from sequence_planner.process.parent_watch import NOT_EMULATED
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, Transport, TransportError
from sequence_planner.ros.transports.choice import TransportChoice, open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.simulation.device_state import read
from sequence_planner.simulation.fault_script import read_script
from sequence_planner.simulation.manual_interface import (
    BY_HAND_TOPIC,
    FAULTS_TOPIC,
    REFUSED,
    SAID_TOPIC,
    TEXT_TYPE,
    answer_start,
)
from sequence_planner.simulation.service import Emulation, emulate
from sequence_planner.simulation.supported import emulation_findings

# What a person does to emulated devices that run elsewhere: a line is sent to them, and their answer is shown.

DISCOVERY = 5.0  # seconds in which the emulated devices are found
PATIENCE = 5.0  # seconds in which they answer
SETTLING = 0.3  # seconds in which those who have been found find us, or else their answer would be lost
LOOK_EVERY = 0.05  # seconds between two looks for them


def say(topic: str, line: str, choice: TransportChoice) -> None:
    """Send a line to the emulated devices and print what they answer, with exit code 1 when they refuse."""
    configure_logs()
    answer = asyncio.run(_ask(topic, line, choice))
    typer.echo(answer, err=answer.startswith(REFUSED))
    if answer.startswith(REFUSED):
        raise typer.Exit(1)


async def _ask(topic: str, line: str, choice: TransportChoice) -> str:
    registry = MessageRegistry.from_folder(None)
    try:
        transport = open_transport(choice, registry, "by_hand", asyncio.get_running_loop())
    except TransportError as error:
        refuse(str(error))
    answer: asyncio.Future[str] = asyncio.get_running_loop().create_future()

    def hear(samples: Sequence[Sample]) -> None:
        for sample in samples:
            text = str(registry.decode(TEXT_TYPE, sample.data)["data"])
            if text.startswith(answer_start(line)) and not answer.done():
                answer.set_result(text.removeprefix(answer_start(line)))

    try:
        transport.subscribe(SAID_TOPIC, TEXT_TYPE, QualityOfService.RELIABLE, hear)
        transport.advertise(topic, TEXT_TYPE, QualityOfService.RELIABLE)
        await _found(transport, topic)
        transport.publish(topic, TEXT_TYPE, registry.encode(TEXT_TYPE, {"data": line}))
        return await asyncio.wait_for(answer, PATIENCE)
    except TimeoutError:
        refuse("the emulated devices gave no answer: whether it was done is not known")
    finally:
        transport.close()


async def _found(transport: Transport, topic: str) -> None:
    """Wait until the emulated devices are there, on both topics."""
    for _ in range(round(DISCOVERY / LOOK_EVERY)):
        there = {(each.topic, each.direction) for each in transport.graph() if not each.own}
        if {(topic, "subscriber"), (SAID_TOPIC, "publisher")} <= there:
            await asyncio.sleep(SETTLING)
            return
        await asyncio.sleep(LOOK_EVERY)
    refuse("no emulated devices are running: start them with `sequence-planner emulate MODEL`")


# Emulated devices: running them, and what a person does to them.


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
