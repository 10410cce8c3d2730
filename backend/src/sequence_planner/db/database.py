"""The station's database: SQLite beside the station, or PostgreSQL."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection, Engine, event, text
from sqlalchemy.exc import (
    DataError,
    DBAPIError,
    IntegrityError,
    ProgrammingError,
    SQLAlchemyError,
    TimeoutError,
)

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db import postgresql, sqlite, upgrade
from sequence_planner.db.errors import PATIENCE, require_meant, storage_error
from sequence_planner.db.location import PostgresqlServer, SqliteFile, address

_OF_THE_DATABASE = (DBAPIError, TimeoutError)
_OF_THE_CALLER = (IntegrityError, ProgrammingError, DataError)  # says something about a statement, not the database


class Database:
    """Connections to one database, for any number of threads; other processes may use it at the same time.

    What goes wrong with the database, also within a block, is raised as `StorageError`; an `IntegrityError` and what
    else a statement is to blame for stays what it is.
    """

    def __init__(self, place: SqliteFile | PostgresqlServer, engine: Engine) -> None:
        self.place = place
        self._engine = engine
        self._writer = threading.Lock()  # writers of one process take turns here, which is quicker than trying again

    @classmethod
    def open(cls, url: str, *, create: bool = True, new: bool = False) -> Database:
        """The database that a URL names: `sqlite:////folder/file` or `postgresql://user:password@host/database`.

        A file of SQLite that is not there yet is made, as is its folder, for this user alone; without `create` it must
        be there. Raises `StorageError` for a URL that names nothing usable, if nothing can be reached there, and for an
        empty database where a station was, unless a `new` one is meant.
        """
        place = address(url)
        database = cls(
            place, sqlite.engine(place, create, new) if isinstance(place, SqliteFile) else postgresql.engine(place)
        )
        try:
            with database._told(everything=True), database.reading() as connection:
                if isinstance(place, PostgresqlServer):
                    postgresql.require_unicode(connection, place)
        except StorageError:
            database.close()
            raise
        return database

    @property
    def is_empty(self) -> bool:
        """True if there are no tables yet."""
        with self._told(everything=True), self.reading() as connection:
            return upgrade.is_empty(connection)

    def upgrade(self, *, new: bool = False) -> None:
        """Bring the tables to what this version of the program uses; several processes may do so at once.

        Raises `StorageError` for a database of a newer version, or of another program, and for one without tables where
        a station was, unless a `new` one is meant.
        """
        with self._told(everything=True), self.writing() as connection:
            if not new and upgrade.is_empty(connection):
                require_meant(self.place)
            upgrade.upgrade(connection, str(self.place))

    def check(self) -> None:
        """Raises `StorageError` unless the tables are those that this version of the program uses."""
        with self._told(everything=True), self.reading() as connection:
            upgrade.check(connection, str(self.place))

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A connection that sees one moment of the database and cannot write."""
        with self._told(), self._engine.connect() as connection:
            options = postgresql.READING if isinstance(self.place, PostgresqlServer) else sqlite.READING
            with connection.execution_options(**options).begin():
                yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A connection that writes, one at a time over all processes, for which it waits up to 5 s.

        What was written is durable when the block ends, and is gone when it raises. Keep the block short: others wait.
        """
        if not self._writer.acquire(timeout=PATIENCE):
            raise StorageError(f"{self.place} is being written to for more than {PATIENCE:g} s: try again")
        try:
            with self._told(), self._engine.connect() as connection, connection.begin():
                if isinstance(self.place, PostgresqlServer):
                    postgresql.become_the_writer(connection)
                yield connection
        finally:
            self._writer.release()

    def try_writing(self) -> None:
        """Write something that changes nothing; it is durable when this returns. Raises `StorageError`."""
        with self._told(everything=True), self.writing() as connection:
            connection.execute(text("UPDATE alembic_version SET version_num = version_num"))

    def close(self) -> None:
        """End all connections; one that is in use ends when it is given back."""
        pool = self._engine.pool
        self._engine.dispose()
        # It comes back to a pool that nobody has any more, and would stay open until it is collected.
        event.listen(pool, "checkin", lambda _, record: record.invalidate())
        pool.dispose()

    @contextmanager
    def _told(self, *, everything: bool = False) -> Iterator[None]:
        try:
            yield
        except SQLAlchemyError as error:
            if everything or (isinstance(error, _OF_THE_DATABASE) and not isinstance(error, _OF_THE_CALLER)):
                raise storage_error(self.place, error) from error
            raise
