"""The controller: one event loop on which messages, commands, plans and time become ticks, and ticks become messages.

It never waits for anything but its own events. Messages and acknowledgements wake it at once; otherwise it looks at the
clock often enough to notice a topic that fell silent and a command that is due again. Each tick is written down, and
what it tells the devices goes out as soon as that is durable. `controller.build` makes one.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import structlog

from sequence_planner.controller.commands.bus import CommandBus, Made, QueryBus
from sequence_planner.controller.commands.command import Command
from sequence_planner.controller.features.records import Records
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.ticks import Ticker
from sequence_planner.controller.views.builder import ViewBuilder
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor

LOG = structlog.get_logger(__name__)

LOOK_EVERY = 0.05  # seconds between two looks at the clock
LOOK_AT_REST = 0.2  # once there was no tick for a second: news, commands and plans are heard at once all the same
REST = 1.0

Work = tuple[str, Callable[[Timestamp], None]]


@dataclass(frozen=True)
class Parts:
    """All of a controller. `works` are done at each look at the clock, in order, and `attempt` does one of them.

    `begin` begins what runs beside it, and `close` ends that.
    """

    execution: Executor
    devices: Devices
    records: Records
    ticker: Ticker
    attempt: Callable[[str, Callable[[], None]], None]
    viewing: ViewBuilder
    commands: CommandBus
    queries: QueryBus
    works: Sequence[Work]
    begin: Callable[[], None]
    close: Sequence[Callable[[], None]]
    wake: asyncio.Event


class Controller:
    """A running station. Used from one event loop; `run` is its life.

    It only listens, and tells nobody anything but how the station stands, until it is told to `take_command`. From then
    on what happens, and has happened till then, is written into the journal.
    """

    def __init__(self, parts: Parts) -> None:
        self._parts = parts
        self.execution, self.devices, self.records = parts.execution, parts.devices, parts.records
        self.viewing, self.view, self.answer = parts.viewing, parts.viewing.now, parts.queries.answer
        self.changed = asyncio.Event()
        """Set whenever there was a tick, or something was recorded."""
        self._progress = 0, 0  # numbers of ticks, and of what was recorded, when it was set last
        self._last = 0, 0.0  # how many ticks there were, and since when

    async def run(self) -> None:
        """Tick until cancelled."""
        self._parts.begin()
        try:
            while True:
                self._step(Timestamp.now())
                if self._progress != (progress := (self.execution.ticks, self.records.newest)):
                    self._progress = progress
                    self.changed.set()
                if self.devices.waiting or self._parts.ticker.goes_on:
                    await asyncio.sleep(0)
                else:
                    self._parts.wake.clear()
                    with contextlib.suppress(TimeoutError):
                        async with asyncio.timeout(self._rest()):
                            await self._parts.wake.wait()
        finally:
            for close in self._parts.close:
                close()
            await self.records.writer.close()

    def _step(self, moment: Timestamp) -> None:
        attempt = self._parts.attempt
        attempt("looking at the network", lambda: self.devices.look(moment))
        self._parts.ticker.take_due(moment)
        for what, work in self._parts.works:
            attempt(what, partial(work, moment))

    def _rest(self) -> float:
        """Seconds until the next look at the clock: at the latest when a stage of a pipeline waits for it."""
        now, ticks = time.monotonic(), self.execution.ticks
        if ticks != self._last[0]:
            self._last = ticks, now
        look = LOOK_EVERY if now - self._last[1] < REST else LOOK_AT_REST
        due = self.devices.due(self.records.gate.released is not None)
        return look if due is None else min(look, max(0.0, due - now))

    @property
    def commands(self) -> bool:
        """True if it is the one that commands the station's devices."""
        return self.devices.network.commands

    def take_command(self) -> None:
        """Nobody else commands the station's devices, so this one does from now on. Raises `TransportError`."""
        self.devices.take_command()
        self.records.writer.start()
        self._parts.ticker.again()

    async def command(self, command: Command) -> Made:
        """Carry out a command, and return what it makes. Raises `CommandRefused`."""
        made = self._parts.commands.execute(command, Timestamp.now())
        LOG.info("command", **command.model_dump(mode="json"))
        self._parts.ticker.again()
        return made
