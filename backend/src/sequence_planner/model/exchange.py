"""The files of a model give way to others as a whole, though whoever exchanges them is killed, or the power fails.

As long as it lasts a hidden folder in that of the model holds the files as they were. Who finds it, and nobody at it,
brings them back: a model that is half one and half another was checked by nobody.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from sequence_planner.core.fsync import sync_folder
from sequence_planner.model.files import (
    SEARCHED_FOLDERS,
    Contents,
    forget_unfinished,
    read_contents,
    restore_contents,
    write_contents,
)

FOLDER: Final = ".deploying"
_NEW, _OLD = f"{FOLDER}.new", f"{FOLDER}.old"
_BEFORE, _NOTE, _LOCK = "before", "note", "lock"


@contextmanager
def exchanging(model: Path, before: Contents, note: str) -> Iterator[None]:
    """Keep what the files in the folder `model` were `before` while the block exchanges them; they are brought back
    where it fails, or does not come to its end. `note` is told to whoever does that. Raises `OSError`.
    """
    with _kept(model, before, note):
        try:
            yield
        except BaseException:
            with contextlib.suppress(OSError):  # then the next start does it
                _bring_back(model)
            raise
        _sync_folders(model)
        _remove(model)


def brought_back(model: Path) -> str | None:
    """Bring back what an exchange that was cut off has left; its note. None where there is none, or one is under way.

    Raises `OSError`.
    """
    _forget(model / _OLD)
    with contextlib.ExitStack() as held:
        try:
            lock = held.enter_context((model / FOLDER / _LOCK).open("rb"))
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (FileNotFoundError, NotADirectoryError, BlockingIOError):
            return None
        note = (model / FOLDER / _NOTE).read_text(encoding="utf-8")
        _bring_back(model)
        return note


@contextmanager
def _kept(model: Path, before: Contents, note: str) -> Iterator[None]:
    for left in (_NEW, _OLD, FOLDER):
        _forget(model / left)
    new = model / _NEW
    try:
        new.mkdir(mode=0o700, parents=True)
        write_contents(before, new / _BEFORE)
        (new / _NOTE).write_text(note, encoding="utf-8")
        with (new / _LOCK).open("wb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            _sync(new)
            new.replace(model / FOLDER)
            sync_folder(model)
            yield
    finally:
        _forget(new)


def _bring_back(model: Path) -> None:
    forget_unfinished(model)
    restore_contents(read_contents(model / FOLDER / _BEFORE), model)
    _sync_folders(model)
    _remove(model)


def _remove(model: Path) -> None:
    """At once: what is half removed is no exchange."""
    (model / FOLDER).replace(model / _OLD)
    sync_folder(model)
    _forget(model / _OLD)


def _forget(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)


def _sync(folder: Path) -> None:
    """Let all of it be on the disk. Raises `OSError`."""
    for path, _, files in os.walk(folder):
        for name in files:
            with (Path(path) / name).open("rb") as file:
                os.fsync(file.fileno())
        sync_folder(Path(path))


def _sync_folders(model: Path) -> None:
    """Let it be on the disk which files the model has: what is in each was written there as it was put in place."""
    sync_folder(model)
    for below in SEARCHED_FOLDERS:
        for path, _, _ in os.walk(model / below):
            sync_folder(Path(path))
