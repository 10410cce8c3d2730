"""Whether a backup is whole: each member as it was written, and the journal in the copy as the manifest says."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from sequence_planner.backup.archive import DATABASE, ChainEnd, Manifest, opened
from sequence_planner.backup.copies import verified_copy
from sequence_planner.backup.trouble import BackupError, Trouble
from sequence_planner.journal.chain import Position
from sequence_planner.journal.verification import Verified
from sequence_planner.storage.error import StorageError


def verify_backup(file: Path, scratch: str) -> Manifest:
    """Read all of a backup, unpacked to a folder beside it whose name begins with `scratch`. Raises `StorageError`.

    What `pg_dump` has written is read to its end; only a database that it is put into shows more, as `restore` looks.
    """
    with opened(file, file.absolute().parent, scratch) as (manifest, unpacked):
        try:
            verified = verified_copy(manifest.database, unpacked / DATABASE)
        except BackupError:
            raise
        except StorageError as error:
            raise BackupError(Trouble.NOT_WHOLE, f"the database in {file} cannot be read: {error}") from error
        if verified is not None and (wrong := [*not_as_told(verified, manifest)]):
            raise BackupError(Trouble.NOT_WHOLE, f"the journal in {file} is not whole: {'; '.join(wrong)}")
    return manifest


def not_as_told(verified: Verified, manifest: Manifest) -> Iterator[str]:
    """What is wrong with the journal of a copy, or other than the manifest says."""
    yield from verified.wrong
    for name, end, then in (("audit", verified.audit, manifest.audit), ("run", verified.run, manifest.run)):
        if not _is(end, then):
            yield f"the chain {name} ends with record {end.number}, and the backup says {then.number}"


def _is(end: Position, then: ChainEnd) -> bool:
    return (end.number, end.hash) == (then.number, then.hash)
