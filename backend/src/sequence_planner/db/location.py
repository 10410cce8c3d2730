"""Database location: parsed URL (SQLite or PostgreSQL), its default, and the folders beside it."""

from __future__ import annotations

import hashlib
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from sequence_planner.core.storage_error import StorageError

if TYPE_CHECKING:
    from sqlalchemy import URL

# Where a database is, as its URL says.

_SQLITE = ("sqlite", "sqlite+pysqlite")
_POSTGRESQL = ("postgresql", "postgres", "postgresql+psycopg")
_FORMS = "sqlite:////folder/station.sqlite or postgresql://user:password@host/database"


@dataclass(frozen=True)
class SqliteFile:
    """A file of SQLite; `path` is absolute."""

    path: Path

    def __str__(self) -> str:
        return str(self.path)


@dataclass(frozen=True)
class PostgresqlServer:
    """A database on a PostgreSQL server. `url` may hold a password and is never shown."""

    url: URL

    def __str__(self) -> str:
        """The place for people: host, port and database, and nothing else of the URL."""
        host = self.url.host or self.url.query.get("host") or "this machine"
        port = f":{self.url.port}" if self.url.port else ""
        return f"PostgreSQL database {self.url.database or '(default)'} at {host}{port}"


def address(url: str) -> SqliteFile | PostgresqlServer:
    """Return what a URL names. Raises `StorageError`, which never quotes the URL, as it may hold a password."""
    from sqlalchemy.exc import ArgumentError  # noqa: PLC0415

    try:
        read = read_url(url)
    except (ArgumentError, ValueError):
        raise StorageError(f"the database's URL cannot be read: write {_FORMS}") from None
    if read.drivername in _SQLITE:
        return _sqlite_file(read)
    if read.drivername in _POSTGRESQL:
        if url.count("@") > (read.username is not None):
            # What is taken for the host may be a part of the password.
            raise StorageError("the database's URL has a sign in its user or password to be escaped: write @ as %40")
        return PostgresqlServer(read.set(drivername="postgresql+psycopg"))
    raise StorageError(f"a database of the kind `{read.drivername}` is not supported: write {_FORMS}")


def read_url(url: str) -> URL:
    """A URL with its password where passwords are left out, though it may be written as `?password=` too.

    Raises `ArgumentError` and `ValueError`.
    """
    from sqlalchemy import make_url  # noqa: PLC0415

    read = make_url(url)
    passwords = read.normalized_query.get("password")
    if not passwords:
        return read
    return read.difference_update_query(["password"]).set(password=passwords[-1])


def _sqlite_file(url: URL) -> SqliteFile:
    if not url.database or url.database == ":memory:" or url.database.startswith("file:") or url.query or url.host:
        raise StorageError("the database's URL must name a file: write sqlite:////folder/station.sqlite")
    return SqliteFile(Path(url.database).absolute())


# Where a station's database is if nobody says so.


def revisions_folder(url: str, model: Path) -> Path:
    """Return where the revisions of the model are kept: beside the file of SQLite, or else where that would be.

    Raises `StorageError` for a URL that names no database.
    """
    place = address(url)
    if not isinstance(place, SqliteFile):
        place = address(default_url(model))
        assert isinstance(place, SqliteFile)
    return place.path.with_name(f"{place.path.stem}.revisions.git")


def backups_folder(url: str, model: Path) -> Path:
    """Return where backups are kept unless somebody says so: beside the revisions. Raises `StorageError` as they do."""
    revisions = revisions_folder(url, model)
    return revisions.with_name(revisions.name.replace(".revisions.git", ".backups"))


def archive_folder(url: str, model: Path) -> Path:
    """Return where what was cut is kept unless somebody says so: beside the revisions. Raises `StorageError` as they
    do.
    """
    revisions = revisions_folder(url, model)
    return revisions.with_name(revisions.name.replace(".revisions.git", ".archive"))


def mark_of(model: Path) -> str:
    """Return what tells the station in folder `model` from others of this machine: the folder's name and 8 hexadecimal
    digits of its path's SHA-256.
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
