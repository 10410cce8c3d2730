"""The launcher's part in a deployment: the emulated devices begin anew with the controller, and where one of them
cannot be started with the new model the one before is brought back.
"""

from __future__ import annotations

import contextlib
import time
from pathlib import Path
from typing import TYPE_CHECKING

import structlog

from sequence_planner.controller.deployment_folder import DeploymentFolder, undo_what_was_cut_off
from sequence_planner.process.parent_watch import DEPLOYED, OVERTAKEN
from sequence_planner.simulation.device_state import standing_file

if TYPE_CHECKING:
    from sequence_planner.startup.station_process import StationProcess

LOG = structlog.get_logger(__name__)
LONGEST_START = 300.0  # seconds: safe states may take two minutes, and a machine may be busy


class UnderWay:
    """Watches over the start of what was deployed; `emulator` is None where nothing is emulated."""

    def __init__(self, model: Path, beside: Path, controller: StationProcess, emulator: StationProcess | None) -> None:
        self._model = model
        self._folder = DeploymentFolder(beside)
        self._controller = controller
        self._emulator = emulator
        self._standing = standing_file(beside)
        self._before = self._standing.with_stem(f"{self._standing.stem}-before")
        self._since: float | None = None
        self.was = False  # another model than that of the first start has been deployed

    def look(self) -> None:
        """See how far it is, each time before the parts are looked after."""
        if self._controller.ended == DEPLOYED:
            self._begin()
        elif self._since is None:
            if self._controller.ended is not None:
                self._look_what_is_left()
        elif self._folder.runs:
            self._since = None
            self._folder.remove()
        elif not self._folder.exists:
            self._since = None
            LOG.warning("what was kept of a deployment has vanished, and its model stays whatever becomes of its start")
        else:
            if self._controller.ended == OVERTAKEN or self._folder.waits:
                # The next one prepares the model from the first; and for whom it waits is not the model's affair.
                self._since = time.monotonic()
            if (why := self._failure(self._since)) is not None:
                self._undo(why)

    def _look_what_is_left(self) -> None:
        """See how the files are where a controller has died that may have been exchanging them."""
        note = self._folder.note()
        if note is None or note.undone is not None:
            return
        try:
            undone = undo_what_was_cut_off(self._model)
            if undone is not None:
                LOG.error("a deployment was cut off, and the model before is back", because=undone.undone)
                self._folder.begin_undone(undone)
            elif self._folder.has_changed(self._model):
                self._begin()  # all files are in place, and it has died as it made room
            else:
                self._folder.remove()
        except OSError as error:
            LOG.exception("the model before cannot be brought back", because=error.strerror)

    def _begin(self) -> None:
        """The files are in place, and the controller has made room."""
        self.was, self._since = True, time.monotonic()
        if self._emulator is None:
            return
        self._emulator.stop()
        self._before.unlink(missing_ok=True)
        with contextlib.suppress(FileNotFoundError):  # they have never been up
            self._standing.replace(self._before)
        note = self._folder.note()
        self._begin_devices(anew=note is not None and note.reset)

    def _failure(self, since: float) -> str | None:
        """Return why the start has failed; None while it has not."""
        for part in (self._controller, self._emulator):
            code = None if part is None else part.ended
            if part is not None and code is not None and code != OVERTAKEN:
                return part.said(code)
        if time.monotonic() - since > LONGEST_START:
            return f"it did not run within {LONGEST_START:g} s"
        return None

    def _undo(self, why: str) -> None:
        """Bring the model before back, and begin with it."""
        self._since = None
        self._controller.stop()
        if self._emulator is not None:
            self._emulator.stop()
        LOG.error("a deployed model cannot be started, and the one before is brought back", because=why)
        try:
            self._folder.bring_back(self._model, why)
        except OSError as error:
            LOG.exception("the model before cannot be brought back", because=error.strerror)
            self._folder.remove()
        if self._emulator is not None:
            self._standing.unlink(missing_ok=True)
            self._begin_devices(anew=False)
        self._controller.spawn("--again")

    def _begin_devices(self, *, anew: bool) -> None:
        assert self._emulator is not None
        self._emulator.spawn(*([] if anew else ["--stand-as", str(self._before)]))
