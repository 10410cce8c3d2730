"""What drivers report, told in words for people: the place, what is wrong and what to do."""

from __future__ import annotations

import sqlite3

from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from sequence_planner.storage.address import PostgresqlServer, SqliteFile
from sequence_planner.storage.error import StorageError

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


def storage_error(place: SqliteFile | PostgresqlServer, error: SQLAlchemyError) -> StorageError:
    """The same trouble for people."""
    cause = error.orig if isinstance(error, DBAPIError) else None
    if isinstance(cause, sqlite3.Error):
        return StorageError(f"{place} {_of_sqlite(cause)}")
    if cause is not None and isinstance(place, PostgresqlServer):
        return StorageError(f"{place} {_of_postgresql(cause)}")
    return StorageError(f"{place} cannot be used: {error}")


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
