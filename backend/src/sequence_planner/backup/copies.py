"""Copies of a database that are of one moment, while others write to it; and putting such a copy in place."""

from __future__ import annotations

import contextlib
import os
import sqlite3
from pathlib import Path
from typing import Final, Literal, TypeAlias
from urllib.parse import quote

from sqlalchemy import Connection, inspect, text

from sequence_planner.backup.postgresql_programs import read_through, run
from sequence_planner.backup.trouble import BackupError, Trouble, no_space
from sequence_planner.journal.verification import Verified, verify
from sequence_planner.storage.address import SqliteFile, address
from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError

Kind: TypeAlias = Literal["sqlite", "postgresql"]
_BESIDE: Final = ("-wal", "-shm", "-journal")  # what SQLite keeps beside a file that is in use
_OTHERS: Final = text(
    "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND pid <> pg_backend_pid()"
)


def kind_of(url: str) -> Kind:
    """Which of the two a URL names. Raises `StorageError`."""
    return "sqlite" if isinstance(address(url), SqliteFile) else "postgresql"


def copy(database: Database, to: Path) -> Verified:
    """Copy a database to a file, and verify the journal as it is in the copy. Raises `StorageError`."""
    place = database.place
    if isinstance(place, SqliteFile):
        _copy_file(place, to)
        return _verified(to)
    with database.reading() as connection:  # sees one moment, and pg_dump the same one
        snapshot: str = connection.execute(text("SELECT pg_export_snapshot()")).scalar_one()
        options = ("--format=custom", "--no-owner", "--no-privileges", f"--snapshot={snapshot}", f"--file={to}")
        run("pg_dump", place, *options)
        return verify(connection)


def require_empty(url: str) -> None:
    """Raises `StorageError` unless there is nothing yet where a copy is to be put, and nobody is at it."""
    place = address(url)
    if not isinstance(place, SqliteFile):
        with contextlib.closing(Database.open(url)) as database, database.reading() as connection:
            _require_nobody(connection, str(place))
        return
    if place.path.exists():
        raise StorageError(
            f"{place} is there already, and a station may be running on it: stop the station and move the file away "
            "with those beside it, or name another database"
        )
    for left in (place.path.with_name(place.path.name + ending) for ending in _BESIDE):
        if left.exists():
            raise StorageError(
                f"{left} is left of another database, and a station may be running on it: stop the station and move "
                "this file away too"
            )


def put(url: str, copied: Path) -> Verified:
    """Put a copy where a URL names, where nothing is yet, and verify the journal there. Raises `StorageError`.

    A file of SQLite is verified before it is put in place, and on the same disk already.
    """
    place = address(url)
    if not isinstance(place, SqliteFile):
        run(
            "pg_restore", place, "--no-owner", "--no-privileges", "--exit-on-error", "--single-transaction", str(copied)
        )
        return _verified_at(url)
    verified = _verified(copied)
    if not verified.wrong:
        try:
            os.link(copied, place.path)  # which takes no other file's place
        except OSError as error:
            raise StorageError(f"{place} cannot be written: {error.strerror}") from error
    return verified


def verified_copy(kind: Kind, copied: Path) -> Verified | None:
    """The journal of a copy that is in no place yet; None where only a server reads it. Raises `StorageError`."""
    if kind == "sqlite":
        return _verified(copied)
    read_through(copied)
    return None


def _require_nobody(connection: Connection, place: str) -> None:
    if inspect(connection).get_table_names():
        raise StorageError(
            f"{place} is not empty, and a station may be running on it: stop the station, and name an empty database"
        )
    if connection.execute(_OTHERS).scalar_one():
        raise StorageError(f"{place} is in use by somebody else: end what uses it, then try again")


def _copy_file(file: SqliteFile, to: Path) -> None:
    """All pages in one step, so that no writer makes it begin anew; no writer waits for it."""
    try:
        with (
            contextlib.closing(sqlite3.connect(f"{file.path.as_uri()}?mode=rw", uri=True)) as source,
            contextlib.closing(sqlite3.connect(to)) as target,
        ):
            source.backup(target)
            (found,) = target.execute("PRAGMA integrity_check").fetchone()
    except sqlite3.Error as error:
        if error.sqlite_errorcode & 0xFF == sqlite3.SQLITE_FULL:
            raise no_space(to.parent, str(error)) from error
        raise StorageError(f"{file} cannot be copied: {error}") from error
    if found != "ok":
        raise BackupError(Trouble.NOT_WHOLE, f"{file} is damaged: {found}")


def _verified(file: Path) -> Verified:
    return _verified_at(f"sqlite:///{quote(str(file.absolute()))}")


def _verified_at(url: str) -> Verified:
    """The journal of a copy, whose tables are brought up to date first."""
    with contextlib.closing(Database.open(url, create=False)) as database:
        database.upgrade()
        with database.reading() as connection:
            return verify(connection)
