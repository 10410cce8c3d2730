"""A database that is empty where a station was: no new station begins in its place unless somebody says so."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Final

from sequence_planner.storage.address import PostgresqlServer, SqliteFile
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import state_folder

_MOST_NAMED: Final = 3


def left_of(place: SqliteFile | PostgresqlServer) -> list[Path]:
    """What a station with this database has left beside it: keys, last word, archive, backups, revisions of
    its model.
    """
    if isinstance(place, PostgresqlServer):
        mark = hashlib.sha256(str(place).encode()).hexdigest()[:8]
        return sorted(state_folder().glob(f"*-{mark}*")) if state_folder().is_dir() else []
    file = place.path
    if not file.parent.is_dir():
        return []
    beside = [each for each in file.parent.glob(f"{_literal(file.name)}-*") if each.suffix in (".pem", ".key")]
    beside += [each for name in ("-last-word", "-wal") if (each := Path(f"{file}{name}")).is_file()]
    folders = [file.with_name(f"{file.stem}.{name}") for name in ("revisions.git", "archive", "backups")]
    return sorted(each for each in [*beside, *folders] if _holds_something(each))


def require_meant(place: SqliteFile | PostgresqlServer) -> None:
    """Raises `StorageError` where a station was, of which the database holds nothing any more."""
    left = left_of(place)
    if left:
        named = ", ".join(str(each) for each in left[:_MOST_NAMED])
        more = f" and {len(left) - _MOST_NAMED} more" if len(left) > _MOST_NAMED else ""
        raise StorageError(
            f"{place} is empty or not there, but a station has left {named}{more}: put a backup of the database in its "
            "place (docs/database.md). If a new station is meant to begin here, start it with `run --new`"
        )


def _literal(name: str) -> str:
    """It as a pattern that is nothing but itself."""
    return "".join(f"[{each}]" if each in "*?[" else each for each in name)


def _holds_something(path: Path) -> bool:
    if path.is_dir():
        return any(path.iterdir())
    return path.is_file() and path.stat().st_size > 0
