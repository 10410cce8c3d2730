"""The database of these tests is SQLite; those that are `BOTH` run on PostgreSQL, too."""

from __future__ import annotations

from pathlib import Path

import pytest

from support.postgresql import Server


@pytest.fixture
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The URL of an empty database."""
    if getattr(request, "param", "sqlite") == "sqlite":
        return f"sqlite:///{tmp_path}/state/station.sqlite"
    server: Server = request.getfixturevalue("postgresql")
    return server.new_database()
