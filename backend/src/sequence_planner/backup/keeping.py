"""Where a station's backups are kept, how many, and which there are.

A folder that somebody has named must be there: one that is not may be a disk that is not mounted, and nobody would look
for what is written in its place. Only what the station has named itself is ever removed: what other stations or people
have put beside it stays.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pydantic import BaseModel

from sequence_planner.backup.archive import MODEL, REVISIONS, Manifest, manifest_of
from sequence_planner.backup.copies import kind_of
from sequence_planner.backup.postgresql_programs import program
from sequence_planner.backup.settings import Keeping
from sequence_planner.backup.trouble import no_folder, no_space, not_writable
from sequence_planner.storage.address import SqliteFile, address
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import backups_folder, mark_of, revisions_folder

ENDING: Final = ".tar"
_AT_ONCE: Final = 2  # copies on the disk while one is made: what was gathered, and the file that it goes to


class Kept(BaseModel):
    """A file in the folder. `manifest` says what is in it; None, and `wrong` why, where it cannot be read."""

    file: str
    size: int
    manifest: Manifest | None
    wrong: str | None


@dataclass(frozen=True)
class Looked:
    """The folder as it is now: the newest backups first, and what would keep another from being made."""

    backups: tuple[Kept, ...]
    trouble: StorageError | None
    free: int | None  # bytes
    same_disk: bool  # as the database: what takes one takes the other


class Shelf:
    """The backups of the station in the folder `model`. Raises `StorageError` for a `url` that names no database."""

    def __init__(self, url: str, model: Path, keeping: Keeping) -> None:
        self.url, self.model, self.keeping = url, model, keeping
        self.folder = (keeping.folder or backups_folder(url, model)).absolute()
        self._mark = mark_of(model)
        self._own = re.compile(rf"{re.escape(self._mark)}-\d{{8}}T\d{{6}}Z{re.escape(ENDING)}")
        self._known: dict[tuple[str, int, int, int], Kept] = {}  # by name, and what changes when the file does

    def look(self) -> Looked:
        """All backups there are, and whether one can be made."""
        trouble, free = None, None
        try:
            free = self.require_usable()
        except StorageError as error:
            trouble = error
        return Looked(self._backups(), trouble, free, self._same_disk())

    def find(self, name: str) -> Path | None:
        """The file of one of the backups."""
        return self.folder / name if any(each.file == name for each in self._backups()) else None

    def new(self, now: float) -> Path:
        """A file for a backup made now that takes no other's place."""
        while True:
            file = self.folder / f"{self._mark}-{time.strftime('%Y%m%dT%H%M%SZ', time.gmtime(now))}{ENDING}"
            if not file.exists():
                return file
            now += 1

    @property
    def scratch(self) -> str:
        """How the folders begin in which the station puts a backup together, or takes one apart."""
        return f".{self._mark}-"

    def require_usable(self) -> int:
        """The bytes that are free for a backup. Raises `StorageError` where none can be made, as far as can be seen."""
        if kind_of(self.url) == "postgresql":
            program("pg_dump")
        folder = self._there()
        if not folder.is_dir():
            raise no_folder(folder, "it is not there" if not folder.exists() else "it is no folder")
        if not os.access(folder, os.W_OK | os.X_OK):
            raise not_writable(folder, "permission denied")
        free = shutil.disk_usage(folder).free
        if free < (needed := _AT_ONCE * self._size()):
            raise no_space(folder, f"{needed / 1e6:.1f} MB are needed, and {free / 1e6:.1f} MB free")
        return free

    def prepare(self) -> None:
        """See to it that the folder is there, and has room. Raises `StorageError` as `require_usable`."""
        self.clear()
        self.require_usable()
        if self.keeping.folder is None:
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)

    def clear(self) -> None:
        """Take away what a process has left that did not come to its end."""
        for left in self.folder.glob(f"{self.scratch}*"):
            if left.is_dir() and not left.is_symlink():
                shutil.rmtree(left, ignore_errors=True)
            else:
                left.unlink(missing_ok=True)

    def remove_oldest(self, newest: Path) -> list[str]:
        """Remove all but so many; `newest` is one that is whole, and stays whatever the clock has said. The removed."""
        own = [each for each in self._backups() if self._own.fullmatch(each.file) and each.file != newest.name]
        removed = own[max(0, self.keeping.kept - 1) :]
        for each in removed:
            (self.folder / each.file).unlink(missing_ok=True)
        return [each.file for each in removed]

    def _backups(self) -> tuple[Kept, ...]:
        known, self._known = self._known, {}
        with contextlib.suppress(OSError), os.scandir(self.folder) as entries:
            for entry in entries:
                if entry.name.startswith(".") or not entry.name.endswith(ENDING):
                    continue
                if entry.is_file(follow_symlinks=False):
                    status = entry.stat()
                    stamp = entry.name, status.st_ino, status.st_size, status.st_mtime_ns
                    self._known[stamp] = known.get(stamp) or _read(Path(entry.path), status.st_size)
        return tuple(sorted(self._known.values(), key=_when, reverse=True))

    def _size(self) -> int:
        """The bytes that a copy has, as far as this machine can see; what `pg_dump` writes is not known before."""
        place = address(self.url)
        files = [place.path, place.path.with_name(f"{place.path.name}-wal")] if isinstance(place, SqliteFile) else []
        files += [each for each in revisions_folder(self.url, self.model).rglob("*") if each.is_file()]
        sizes = 0
        for each in files:
            with contextlib.suppress(OSError):
                sizes += each.stat().st_size
        return sizes

    def _there(self) -> Path:
        """The folder, or of one that is made with the first backup what is there already."""
        if self.keeping.folder is not None:
            return self.folder
        return next(each for each in (self.folder, *self.folder.parents) if each.exists())

    def _same_disk(self) -> bool:
        place = address(self.url)
        try:
            return isinstance(place, SqliteFile) and place.path.stat().st_dev == self._there().stat().st_dev
        except OSError:
            return False


def what_is_in(manifest: Manifest) -> tuple[int, bool]:
    """How many files of the model a backup has, and whether it has revisions."""
    files = sum(1 for name in manifest.files if name.startswith(f"{MODEL}/"))
    return files, any(name.startswith(f"{REVISIONS}/") for name in manifest.files)


def _read(file: Path, size: int) -> Kept:
    try:
        return Kept(file=file.name, size=size, manifest=manifest_of(file), wrong=None)
    except StorageError as error:
        return Kept(file=file.name, size=size, manifest=None, wrong=str(error))


def _when(kept: Kept) -> tuple[float, str]:
    return (0.0 if kept.manifest is None else kept.manifest.time, kept.file)
