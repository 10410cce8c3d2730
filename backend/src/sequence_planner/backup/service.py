"""Backup service: create, check, list and restore backups, with the worker process and journal entries."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from importlib import metadata
from pathlib import Path
from shlex import quote
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Final

from pydantic import BaseModel, JsonValue
from sqlalchemy import URL, Connection, delete

from sequence_planner.auth.tables import FIRST_START_LINKS, PAIRING_OFFERS, SESSIONS
from sequence_planner.backup.archive import (
    DATABASE,
    MODEL,
    REVISIONS,
    ChainEnd,
    Maker,
    Manifest,
    copy,
    kind_of,
    manifest_of,
    not_as_told,
    opened,
    program,
    put,
    require_empty,
    sums,
    verify_backup,
    write,
)
from sequence_planner.backup.errors import BackupError, Trouble, no_folder, no_space, not_writable, trouble_of
from sequence_planner.backup.settings import Keeping
from sequence_planner.core.actor import Actor
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import SqliteFile, address, backups_folder, mark_of, revisions_folder
from sequence_planner.journal import audit
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry, Outcome, Record
from sequence_planner.journal.hash_chain import ChainPosition
from sequence_planner.journal.verify import Verified
from sequence_planner.model.files import put_in_place, read_files, write_files
from sequence_planner.process.task import BackgroundTask, WorkerError

# How a backup is put in place of what there is, in commands to be typed while the station is stopped.

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
    """Return a command that gives other names to what is there of these. The keys that no backup has stay where they
    are.
    """
    each = " ".join(quote(str(file)) for file in files)
    return (
        f'now=$(date +%Y%m%d_%H%M%S); for each in {each}; do [ ! -e "$each" ] || mv "$each" "$each.before_$now"; done'
    )


def _without_password(url: URL) -> URL:
    return URL.create("postgresql", url.username, None, url.host, url.port, url.database, url.query)


def _text(url: URL) -> str:
    return url.render_as_string(hide_password=False)  # it has none any more


# Where a station's backups are kept, how many, and which there are.
#
# A folder that somebody has named must be there: one that is not may be a disk that is not mounted, and nobody would
# look for what is written in its place. Only what the station has named itself is ever removed: what other stations or
# people have put beside it stays.

ENDING: Final = ".tar"
_AT_ONCE: Final = 2  # copies on the disk while one is made: what was gathered, and the file that it goes to


class Kept(BaseModel):
    """A file in the folder. `manifest` says what is in it; None, and `wrong` why, where it cannot be read."""

    file: str
    size: int
    manifest: Manifest | None
    wrong: str | None


@dataclass(frozen=True)
class BackupFolderState:
    """The folder as it is now: the newest backups first, and what would keep another from being made."""

    backups: tuple[Kept, ...]
    trouble: StorageError | None
    free: int | None  # bytes
    same_disk: bool  # as the database: what takes one takes the other


class Shelf:
    """The backups of the station in the folder `model`. Raises `StorageError` for a `url` that names no database."""

    def __init__(self, url: str, model: Path, keeping: Keeping) -> None:
        self.url, self.model, self.keeping = url, model, keeping
        self.folder = (keeping.folder or backups_folder(url, model)).absolute()
        self._mark = mark_of(model)
        self._own = re.compile(rf"{re.escape(self._mark)}-\d{{8}}T\d{{6}}Z{re.escape(ENDING)}")
        self._known: dict[tuple[str, int, int, int], Kept] = {}  # by name, and what changes when the file does

    def folder_state(self) -> BackupFolderState:
        """All backups there are, and whether one can be made."""
        trouble, free = None, None
        try:
            free = self.require_usable()
        except StorageError as error:
            trouble = error
        return BackupFolderState(self._backups(), trouble, free, self._same_disk())

    def find(self, name: str) -> Path | None:
        """The file of one of the backups."""
        return self.folder / name if any(each.file == name for each in self._backups()) else None

    def new(self, now: float) -> Path:
        """A file for a backup made now that takes no other's place."""
        while True:
            file = self.folder / f"{self._mark}-{time.strftime('%Y%m%dT%H%M%SZ', time.gmtime(now))}{ENDING}"
            if not file.exists():
                return file
            now += 1

    @property
    def scratch(self) -> str:
        """The beginning of the names of folders in which the station puts a backup together, or takes one apart."""
        return f".{self._mark}-"

    def require_usable(self) -> int:
        """The bytes that are free for a backup. Raises `StorageError` where none can be made, as far as can be seen."""
        if kind_of(self.url) == "postgresql":
            program("pg_dump")
        folder = self._there()
        if not folder.is_dir():
            raise no_folder(folder, "it is not there" if not folder.exists() else "it is no folder")
        if not os.access(folder, os.W_OK | os.X_OK):
            raise not_writable(folder, "permission denied")
        free = shutil.disk_usage(folder).free
        if free < (needed := _AT_ONCE * self._size()):
            raise no_space(folder, f"{needed / 1e6:.1f} MB are needed, and {free / 1e6:.1f} MB free")
        return free

    def prepare(self) -> None:
        """See to it that the folder is there, and has room. Raises `StorageError` as `require_usable`."""
        self.clear()
        self.require_usable()
        if self.keeping.folder is None:
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)

    def clear(self) -> None:
        """Take away what a process has left that did not come to its end."""
        for left in self.folder.glob(f"{self.scratch}*"):
            if left.is_dir() and not left.is_symlink():
                shutil.rmtree(left, ignore_errors=True)
            else:
                left.unlink(missing_ok=True)

    def remove_oldest(self, newest: Path) -> list[str]:
        """Remove all but so many; `newest` is one that is whole, and stays whatever the clock has said. The removed."""
        own = [each for each in self._backups() if self._own.fullmatch(each.file) and each.file != newest.name]
        removed = own[max(0, self.keeping.kept - 1) :]
        for each in removed:
            (self.folder / each.file).unlink(missing_ok=True)
        return [each.file for each in removed]

    def _backups(self) -> tuple[Kept, ...]:
        known, self._known = self._known, {}
        with contextlib.suppress(OSError), os.scandir(self.folder) as entries:
            for entry in entries:
                if entry.name.startswith(".") or not entry.name.endswith(ENDING):
                    continue
                if entry.is_file(follow_symlinks=False):
                    status = entry.stat()
                    stamp = entry.name, status.st_ino, status.st_size, status.st_mtime_ns
                    self._known[stamp] = known.get(stamp) or _read(Path(entry.path), status.st_size)
        return tuple(sorted(self._known.values(), key=_when, reverse=True))

    def _size(self) -> int:
        """The bytes that a copy has, as far as this machine can see; what `pg_dump` writes is not known before."""
        place = address(self.url)
        files = [place.path, place.path.with_name(f"{place.path.name}-wal")] if isinstance(place, SqliteFile) else []
        files += [each for each in revisions_folder(self.url, self.model).rglob("*") if each.is_file()]
        sizes = 0
        for each in files:
            with contextlib.suppress(OSError):
                sizes += each.stat().st_size
        return sizes

    def _there(self) -> Path:
        """The folder, or of one that is made with the first backup what is there already."""
        if self.keeping.folder is not None:
            return self.folder
        return next(each for each in (self.folder, *self.folder.parents) if each.exists())

    def _same_disk(self) -> bool:
        place = address(self.url)
        try:
            return isinstance(place, SqliteFile) and place.path.stat().st_dev == self._there().stat().st_dev
        except OSError:
            return False


