"""The controller's figures, asked for at most once a second, whoever wants them and however many they are."""

from __future__ import annotations

import asyncio
import time

from sequence_planner.control.asks import AskFigures
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.figures_view import FiguresView
from sequence_planner.web.controller_client import ControllerClient

FRESH = 1.0  # seconds


class Figures:
    """What `controller` has counted and timed of itself."""

    def __init__(self, controller: ControllerClient) -> None:
        self._controller = controller
        self._turn = asyncio.Lock()
        self._due = 0.0  # on the clock of `time.monotonic`
        self._newest: FiguresView | None = None

    async def newest(self) -> FiguresView | None:
        """They are a second old at most; None where the controller is silent, or has none yet."""
        async with self._turn:
            if time.monotonic() >= self._due:
                self._newest = await self._asked()
                self._due = time.monotonic() + FRESH
            return self._newest

    async def _asked(self) -> FiguresView | None:
        if not self._controller.heard:
            return None
        try:
            return await self._controller.ask(AskFigures())
        except CommandRefused:  # the station is being prepared, or the controller is gone
            return None
