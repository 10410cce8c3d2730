"""What a person does to emulated devices that run elsewhere: a line is sent to them, and their answer is shown."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

import typer

from sequence_planner.cli.options import refuse
from sequence_planner.emulation.live import REFUSED, SAID_TOPIC, TEXT_TYPE, answer_start
from sequence_planner.logs import configure_logs
from sequence_planner.ros.choice import TransportChoice, open_transport
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.transport import QualityOfService, Sample, Transport, TransportError

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