def what_is_in(manifest: Manifest) -> tuple[int, bool]:
    """Return how many files of the model a backup has, and whether it has revisions."""
    files = sum(1 for name in manifest.files if name.startswith(f"{MODEL}/"))
    return files, any(name.startswith(f"{REVISIONS}/") for name in manifest.files)


def _read(file: Path, size: int) -> Kept:
    try:
        return Kept(file=file.name, size=size, manifest=manifest_of(file), wrong=None)
    except StorageError as error:
        return Kept(file=file.name, size=size, manifest=None, wrong=str(error))


def _when(kept: Kept) -> tuple[float, str]:
    return (0.0 if kept.manifest is None else kept.manifest.time, kept.file)


# Making a backup while the station runs.

_UNFINISHED: Final = ("tmp", ".lock")  # how git's files begin or end that are being written


class Step(StrEnum):
    """Progress of a backup."""

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


def _end(position: ChainPosition) -> ChainEnd:
    return ChainEnd(number=position.number, hash=position.hash)


def _copy_revisions(repository: Path, to: Path) -> None:
    """Copy first what is told first: what it names is there by then, whatever is saved meanwhile."""
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


# A process of its own that makes or checks one backup.

LONGEST: Final = 12 * 3600.0  # seconds after which it is given up
_NICENESS: Final = 10  # below the station and what people wait for


@dataclass(frozen=True)
class BackupTask:
    """A task to do with `file`: check it, or make it where there is a `maker`."""

    url: str
    model: Path
    keeping: Keeping
    file: Path
    maker: Maker | None


