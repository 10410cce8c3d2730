"""Another model in the place of the one that runs: its files are put into the folder of the model, and the controller
begins anew.

It begins as after any other end: estimates and outputs come back from the journal as far as they fit, nothing is
published, and a person starts production.
"""

from __future__ import annotations

import asyncio
from pathlib import Path

from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.production_commands import Deploy
from sequence_planner.workshop.files import put_in_place, read_files

ANSWERED = 0.3  # seconds in which who has asked for it gets the answer


class DeployedError(Exception):
    """The files of another model are in place, and this controller makes room for one that runs it."""


class Deploying:
    """Puts what is staged beside the `socket` into the folder `model`."""

    def __init__(self, model: Path, socket: Path) -> None:
        self._model = model
        self._beside = socket.parent
        self._in_place = asyncio.Event()

    async def carry_out(self, command: Deploy) -> None:
        """Put the files in place. Raises `CommandRefused`; the model is as it was then."""
        try:
            files = await asyncio.to_thread(read_files, self._beside / command.staged)
            if "station.yaml" not in files:
                raise CommandRefused("not-staged", "The files are not there", "Try once more to deploy the revision.")
            await asyncio.to_thread(put_in_place, files, self._model)
        except OSError as error:
            detail = f"The files of the model cannot be written: {error.strerror}. Look at who may write to its folder."
            raise CommandRefused("model-not-written", "The model cannot be written", detail) from error
        self._in_place.set()

    async def end(self) -> None:
        """Wait until files are in place. Raises `DeployedError` then."""
        await self._in_place.wait()
        await asyncio.sleep(ANSWERED)
        raise DeployedError
