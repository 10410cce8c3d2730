"""Fixtures: each test that asks for `database` or `database_url` runs on SQLite and on PostgreSQL."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from functools import cache
from pathlib import Path

import pytest

from sequence_planner.db.database import Database
from support.postgresql import WHAT_TO_DO, Server, binaries, running_server

SQLITE = "sqlite:///"


@cache
def _kept() -> Path:
    """A database with all its tables, made by the migrations."""
    folder = Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    with closing(Database.open(f"{SQLITE}{folder}/tables.sqlite")) as database:
        database.upgrade()
    return folder / "tables.sqlite"


def with_tables(file: Path) -> str:
    """Return the URL of a new SQLite database in `file`. It has all its tables: to make them takes twenty times as long
    as to copy them.
    """
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    shutil.copy(_kept(), file)
    return f"{SQLITE}{file}"


@pytest.fixture(scope="session")
def postgresql() -> Iterator[Server]:
    """A server for all tests of this run."""
    programs = binaries()
    if programs is None:
        pytest.skip(WHAT_TO_DO)
    with running_server(programs) as server:
        yield server


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The URL of an empty database."""
    if request.param == "sqlite":
        return f"{SQLITE}{tmp_path}/state/station.sqlite"
    server: Server = request.getfixturevalue("postgresql")
    return server.new_database()


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """An open database with all its tables."""
    if database_url.startswith(SQLITE):
        with_tables(Path(database_url.removeprefix(SQLITE)))
    opened = Database.open(database_url)
    opened.upgrade()
    yield opened
    opened.close()


@contextmanager
def journal() -> Iterator[Database]:
    """A database of its own, with all its tables."""
    with tempfile.TemporaryDirectory() as folder:
        database = Database.open(with_tables(Path(folder) / "station.sqlite"))
        try:
            yield database
        finally:
            database.close()