@dataclass(frozen=True)
class BackupFinished:
    """It is whole; for its sake the `removed` are no more."""

    removed: tuple[str, ...]


async def carried_out(task: BackupTask, tell: Callable[[Step], None]) -> BackupFinished:
    """Do it in a process; `tell` is called with each step. Raises `StorageError`."""

    def hear(told: Step | BackupFinished) -> None:
        if isinstance(told, Step):
            tell(told)

    work: BackgroundTask[Step | BackupFinished] = BackgroundTask(
        do, (task,), "backup", _NICENESS, errors=(StorageError,), reports=True, leads=True
    )
    try:
        async with asyncio.timeout(LONGEST):
            done = await work.found(hear)
    except TimeoutError:
        raise BackupError(Trouble.OTHER, f"it has taken more than {LONGEST / 3600:.0f} h and was given up") from None
    except WorkerError:
        raise BackupError(Trouble.OTHER, "its process has ended too early: is memory short? Try again") from None
    assert isinstance(done, BackupFinished)
    return done


# Who has made and checked backups: in the journal, before it is begun and when it has ended.

_LOOKED_AT: Final = 200  # of the newest records of each kind


class Doing(StrEnum):
    """Action on a backup, by its name in the journal."""

    MAKING = "make-backup"
    CHECKING = "check-backup"


@dataclass(frozen=True)
class BackupAttempt:
    """The end of something with a backup, or `REQUESTED` where that was not told; and why it failed."""

    doing: Doing
    file: str
    time: float
    by: Actor
    outcome: Outcome
    trouble: Trouble
    why: str


@dataclass(frozen=True)
class Recorded:
    """The last thing done, the last one made, and how each file was found when it was last read as a whole, by name."""

    last: BackupAttempt | None
    made: BackupAttempt | None
    checked: dict[str, BackupAttempt]


def begun(connection: Connection, doing: Doing, by: Actor, file: str, now: float) -> int:
    """Record that it begins; the number of the record."""
    entry = Entry(actor=by, action=doing, subject=file, outcome=Outcome.REQUESTED)
    return audit.append(connection, entry, now).number


def ended(
    connection: Connection,
    doing: Doing,
    by: Actor,
    file: str,
    now: float,
    *,
    outcome: Outcome = Outcome.DONE,
    about: int | None = None,
    details: Mapping[str, JsonValue] = MappingProxyType({}),
) -> None:
    """Record how it ended; `about` is the number of the record with which it began, where there is one."""
    entry = Entry(actor=by, action=doing, subject=file, outcome=outcome, about=about, details=dict(details))
    audit.append(connection, entry, now)


def recorded(connection: Connection) -> Recorded:
    """Return what the journal tells of the latest."""
    records = [each for doing in Doing for each in audit.read(connection, limit=_LOOKED_AT, action=doing)]
    attempts = [_attempt(each) for each in sorted(records, key=lambda record: record.number)]
    # What was made was read again then; what could not be read for another reason says nothing of the file.
    said = [each for each in attempts if each.outcome is Outcome.DONE or each.trouble is Trouble.NOT_WHOLE]
    return Recorded(
        last=attempts[-1] if attempts else None,
        made=next((each for each in reversed(attempts) if each.doing is Doing.MAKING), None),
        checked={each.file: each for each in said},
    )


def _attempt(record: Record) -> BackupAttempt:
    entry = record.entry
    trouble = Trouble(str(entry.details.get("trouble", Trouble.OTHER)))
    why = str(entry.details.get("why", ""))
    return BackupAttempt(Doing(entry.action), entry.subject, record.time, entry.actor, entry.outcome, trouble, why)


# Putting a backup in place where nothing is yet.


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


# What the process of a backup does, from its beginning to its end.


def do(task: BackupTask, tell: Callable[[Step], None]) -> BackupFinished:
    """Make a backup, read it again, and only then remove those that are too many; or only read one.

    Raises `StorageError`. What was made and is not whole is not kept.
    """
    shelf = Shelf(task.url, task.model, task.keeping)
    if task.maker is None:
        shelf.clear()
        tell(Step.CHECKING)
        verify_backup(task.file, shelf.scratch)
        return BackupFinished(())
    shelf.prepare()
    back_up(task.url, task.model, task.file, task.maker, tell)
    tell(Step.CHECKING)
    try:
        verify_backup(task.file, shelf.scratch)
    except StorageError:
        task.file.unlink(missing_ok=True)
        raise
    return BackupFinished(tuple(shelf.remove_oldest(task.file)))
