"""Tables that are not of the newest version, brought there by alembic's migrations, which are part of this package.

Imported only where that is so: it takes alembic, and a controller that starts again has no time for it.
"""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Final

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, inspect

from sequence_planner.core.storage_error import StorageError

_MIGRATIONS: Final = Path(__file__).parent / "migrations"
_ONE_AT_A_TIME: Final = threading.Lock()  # alembic keeps what it works on in a module


def upgrade(connection: Connection, place: str) -> None:
    """Bring the tables to the newest version, within the transaction of the only writer. Raises `StorageError`."""
    config = _config()
    found = _found(connection, ScriptDirectory.from_config(config), place)
    if found is None and inspect(connection).get_table_names():
        raise StorageError(f"{place} holds the tables of another program: name an empty database")
    config.attributes["connection"] = connection
    with _ONE_AT_A_TIME:
        command.upgrade(config, "head")


def check(connection: Connection, place: str) -> None:
    """Raises `StorageError` unless the tables are of the newest version."""
    scripts = ScriptDirectory.from_config(_config())
    found = _found(connection, scripts, place)
    if found is None:
        raise StorageError(f"{place} has no tables yet: start the station once")
    if found != scripts.get_current_head():
        raise StorageError(f"{place} was written by an older version: start the station once to bring it up to date")


def _found(connection: Connection, scripts: ScriptDirectory, place: str) -> str | None:
    """The version of the tables; None for a database without any. Raises `StorageError` for an unknown one."""
    found = MigrationContext.configure(connection).get_current_revision()
    if found is not None and found not in {script.revision for script in scripts.walk_revisions()}:
        raise StorageError(
            f"{place} was written by a newer version of Sequence Planner, or by another program: install that version, "
            "or name another database"
        )
    return found


def _config() -> Config:
    config = Config()
    config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    return config
