"""Sees to it that what was carried out lasts before anybody is told that it was.

The journal should have it. Where it does not soon, what was asked for is written down in the station's last word,
beside the journal (`journal.last_accepted`): a controller that begins anew finds it there.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import structlog

from sequence_planner.controller.commands.audit import entry_of
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.controller import Controller
from sequence_planner.journal.entry import Outcome, described
from sequence_planner.journal.last_accepted import LastWord, Word
from sequence_planner.texts.message import message

LOG = structlog.get_logger(__name__)
PATIENCE = 1.0  # seconds for the journal, and for the file beside it


class Lasting:
    """Waits for the journal, or else writes to `last_word`."""

    def __init__(self, last_word: LastWord) -> None:
        self._last_word = last_word
        self._thread = ThreadPoolExecutor(1, "last-word")  # words are written in the order in which they were said

    def close(self) -> None:
        """Write what is under way, then end."""
        self._thread.shutdown()

    async def begin(self, controller: Controller, epoch: int | None) -> None:
        """A controller begins its life; `epoch` is that of the lease that it holds."""
        await self._written(partial(self._last_word.start_life, controller.records.begun, epoch))

    async def settle(
        self, command: Command, controller: Controller, before: int, audited: asyncio.Task[None] | None
    ) -> bool:
        """Return whether the journal has all that a command did, which it can be told of as carried out in any case.

        `before` is the last record before the command, `audited` ends when it is recorded who gave it. Raises
        `CommandRefused` when the command stops devices and it is nowhere written down that it did.
        """
        number = controller.records.newest
        if number == before and not command.harmless:
            return True
        entry = entry_of(command).model_copy(update={"outcome": Outcome.DONE})
        word = Word(number=number, mode=controller.execution.mode, time=time.time(), entry=entry)
        keeping = asyncio.create_task(self._keep(word)) if command.harmless else None
        recorded = await controller.records.writer.until_durable(number, PATIENCE)
        if recorded and audited is not None:
            recorded = bool((await asyncio.wait({audited}, timeout=PATIENCE))[0])
        if recorded:
            return True
        kept = await (keeping or self._keep(word))
        if not kept and command.harmless:
            raise _not_kept(self._last_word)
        if kept:
            controller.records.note_kept(number, f"{command.actor.name} asked for {described(entry)}")
        return False

    async def _keep(self, word: Word) -> bool:
        """Return whether a word is written down beside the journal."""
        return await self._written(partial(self._last_word.say, word))

    async def _written(self, write: Callable[[], None]) -> bool:
        try:
            async with asyncio.timeout(PATIENCE):
                await asyncio.get_running_loop().run_in_executor(self._thread, write)
        except (OSError, TimeoutError) as error:
            LOG.error("the last word cannot be kept", file=str(self._last_word.path), because=repr(error))
            return False
        return True


def _not_kept(last_word: LastWord) -> CommandRefused:
    return CommandRefused(
        "stop-not-recorded", message("refused.stop-not-recorded.nowhere", path=str(last_word.path)), 503
    )
