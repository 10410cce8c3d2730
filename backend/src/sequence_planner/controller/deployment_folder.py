"""A deployment that is under way, told in a folder beside the controller's socket until the station runs the new model.

The controller that makes room writes down what is deployed and how the model was before. The one that begins with the
new model says when it runs; the launcher waits for that, and brings the files back where the start fails. Then the
controller that begins with them reads why.
"""

from __future__ import annotations

import errno
import os
import shutil
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from sequence_planner.controller.views.part import ControlView
from sequence_planner.model.exchange import brought_back, exchanging
from sequence_planner.model.files import Contents, read_contents, restore_contents, write_contents

NAME = "deployment"
CUT_OFF = "the station was ended before all of its files were in place"
_NOTE, _BEFORE, _RUNS, _WAITS = "note.json", "before", "runs", "waits"


class DeploymentNote(BaseModel):
    """The revision that was deployed, by whom, when, who was in control; with `reset`, emulated devices and the station
    begin as the model says. `undone` is why it could not be started, once the files are as before; `kept` names these.
    """

    model_config = ConfigDict(frozen=True)
    revision: str
    name: str
    by: str
    time: float
    reset: bool = False
    control: ControlView | None = None
    undone: str | None = None
    kept: tuple[str, ...] = ()


class DeploymentFolder:
    """That folder, beside the socket in `beside`."""

    def __init__(self, beside: Path) -> None:
        self._folder = beside / NAME

    @property
    def exists(self) -> bool:
        """True if a deployment is under way, or was undone."""
        return self._folder.is_dir()

    def note(self) -> DeploymentNote | None:
        """Return what is deployed; None where nothing is."""
        try:
            return DeploymentNote.model_validate_json((self._folder / _NOTE).read_bytes())
        except (OSError, ValidationError):
            return None

    def begin(self, note: DeploymentNote, before: Contents) -> None:
        """Write down what is deployed, before anything is changed, and the files as they are. Raises `OSError`."""
        self.remove()
        self._folder.mkdir(mode=0o700)
        write_contents(before, self._folder / _BEFORE)
        self._write(note.model_copy(update={"kept": tuple(sorted(before))}))

    def begin_undone(self, note: DeploymentNote) -> None:
        """Write down that something was deployed, and the files are as before. Raises `OSError`."""
        self.remove()
        self._folder.mkdir(mode=0o700)
        self._write(note)

    def has_changed(self, model: Path) -> bool:
        """Return whether the files in the folder `model` are others than those that were kept. Raises `OSError`."""
        return read_contents(model) != read_contents(self._folder / _BEFORE)

    def tell_that_it_runs(self) -> None:
        """The station runs the new model. Raises `OSError`."""
        (self._folder / _RUNS).touch()

    @property
    def runs(self) -> bool:
        """True if the station runs the new model."""
        return (self._folder / _RUNS).exists()

    def tell_that_it_waits(self, *, waits: bool) -> None:
        """The new model waits, as somebody else commands the devices; or nobody does any more. Raises
        `OSError`.
        """
        mark = self._folder / _WAITS
        mark.touch() if waits else mark.unlink(missing_ok=True)

    @property
    def waits(self) -> bool:
        """True if somebody else commands the devices, which says nothing of the new model."""
        return (self._folder / _WAITS).exists()

    def bring_back(self, model: Path, why: str) -> None:
        """Let the model in the folder `model` be as it was before, and write down `why`.

        Raises `OSError`; in particular `FileNotFoundError`, with the model as it is, where not all is there any more
        that was kept: a model of which less is known must not lose its files.
        """
        note, kept = self.note(), self._folder / _BEFORE
        before = read_contents(kept)
        if note is None or not kept.is_dir() or set(before) != set(note.kept):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(kept))
        undone = note.model_copy(update={"undone": why})
        with exchanging(model, before, undone.model_dump_json()):
            restore_contents(before, model)
        self._write(undone)

    def remove(self) -> None:
        """It is over."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def _write(self, note: DeploymentNote) -> None:
        new = self._folder / f"{_NOTE}.new"
        new.write_text(note.model_dump_json(), encoding="utf-8")
        new.replace(self._folder / _NOTE)


def undo_what_was_cut_off(model: Path) -> DeploymentNote | None:
    """Bring the model in the folder `model` back where nobody has come to the end of exchanging its files; what was
    deployed, and why it was undone. None where nothing is cut off. Raises `OSError`.
    """
    if (told := brought_back(model)) is None:
        return None
    note = DeploymentNote.model_validate_json(told)
    return note if note.undone is not None else note.model_copy(update={"undone": CUT_OFF})
