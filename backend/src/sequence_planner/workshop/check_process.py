"""Checks of the draft, of which only the newest matters."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from sequence_planner.workshop.check_view import CheckState, CheckView, waiting
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.processes import WorkEndedError, working

SETTLED = 0.15  # seconds without a change after which a check begins


class CheckDesk:
    """Checks what it is told to, from one event loop; `stages` is the model whose Python stages belong to the draft.

    `tell` is called with each view, all of one check in their order.
    """

    def __init__(self, stages: Path | None, tell: Callable[[CheckView], None]) -> None:
        self._stages = stages
        self._tell = tell
        self._checking: asyncio.Task[None] | None = None

    def check(self, number: int, files: Files) -> None:
        """Check this now, and nothing else any more."""
        if self._checking is not None:
            self._checking.cancel()
        self._tell(waiting(number))
        self._checking = asyncio.create_task(self._checked(number, dict(files), self._checking))

    async def close(self) -> None:
        """End what is being checked."""
        if self._checking is not None:
            self._checking.cancel()
            await asyncio.gather(self._checking, return_exceptions=True)

    async def _checked(self, number: int, files: Files, before: asyncio.Task[None] | None) -> None:
        if before is not None:
            await asyncio.gather(before, return_exceptions=True)
        await asyncio.sleep(SETTLED)
        view = waiting(number)
        try:
            async with working("checking", "checked", number, files, self._stages) as found:
                async for told in found:
                    assert isinstance(told, CheckView)
                    view = told
                    self._tell(view)
                    if view.state is CheckState.DONE:
                        break
        except WorkEndedError as ended:
            self._tell(view.model_copy(update={"state": CheckState.FAILED, "doing": str(ended)}))
