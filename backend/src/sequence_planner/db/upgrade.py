"""The tables' versions. Those of the newest are seen to be so at once."""

from __future__ import annotations

from typing import Final

from sqlalchemy import Connection, inspect, text

NEWEST: Final = "0012"
"""The revision of the newest of `migrations`."""


def upgrade(connection: Connection, place: str) -> None:
    """Bring the tables to the newest version, within the transaction of the only writer. Raises `StorageError`."""
    if not _is_newest(connection):
        from sequence_planner.db import migrate as migrating  # noqa: PLC0415 - see there

        migrating.upgrade(connection, place)


def check(connection: Connection, place: str) -> None:
    """Raises `StorageError` unless the tables are of the newest version."""
    if not _is_newest(connection):
        from sequence_planner.db import migrate as migrating  # noqa: PLC0415

        migrating.check(connection, place)


def is_empty(connection: Connection) -> bool:
    """Return whether there are no tables at all."""
    return not inspect(connection).get_table_names()


def _is_newest(connection: Connection) -> bool:
    if not inspect(connection).has_table("alembic_version"):
        return False
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalars().all() == [NEWEST]
