"""Where a station's database is if nobody says so."""

from __future__ import annotations

import hashlib
import os
import re
from pathlib import Path
from urllib.parse import quote

from sequence_planner.storage.address import SqliteFile, address
from sequence_planner.storage.error import StorageError


def revisions_folder(url: str, model: Path) -> Path:
    """Where the revisions of the model are kept: beside the file of SQLite, or else where that would be.

    Raises `StorageError` for a URL that names no database.
    """
    place = address(url)
    if not isinstance(place, SqliteFile):
        place = address(default_url(model))
        assert isinstance(place, SqliteFile)
    return place.path.with_name(f"{place.path.stem}.revisions.git")


def backups_folder(url: str, model: Path) -> Path:
    """Where backups are kept unless somebody says so: beside the revisions. Raises `StorageError` as they do."""
    revisions = revisions_folder(url, model)
    return revisions.with_name(revisions.name.replace(".revisions.git", ".backups"))


def archive_folder(url: str, model: Path) -> Path:
    """Where what was cut is kept unless somebody says so: beside the revisions. Raises `StorageError` as they do."""
    revisions = revisions_folder(url, model)
    return revisions.with_name(revisions.name.replace(".revisions.git", ".archive"))


def mark_of(model: Path) -> str:
    """What tells the station in the folder `model` from others of this machine: the folder's name, and 8 hexadecimal
    digits of the SHA-256 of its path.
    """
    resolved = model.resolve()
    name = re.sub(r"[^\w.-]", "_", resolved.name)
    digits = hashlib.sha256(os.fsencode(resolved)).hexdigest()[:8]
    return f"{name}-{digits}"


def default_url(model: Path) -> str:
    """The URL of a SQLite file for the station in the folder `model`, the same from wherever the folder is named.

    It is in `$XDG_STATE_HOME`, or else in `~/.local/state`, in a folder of `sequence-planner` that is named after the
    model's folder (`mark_of`). Raises `StorageError` where there is no home.
    """
    file = state_folder() / mark_of(model) / "station.sqlite"
    return f"sqlite:///{quote(str(file))}"


def state_folder() -> Path:
    """This user's folder for what stations keep. Raises `StorageError` where there is no home."""
    return _state_home() / "sequence-planner"


def _state_home() -> Path:
    base = os.environ.get("XDG_STATE_HOME", "")
    if Path(base).is_absolute():
        return Path(base)
    try:
        return Path.home() / ".local" / "state"
    except RuntimeError as error:
        raise StorageError("there is no home folder to keep the database in: say where with --database URL") from error
