"""The tables' versions."""

from __future__ import annotations

import importlib
import pkgutil
import subprocess
import sys

import pytest
from alembic.autogenerate import compare_metadata
from alembic.runtime.migration import MigrationContext
from sqlalchemy import text

from sequence_planner import auth, editor, journal, mes, standby
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.metadata import METADATA
from sequence_planner.db.upgrade import NEWEST
from sequence_planner.editor import talk
from sequence_planner.mes import webhooks
from support.postgresql import PASSWORD

UPGRADE = """
import sys
from sequence_planner.db.database import Database
print("ready", flush=True)
sys.stdin.readline()
database = Database.open(sys.argv[1])
database.upgrade()
database.check()
"""


def test_the_migrations_make_the_tables_that_the_program_declares(database: Database) -> None:
    rooms = (auth, journal, mes, webhooks, standby, editor, talk)
    for package in rooms:
        for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    assert {"audit", "people", "keys", "watches", "draft_files", "job_orders", "command_lease"} <= set(METADATA.tables)
    with database.reading() as connection:
        assert compare_metadata(MigrationContext.configure(connection), METADATA) == []


def test_tables_of_the_newest_version_need_no_migrations(database_url: str, database: Database) -> None:
    with database.reading() as connection:
        assert MigrationContext.configure(connection).get_current_heads() == (NEWEST,)
    asked = "import sys; from sequence_planner.db.database import Database; Database.open(sys.argv[1]).upgrade()"
    code = f"{asked}; print('alembic' in sys.modules)"
    said = subprocess.run([sys.executable, "-c", code, database_url], capture_output=True, text=True, check=True).stdout
    assert said.strip() == "False"


def test_upgrading_again_changes_nothing(database: Database) -> None:
    with database.writing() as connection:
        connection.execute(text("INSERT INTO first_start_links (token_hash, expires) VALUES ('a', 1)"))
    database.upgrade()
    database.check()
    with database.reading() as connection:
        assert connection.execute(text("SELECT count(*) FROM first_start_links")).scalar_one() == 1


def test_several_processes_upgrade_at_once(database_url: str) -> None:
    started = [
        subprocess.Popen(
            [sys.executable, "-c", UPGRADE, database_url], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        for _ in range(3)
    ]
    for process in started:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    for process in started:
        assert process.stdin is not None
        process.stdin.write("go\n")
        process.stdin.flush()
    for process in started:
        process.communicate(timeout=60)
    assert [process.returncode for process in started] == [0, 0, 0]


def test_a_database_of_a_newer_version_is_refused(database: Database) -> None:
    with database.writing() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    for step in (database.upgrade, database.check):
        with pytest.raises(StorageError, match="was written by a newer version of Sequence Planner") as refusal:
            step()
        assert str(database.place) in str(refusal.value)
        assert PASSWORD not in str(refusal.value)


def test_a_database_of_another_program_is_refused(database_url: str) -> None:
    database = Database.open(database_url)
    with database.writing() as connection:
        connection.execute(text("CREATE TABLE bookmarks (id INTEGER PRIMARY KEY)"))
    with pytest.raises(StorageError, match="holds the tables of another program: name an empty database"):
        database.upgrade()
    database.close()


def test_a_database_without_tables_is_not_read(database_url: str) -> None:
    database = Database.open(database_url)
    with pytest.raises(StorageError, match="has no tables yet: start the station once"):
        database.check()
    database.close()
