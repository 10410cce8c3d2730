"""How a backup is put in place of what there is, in commands to be typed while the station is stopped."""

from __future__ import annotations

import sys
from pathlib import Path
from shlex import quote

from pydantic import BaseModel
from sqlalchemy import URL

from sequence_planner.storage.address import SqliteFile, address
from sequence_planner.storage.location import revisions_folder

_BESIDE = ("-wal", "-shm")  # what SQLite leaves where a station did not end in good order


class RestoreInstructions(BaseModel):
    """Commands: the first moves away what there is, keys excepted; the second puts the backup in its place."""

    away: str
    restore: str


def instructions(file: Path, url: str, model: Path) -> RestoreInstructions:
    """The commands for the station in the folder `model`, without any password. Raises `StorageError`."""
    place, revisions = address(url), revisions_folder(url, model)
    sequence_planner = Path(sys.executable).with_name("sequence-planner")
    program = str(sequence_planner) if sequence_planner.exists() else sequence_planner.name
    if isinstance(place, SqliteFile):
        files = [place.path, *(place.path.with_name(f"{place.path.name}{each}") for each in _BESIDE), revisions]
        away, named = _moved(files), url
    else:
        database = place.url.database or ""
        bare = _without_password(place.url)
        renamed = f'"{database}" RENAME TO "{database}_before_'
        server = quote(_text(bare.set(database="postgres")))
        alter = f"'ALTER DATABASE {renamed}'$now'\"'"  # the shell is to put the time in, and nothing else
        away = (
            f"{_moved([revisions])} && psql --dbname={server} --command={alter} && "
            f"createdb --maintenance-db={server} --encoding=UTF8 --template=template0 {quote(database)}"
        )
        named = _text(bare)
    words = (program, "restore", str(file), str(model.resolve()), "--database", named)
    return RestoreInstructions(away=away, restore=" ".join(map(quote, words)))


def _moved(files: list[Path]) -> str:
    """What is there of these gets other names. The keys that no backup has stay where they are."""
    each = " ".join(quote(str(file)) for file in files)
    return (
        f'now=$(date +%Y%m%d_%H%M%S); for each in {each}; do [ ! -e "$each" ] || mv "$each" "$each.before_$now"; done'
    )


def _without_password(url: URL) -> URL:
    return URL.create("postgresql", url.username, None, url.host, url.port, url.database, url.query)


def _text(url: URL) -> str:
    return url.render_as_string(hide_password=False)  # it has none any more
