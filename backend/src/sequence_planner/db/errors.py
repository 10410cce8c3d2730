"""Database errors in plain words, and the guard against an unintended empty database."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import pwd
import sqlite3
import stat
from pathlib import Path
from typing import Final

from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.location import PostgresqlServer, SqliteFile, state_folder

# A database that is empty where a station was: no new station begins in its place unless somebody says so.

_MOST_NAMED: Final = 3


def left_of(place: SqliteFile | PostgresqlServer) -> list[Path]:
    """Return what a station with this database has left beside it: keys, last word, archive, backups, revisions of its
    model.
    """
    if isinstance(place, PostgresqlServer):
        mark = hashlib.sha256(str(place).encode()).hexdigest()[:8]
        return sorted(state_folder().glob(f"*-{mark}*")) if state_folder().is_dir() else []
    file = place.path
    if not file.parent.is_dir():
        return []
    beside = [each for each in file.parent.glob(f"{_literal(file.name)}-*") if each.suffix in (".pem", ".key")]
    beside += [each for name in ("-last-word", "-wal") if (each := Path(f"{file}{name}")).is_file()]
    folders = [file.with_name(f"{file.stem}.{name}") for name in ("revisions.git", "archive", "backups")]
    return sorted(each for each in [*beside, *folders] if _holds_something(each))


def require_meant(place: SqliteFile | PostgresqlServer) -> None:
    """Raises `StorageError` where a station was, of which the database holds nothing any more."""
    left = left_of(place)
    if left:
        named = ", ".join(str(each) for each in left[:_MOST_NAMED])
        more = f" and {len(left) - _MOST_NAMED} more" if len(left) > _MOST_NAMED else ""
        raise StorageError(
            f"{place} is empty or not there, but a station has left {named}{more}: put a backup of the database in its "
            "place (docs/database.md). If a new station is meant to begin here, start it with `run --new`"
        )


def _literal(name: str) -> str:
    """It as a pattern that is nothing but itself."""
    return "".join(f"[{each}]" if each in "*?[" else each for each in name)


def _holds_something(path: Path) -> bool:
    if path.is_dir():
        return any(path.iterdir())
    return path.is_file() and path.stat().st_size > 0


# What drivers report, told in words for people: the place, what is wrong and what to do.

PATIENCE = 5.0  # seconds to wait for another writer, or for a server to answer

_SQLITE = (
    ("SQLITE_BUSY", f"is held by another program for more than {PATIENCE:g} s: close that program, then try again"),
    ("SQLITE_FULL", "cannot be written to, as the disk is full: make room, then try again"),
    ("SQLITE_READONLY", "cannot be written to: give this user the right to write to the file and to its folder"),
    ("SQLITE_CANTOPEN", "cannot be opened: see that the file and its folder are there, and may be read and written"),
    ("SQLITE_PERM", "cannot be opened: give this user the right to read and write the file"),
    ("SQLITE_NOTADB", "is not a database: name another file, or move this one away"),
    ("SQLITE_CORRUPT", "is damaged: move it away and put a copy in its place (docs/database.md)"),
    ("SQLITE_IOERR", "cannot be read or written, as the disk reports an error: see to the disk and the room on it"),
)
# By SQLSTATE, so that a station with a database of SQLite does not have to import the driver of PostgreSQL.
_POSTGRESQL = {
    "55P03": f"is kept from being written to for more than {PATIENCE:g} s by another program",  # lock_not_available
    "42501": "gives this user too few rights: let the user own the database",  # insufficient_privilege
    "53100": "cannot be written to, as its disk is full: make room, then try again",  # disk_full
    "25006": "cannot be written to: it is a copy that only reads",  # read_only_sql_transaction
}


def file_trouble(error: OSError, path: Path) -> str:
    """Say why the file or folder at `path` cannot be used, and what to do."""
    if error.errno == errno.EROFS or (error.errno in (errno.EACCES, errno.EPERM) and _only_reads(path)):
        return "its disk can only be read: have it mounted so that it can be written to, or name a place elsewhere"
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return "there is no room on its disk: make room, then try again"
    if error.errno in (errno.EACCES, errno.EPERM):
        return f"{_rights(path)}: give this user the right to read and write it, and to write to its folder"
    return str(error.strerror)


def _only_reads(path: Path) -> bool:
    found = _nearest(path)
    return found is not None and bool(os.statvfs(found).f_flag & os.ST_RDONLY)


def _nearest(path: Path) -> Path | None:
    """Return what there is of a path, as far as this user may know."""
    for each in (path, *path.parents):
        with contextlib.suppress(OSError):
            each.stat()
            return each
    return None


def _rights(path: Path) -> str:
    found = _nearest(path)
    if found is None:
        return f"it is not open to the user {_name(os.geteuid())}"
    status = found.stat()
    what = "it" if found == path else f"{found}"
    return (
        f"{what} belongs to {_name(status.st_uid)} ({stat.filemode(status.st_mode)}), and this is {_name(os.geteuid())}"
    )


def _name(user: int) -> str:
    try:
        return pwd.getpwuid(user).pw_name
    except KeyError:
        return f"the user {user}"


def storage_error(place: SqliteFile | PostgresqlServer, error: SQLAlchemyError) -> StorageError:
    """The same trouble for people."""
    cause = error.orig if isinstance(error, DBAPIError) else None
    if isinstance(cause, sqlite3.Error):
        of_disk = isinstance(place, SqliteFile) and _of_disk(cause, place.path)
        return StorageError(f"{place} {of_disk or _of_sqlite(cause)}")
    if cause is not None and isinstance(place, PostgresqlServer):
        return StorageError(f"{place} {_of_postgresql(cause)}")
    return StorageError(f"{place} cannot be used: {error}")


def _of_disk(cause: sqlite3.Error, path: Path) -> str | None:
    """Say what SQLite does not know: that nobody can write there."""
    name = getattr(cause, "sqlite_errorname", "")
    if name.startswith(("SQLITE_READONLY", "SQLITE_CANTOPEN", "SQLITE_IOERR", "SQLITE_PERM")) and _only_reads(path):
        return f"cannot be written to: {file_trouble(OSError(errno.EROFS, ''), path)}"
    return None


def _of_sqlite(cause: sqlite3.Error) -> str:
    name = getattr(cause, "sqlite_errorname", "")
    return next((words for start, words in _SQLITE if name.startswith(start)), f"cannot be used: {cause}")


def _of_postgresql(cause: BaseException) -> str:
    state: str | None = getattr(cause, "sqlstate", None)
    if state in _POSTGRESQL:
        return _POSTGRESQL[state]
    first = str(cause).strip().partition("\n")[0]
    if state is None:  # as of all that goes wrong before there is a connection
        return f"cannot be reached: {first.rpartition(' failed: ')[2].removeprefix('FATAL:').strip()}"
    return f"cannot be used: {first}"
