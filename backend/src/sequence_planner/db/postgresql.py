"""The way PostgreSQL is used: as SQLite is, one writer at a time."""

from __future__ import annotations

from typing import Final

from sqlalchemy import Connection, Engine, create_engine, text

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.errors import PATIENCE
from sequence_planner.db.location import PostgresqlServer

READING: Final = {"isolation_level": "REPEATABLE READ", "postgresql_readonly": True}  # execution options
LONGEST_STANDSTILL: Final = 2 * PATIENCE  # seconds for which a writer may say nothing in the middle of its turn
_WRITER: Final = 0x53514E504C414E  # the number of the lock that the writer holds

# Waiting for the lock must not fix what the writer sees, so the isolation is the one that looks anew per statement.
_ISOLATION: Final = "READ COMMITTED"


# Of libpq; the latter notice within seconds that a server has vanished without a word.
_SETTINGS: Final = {
    "client_encoding": "utf8",
    "connect_timeout": int(PATIENCE),
    "tcp_user_timeout": int(PATIENCE * 1000),
    "keepalives_idle": int(PATIENCE),
    "keepalives_interval": 1,
    "keepalives_count": 2,
}


def engine(server: PostgresqlServer) -> Engine:
    """Connections to a server; those that have broken are replaced."""
    return create_engine(
        server.url,
        connect_args=_SETTINGS,
        isolation_level=_ISOLATION,
        pool_pre_ping=True,
        pool_timeout=PATIENCE,
        hide_parameters=True,
    )


def require_unicode(connection: Connection, server: PostgresqlServer) -> None:
    """Raises `StorageError` for a database that could not keep every name."""
    encoding = connection.execute(text("SHOW server_encoding")).scalar_one()
    if encoding != "UTF8":
        raise StorageError(f"{server} keeps text as {encoding}: make one with createdb --encoding=UTF8")


def become_the_writer(connection: Connection) -> None:
    """Wait until nobody else writes, till the end of this transaction, which is durable when it has ended.

    A writer that stands still, or whose machine has vanished, loses its turn: others write then, and not hours later.
    """
    connection.execute(text(f"SET LOCAL lock_timeout = {int(PATIENCE * 1000)}"))
    connection.execute(text(f"SET LOCAL idle_in_transaction_session_timeout = {int(LONGEST_STANDSTILL * 1000)}"))
    connection.execute(
        text("SELECT set_config('synchronous_commit', 'on', true) WHERE current_setting('synchronous_commit') = 'off'")
    )
    connection.execute(text("SELECT pg_advisory_xact_lock(:writer)"), {"writer": _WRITER})
