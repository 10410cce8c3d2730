"""Fixtures: each test that asks for `database` or `database_url` runs on SQLite and on PostgreSQL."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from sequence_planner.db.database import Database
from support.postgresql import WHAT_TO_DO, Server, binaries, running_server


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
        return f"sqlite:///{tmp_path}/state/station.sqlite"
    server: Server = request.getfixturevalue("postgresql")
    return server.new_database()


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """An open database with all its tables."""
    opened = Database.open(database_url)
    opened.upgrade()
    yield opened
    opened.close()


@contextmanager
def journal() -> Iterator[Database]:
    """A database of its own, with all its tables."""
    with tempfile.TemporaryDirectory() as folder:
        database = Database.open(f"sqlite:///{Path(folder) / 'station.sqlite'}")
        database.upgrade()
        try:
            yield database
        finally:
            database.close()
