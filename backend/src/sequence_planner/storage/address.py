"""Where a database is, as its URL says."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from sequence_planner.storage.error import StorageError

if TYPE_CHECKING:  # importing it takes longer than all else that many a command does, and few of them have a database
    from sqlalchemy import URL

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
    """What a URL names. Raises `StorageError`, which never quotes the URL, as it may hold a password."""
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
