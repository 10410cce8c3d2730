"""The way SQLite is used: durable, several processes at once, and files for this user alone."""

from __future__ import annotations

import contextlib
import errno
import os
import sqlite3
import stat
import time
from typing import Final

from sqlalchemy import Connection, Engine, QueuePool, create_engine, event
from sqlalchemy.exc import OperationalError

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.errors import PATIENCE, file_trouble, require_meant
from sequence_planner.db.location import SqliteFile

READING: Final = {"sequence_planner_reading": True}  # execution options of a connection
_HEADER: Final = 100  # bytes
_LAST: Final = "sequence_planner_last_read"  # what a connection was last used for, in its `info`


def engine(file: SqliteFile, create: bool, new: bool) -> Engine:
    """Connections to a file, which is made if it is not there; where a station was, only a `new` one is meant by that.

    Raises `StorageError`.
    """
    if not new and _is_empty(file):
        require_meant(file)
    if create:
        _make_folder(file)
    _make(file, create)
    made = create_engine(
        "sqlite://",
        creator=lambda: _connect(file),
        poolclass=QueuePool,
        pool_timeout=PATIENCE,
        hide_parameters=True,
    )
    identity = _identity(file)
    event.listen(made, "begin", lambda connection: _begin(connection, file, identity))
    return made


def _is_empty(file: SqliteFile) -> bool:
    """Check whether it is not there, or too short for what a database begins with: SQLite takes a byte for nothing."""
    try:
        return file.path.stat().st_size < _HEADER and not file.path.is_dir()
    except FileNotFoundError:
        return True
    except OSError:
        return False  # which is said when it is opened


def _make_folder(file: SqliteFile) -> None:
    """Its folder, for this user alone; one that is there already stays as it is. Raises `StorageError`."""
    try:
        file.path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise StorageError(
            f"the folder {file.path.parent} cannot be made: {file_trouble(error, file.path.parent)}"
        ) from error


def _make(file: SqliteFile, create: bool) -> None:
    """The file, for this user alone, as SQLite then makes the files beside it. Raises `StorageError`.

    One that is there is not opened: to close it would take the locks of all connections that this process has to it,
    and another process could remove its log (sqlite.org/howtocorrupt.html, 2.2).
    """
    try:
        if create:
            with contextlib.suppress(FileExistsError):
                os.close(os.open(file.path, os.O_RDWR | os.O_CLOEXEC | os.O_CREAT | os.O_EXCL, 0o600))
        found = file.path.stat()
        if stat.S_ISDIR(found.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if found.st_uid == os.geteuid() and stat.S_IMODE(found.st_mode) & 0o077:
            file.path.chmod(0o600)
        if not os.access(file.path, os.R_OK | os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except FileNotFoundError as error:
        raise StorageError(f"{file} is not there: no station has kept its database there yet") from error
    except OSError as error:
        raise StorageError(f"{file} cannot be opened: {file_trouble(error, file.path)}") from error


def _connect(file: SqliteFile) -> sqlite3.Connection:
    """A connection that begins no transactions by itself (`_begin` does), and never makes the file again."""
    connection = sqlite3.connect(
        f"{file.path.as_uri()}?mode=rw", uri=True, timeout=PATIENCE, isolation_level=None, check_same_thread=False
    )
    try:
        _write_ahead(connection, file)
        _require_whole_pages(connection, file)
        for setting in ("synchronous = FULL", "foreign_keys = ON", "trusted_schema = OFF"):
            connection.execute(f"PRAGMA {setting}").close()
    except (sqlite3.Error, StorageError):
        connection.close()
        raise
    return connection


def _require_whole_pages(connection: sqlite3.Connection, file: SqliteFile) -> None:
    """Raises `StorageError` where a part of the last page is missing, which SQLite takes for zeros. Where more is
    missing it says so itself.
    """
    log = file.path.with_name(f"{file.path.name}-wal")
    (page,) = connection.execute("PRAGMA page_size").fetchone()
    if file.path.stat().st_size % page and not (log.exists() and log.stat().st_size):
        raise StorageError(f"{file} is damaged, as its end is missing: move it away and put a copy in its place")


def _write_ahead(connection: sqlite3.Connection, file: SqliteFile) -> None:
    """Turn on the log with which readers and the writer do not wait for each other; the file remembers it."""
    until = time.monotonic() + PATIENCE
    while True:
        try:
            (mode,) = connection.execute("PRAGMA journal_mode = WAL").fetchone()
        except sqlite3.OperationalError as error:
            # Of several that turn it on at once, SQLite refuses some without waiting.
            if error.sqlite_errorcode != sqlite3.SQLITE_BUSY or time.monotonic() > until:
                raise
            time.sleep(0.01)
            continue
        if mode != "wal":
            raise StorageError(f"{file} is where SQLite cannot keep a write-ahead log: name a file on a local disk")
        return


def _identity(file: SqliteFile) -> tuple[int, int] | None:
    """Return what tells the file from another one of its name; None if there is none."""
    try:
        found = file.path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


def _begin(connection: Connection, file: SqliteFile, identity: tuple[int, int] | None) -> None:
    """A reader sees the moment of its first look; a writer waits for its turn before it looks.

    What is written to a file that has no name any more would be gone unnoticed. Raises `StorageError` there.
    """
    if _identity(file) != identity:
        raise StorageError(f"{file} was removed or replaced while it was in use: start the station again")
    reading = bool(connection.get_execution_options().get("sequence_planner_reading"))
    if connection.info.get(_LAST) is not reading:
        # A writer has nothing to wait for behind its turn, for which it waits by itself.
        connection.exec_driver_sql(f"PRAGMA query_only = {'ON' if reading else 'OFF'}")
        connection.exec_driver_sql(f"PRAGMA busy_timeout = {int(PATIENCE * 1000) if reading else 0}")
        connection.info[_LAST] = reading
    if reading:
        connection.exec_driver_sql("BEGIN")
    else:
        _become_the_writer(connection)


def _become_the_writer(connection: Connection) -> None:
    """Wait for the turn to write, looking every millisecond.

    SQLite by itself looks ever more seldom, down to ten times a second, and is then kept out by whoever writes a lot.
    """
    until = time.monotonic() + PATIENCE
    while True:
        try:
            connection.exec_driver_sql("BEGIN IMMEDIATE")
        except OperationalError as error:
            code = getattr(error.orig, "sqlite_errorcode", 0)
            # The last eight bits are the kind of error: also while another process restores the log, it is busy.
            if code & 0xFF != sqlite3.SQLITE_BUSY or time.monotonic() > until:
                raise
            time.sleep(0.001)
        else:
            return
