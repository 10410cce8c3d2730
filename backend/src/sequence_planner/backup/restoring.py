"""Putting a backup in place where nothing is yet."""

from __future__ import annotations

import contextlib
import shutil
import time
from pathlib import Path

from pydantic import JsonValue
from sqlalchemy import delete

from sequence_planner.actor import Actor
from sequence_planner.backup.archive import DATABASE, MODEL, REVISIONS, Manifest, opened
from sequence_planner.backup.copies import kind_of, put, require_empty
from sequence_planner.backup.whole import not_as_told
from sequence_planner.identity.tables import FIRST_START_LINKS, PAIRING_OFFERS, SESSIONS
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry
from sequence_planner.journal.verification import Verified
from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import revisions_folder
from sequence_planner.workshop.files import put_in_place, read_files, write_files


def restore(file: Path, url: str, model: Path, by: Actor) -> Manifest:
    """Put the backup in `file` to the database at `url` and the model to the folder `model`. Raises `StorageError`.

    A folder that holds the same model already is left as it is. Everybody has to sign in again.
    """
    revisions = revisions_folder(url, model)
    require_empty(url)
    if revisions.exists() and any(revisions.iterdir()):
        raise StorageError(f"{revisions} holds revisions already: move the folder away, or name another database")
    with opened(file, revisions.parent) as (manifest, unpacked):
        if manifest.database != kind_of(url):
            raise StorageError(f"{file} is of {manifest.database}, and can be restored to such a database only")
        _require_same_model(unpacked / MODEL, model)
        _require_whole(put(url, unpacked / DATABASE), manifest)
        _sign_out(url, file, manifest, by)
        if (unpacked / REVISIONS).is_dir():
            shutil.copytree(unpacked / REVISIONS, revisions, dirs_exist_ok=True)
            for each in ("refs/heads", "refs/tags", "objects/info", "objects/pack"):  # folders that may be empty
                (revisions / each).mkdir(parents=True, exist_ok=True)
            revisions.chmod(0o700)
        if not read_files(model):
            write_files({}, model, stages=unpacked / MODEL)
            put_in_place(read_files(unpacked / MODEL), model)
    return manifest


def _require_same_model(kept: Path, model: Path) -> None:
    there = read_files(model)
    if there and there != read_files(kept):
        raise StorageError(
            f"{model} holds another model than the backup: name a folder that is not there yet, or move that away"
        )


def _require_whole(verified: Verified, manifest: Manifest) -> None:
    if wrong := [*not_as_told(verified, manifest)]:
        raise StorageError(f"the journal is not whole, and nothing may be run on what was restored: {'; '.join(wrong)}")


def _sign_out(url: str, file: Path, manifest: Manifest, by: Actor) -> None:
    """Sessions that have ended since must not go on; and what was done here is recorded."""
    with contextlib.closing(Database.open(url, create=False)) as database, database.writing() as connection:
        for table in (SESSIONS, FIRST_START_LINKS, PAIRING_OFFERS):
            connection.execute(delete(table))
        details: dict[str, JsonValue] = {
            "file": file.name,
            "made": manifest.time,
            "audit": manifest.audit.number,
            "run": manifest.run.number,
        }
        append(connection, Entry(actor=by, action="backup-restored", subject="station", details=details), time.time())
