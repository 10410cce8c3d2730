"""Checks of the draft, of which only the newest matters."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from sequence_planner.start_needs import StartNeeds
from sequence_planner.workshop.check_view import CheckState, CheckView, waiting
from sequence_planner.workshop.draft_process import DraftProcess
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.processes import WorkEndedError, working

SETTLED = 0.15  # seconds without a change after which the whole is checked


class CheckDesk:
    """Checks what it is told to, from one event loop. `stages` is the model whose Python stages belong to the draft,
    which is to be run as `start` says.

    `process` says at once what makes the draft unusable; all else is found by a process for each check, from scratch.
    `tell` is called with each view, all of one check in their order.
    """

    def __init__(
        self, stages: Path | None, start: StartNeeds, process: DraftProcess, tell: Callable[[CheckView], None]
    ) -> None:
        self._stages = stages
        self._start = start
        self._process = process
        self._tell = tell
        self._wanted: tuple[int, Files] | None = None
        self._looking: asyncio.Task[None] | None = None
        self._checking: asyncio.Task[None] | None = None

    def check(self, number: int, files: Files) -> None:
        """Check this now, and nothing else any more."""
        if self._checking is not None:
            self._checking.cancel()
        self._tell(waiting(number))
        self._wanted = number, dict(files)
        if self._looking is None or self._looking.done():
            self._looking = asyncio.create_task(self._look())

    async def close(self) -> None:
        """End what is being checked."""
        tasks = [task for task in (self._looking, self._checking) if task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _look(self) -> None:
        """Look for errors in what is wanted last, and check it as a whole if there are none."""
        while self._wanted is not None:
            (number, files), self._wanted = self._wanted, None
            try:
                errors = await self._process.errors(files)
            except WorkEndedError:
                errors = []  # then the check says what is the matter
            if self._wanted is not None:
                continue
            if errors:
                self._tell(
                    waiting(number).model_copy(update={"state": CheckState.DONE, "doing": "", "findings": errors})
                )
            else:
                self._checking = asyncio.create_task(self._checked(number, files, self._checking))

    async def _checked(self, number: int, files: Files, before: asyncio.Task[None] | None) -> None:
        if before is not None:
            await asyncio.gather(before, return_exceptions=True)
        await asyncio.sleep(SETTLED)
        view = waiting(number)
        try:
            async with working("checking", "checked", number, files, self._stages, self._start) as found:
                async for told in found:
                    assert isinstance(told, CheckView)
                    view = told
                    self._tell(view)
                    if view.state is CheckState.DONE:
                        break
        except WorkEndedError as ended:
            self._tell(view.model_copy(update={"state": CheckState.FAILED, "doing": str(ended)}))
