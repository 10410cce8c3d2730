"""Making a backup while the station runs."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from enum import StrEnum
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from sequence_planner.backup.archive import DATABASE, MODEL, REVISIONS, ChainEnd, Maker, Manifest, sums, write
from sequence_planner.backup.copies import copy, kind_of
from sequence_planner.backup.trouble import BackupError, Trouble, trouble_of
from sequence_planner.journal.chain import Position
from sequence_planner.storage.database import Database
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import revisions_folder
from sequence_planner.workshop.files import read_files, write_files

_UNFINISHED: Final = ("tmp", ".lock")  # how git's files begin or end that are being written


class Step(StrEnum):
    """How far the making of a backup has come."""

    COPYING = "copying"  # the database and what else belongs to it; the journal in the copy is verified
    WRITING = "writing"  # all of that to the one file
    CHECKING = "checking"  # what was written, by reading it again


def back_up(
    url: str,
    model: Path,
    file: Path,
    maker: Maker | None = None,
    tell: Callable[[Step], None] = lambda step: None,
) -> Manifest:
    """Write the backup of the station in the folder `model` to `file`. Raises `StorageError`.

    It says who the `maker` is. What cannot be restored is not kept: the journal is verified in the copy itself.
    """
    if file.exists():
        raise StorageError(f"{file} is there already: name another file")
    database = Database.open(url, create=False)
    try:
        database.check()
        with TemporaryDirectory(prefix=f".{file.stem}-", dir=file.absolute().parent) as gathered:
            folder = Path(gathered)
            tell(Step.COPYING)
            verified = copy(database, folder / DATABASE)
            if verified.wrong:
                raise BackupError(
                    Trouble.NOT_WHOLE,
                    f"{database.place} has a journal that is not whole: {'; '.join(verified.wrong)}",
                )
            _copy_revisions(revisions_folder(url, model), folder / REVISIONS)
            write_files(read_files(model), folder / MODEL, stages=model)
            manifest = Manifest(
                format=1,
                program=metadata.version("sequence-planner"),
                time=time.time(),
                station=model.resolve().name,
                maker=maker,
                database=kind_of(url),
                audit=_end(verified.audit),
                run=_end(verified.run),
                files=sums(folder),
            )
            tell(Step.WRITING)
            write(folder, manifest, file)
    except OSError as error:
        raise trouble_of(error, file.parent) from error
    finally:
        database.close()
    return manifest


def _end(position: Position) -> ChainEnd:
    return ChainEnd(number=position.number, hash=position.hash)


def _copy_revisions(repository: Path, to: Path) -> None:
    """What is told first is copied first: what it names is there by then, whatever is saved meanwhile."""
    if not (repository / "HEAD").exists():
        return
    for file in (*_finished(repository, objects=False), *_finished(repository, objects=True)):
        target = to / file.relative_to(repository)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, target)


def _finished(repository: Path, objects: bool) -> Iterator[Path]:
    for file in sorted(repository.rglob("*")):
        unfinished = file.name.startswith(_UNFINISHED[0]) or file.name.endswith(_UNFINISHED[1])
        if file.is_file() and not unfinished and ("objects" in file.relative_to(repository).parts) is objects:
            yield file
