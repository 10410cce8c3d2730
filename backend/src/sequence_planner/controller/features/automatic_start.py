"""Production that is started without a person, where that is allowed; any refusal is looked at again a little later."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Awaitable, Callable

import structlog

from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import StartProduction
from sequence_planner.controller.controller import Controller
from sequence_planner.core.actor import SYSTEM
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.simulation.manual_interface import NODE as EMULATED_DEVICES

LOG = structlog.get_logger(__name__)

Handle = Callable[[Command], Awaitable[object]]


async def start_when_alone(controller: Controller, handle: Handle, look_every: float = 0.2) -> None:
    """Let production be started by `handle`, without a person, once emulated devices and nobody else are there, and
    unless somebody has stopped the station.
    """
    said: list[str] = []
    while controller.execution.production is Production.WAITING:
        strangers = controller.devices.strangers(f"/{EMULATED_DEVICES}")
        # What would be refused is not tried again and again, as each try is recorded.
        strangers += [f"it is not decided what {name} shall be" for name in controller.view().undecided]
        if not strangers and controller.execution.mode is Mode.AUTOMATIC:
            with contextlib.suppress(CommandRefused):  # since the network was looked at, somebody has come
                await handle(StartProduction(actor=SYSTEM, reason="started with --start"))
        elif strangers and strangers != said:
            said = strangers
            LOG.info("production is not started by itself", because=strangers)
        await asyncio.sleep(look_every)


async def go_on(controller: Controller, handle: Handle, before: str, look_every: float = 0.2) -> None:
    """Let production go on by `handle` where the command was taken over from the station `before`, as the model allows.

    It waits as long as a person has to decide on an output, or somebody else is still seen on the topics, and ends for
    good when somebody has stopped the station meanwhile.
    """
    why = f"taken over from {before}, as the model allows"
    while controller.execution.production is Production.WAITING and controller.execution.mode is Mode.AUTOMATIC:
        if not controller.view().undecided and not controller.execution.blind and not controller.devices.network.rivals:
            with contextlib.suppress(CommandRefused):
                await handle(StartProduction(actor=SYSTEM, reason=why))
        await asyncio.sleep(look_every)
