"""A journal for a controller that a test runs by itself."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sequence_planner.db.database import Database


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
