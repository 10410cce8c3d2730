"""Journal archive: compressed JSON-lines files of trimmed records, with index and integrity check."""

from __future__ import annotations

import contextlib
import errno
import gzip
import hashlib
import json
import os
import zlib
from collections import OrderedDict
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import IO, Any, Final

from pydantic import JsonValue
from sqlalchemy import Connection, select

from sequence_planner.core.fsync import sync_folder
from sequence_planner.core.storage_error import StorageError
from sequence_planner.journal import run_journal
from sequence_planner.journal.audit import AUDIT
from sequence_planner.journal.hash_chain import START, ChainPosition
from sequence_planner.journal.run_journal import RunRecord

# A file of an archive: lines of JSON, compressed, written once and never changed.
#
# It is gzip (RFC 1952), which any machine can read in thirty years. The first line says what follows.

ENDING: Final = ".jsonl.gz"
_PARTIAL: Final = ".partial"
_LEVEL: Final = 6  # of gzip: a higher one takes twice as long for a few per cent
_CHUNK: Final = 1024 * 1024  # bytes


class ArchiveError(StorageError):
    """A file of the archive is not there, or is not as it was written; the message names it and says what to do."""


class ArchiveFullError(ArchiveError):
    """There is no room for another file of the archive."""


@dataclass(frozen=True)
class ArchiveFile:
    """A file that is on the disk: how many bytes it has, and their SHA-256 in hexadecimal digits."""

    size: int
    sha256: str


def write(file: Path, lines: Iterable[str]) -> ArchiveFile:
    """Write a file for this user alone, whole and on the disk, or not at all. Raises `ArchiveError`.

    One of this name that is there gives way: whoever writes has what it should hold.
    """
    partial = file.with_name(f".{file.name}{_PARTIAL}")
    try:
        partial.unlink(missing_ok=True)
        descriptor = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
        try:
            with os.fdopen(descriptor, "wb") as out:
                with gzip.GzipFile(filename="", fileobj=out, mode="wb", compresslevel=_LEVEL, mtime=0) as packed:
                    for line in lines:
                        packed.write(line.encode() + b"\n")
                out.flush()
                os.fsync(out.fileno())
            written = _sum(partial)
            partial.replace(file)
            sync_folder(file.parent)
        except BaseException:
            with contextlib.suppress(OSError):
                partial.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise _not_written(file, error) from error
    return written


def clear(folder: Path) -> None:
    """Take away what a process has left that did not come to its end. Raises `ArchiveError`."""
    try:
        for left in folder.glob(f".*{ENDING}{_PARTIAL}"):
            left.unlink(missing_ok=True)
    except OSError as error:
        raise _not_written(folder, error) from error


def lines(file: Path, sha256: str | None = None) -> Iterator[str]:
    """The lines of a file, whose bytes have this SHA-256 if one is given. Raises `ArchiveError`."""
    try:
        with file.open("rb") as opened:
            if sha256 is not None and _digest(opened) != sha256:
                raise _changed(file)
            opened.seek(0)
            with gzip.GzipFile(fileobj=opened, mode="rb") as packed:
                for line in packed:
                    yield line.decode().removesuffix("\n")
    except FileNotFoundError as error:
        raise ArchiveError(f"{file} is not there: put it back, from a copy of the archive") from error
    except (EOFError, zlib.error, gzip.BadGzipFile, UnicodeDecodeError) as error:
        raise _changed(file) from error
    except OSError as error:
        raise ArchiveError(f"{file} cannot be read: {error.strerror or error}") from error


def check(file: Path, sha256: str) -> None:
    """See whether the bytes of a file are those that were written. Raises `ArchiveError`."""
    for _ in lines(file, sha256):
        return
    raise _changed(file)


def _sum(file: Path) -> ArchiveFile:
    with file.open("rb") as opened:
        return ArchiveFile(file.stat().st_size, _digest(opened))


def _digest(opened: IO[bytes]) -> str:
    total = hashlib.sha256()
    while chunk := opened.read(_CHUNK):
        total.update(chunk)
    return total.hexdigest()


def _changed(file: Path) -> ArchiveError:
    return ArchiveError(f"{file} is damaged, or is not as it was written: put it back, from a copy of the archive")


def _not_written(file: Path, error: OSError) -> ArchiveError:
    folder = file if file.is_dir() else file.parent
    if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        return ArchiveFullError(
            f"there is no room on the disk of {folder}: make room, or name a folder elsewhere with --archive-folder. "
            "Nothing was cut, and nothing is lost"
        )
    if error.errno in (errno.ENOENT, errno.ENOTDIR):
        return ArchiveError(f"there is no folder {folder}: make or mount it, or name another with --archive-folder")
    return ArchiveError(
        f"nothing can be written to {folder}: let the user who runs the station do so ({error.strerror or error})"
    )


# The archive of what happened: files with the records that were cut from the database, as the record of who did what
# tells of them.
#
# That record is chained and never cut. So it says for ever which files there are, and what each has to hold.

TRIMMED: Final = "journal-trimmed"  # the action of a cut, in the record of who did what
REMOVED: Final = "archive-removed"  # and of files that were too old or too many
_KEPT_IN_MEMORY: Final = 2  # files


@dataclass(frozen=True)
class Segment:
    """A file with the records from `first` to `last`, behind one with the hash `before`; `hash` is that of the last.

    `since` and `until` are the times of the two, in seconds since the epoch; `sha256` is that of the file.
    """

    folder: str
    file: str
    first: int
    last: int
    before: str
    hash: str
    since: float
    until: float
    size: int
    sha256: str

    def details(self) -> dict[str, JsonValue]:
        """It as the record of the cut has it, beside where the run begins then."""
        return {"number": self.last, "hash": self.hash, **{k: v for k, v in asdict(self).items() if k != "hash"}}

    @classmethod
    def from_details(cls, details: dict[str, Any]) -> Segment | None:
        """Return what the record of a cut tells; None of one that was made without an archive."""
        if "file" not in details:
            return None
        return cls(**{name: details[name] for name in cls.__dataclass_fields__})

    @property
    def begin(self) -> ChainPosition:
        """The record before the first."""
        return ChainPosition(self.first - 1, self.before)


@dataclass(frozen=True)
class Index:
    """The files that follow on one another up to where the database begins, and the record `begin` before all of them.

    `whole` says whether that is the beginning of the run; else what was before was cut without an archive, or removed.
    """

    segments: tuple[Segment, ...]
    begin: ChainPosition

    @property
    def whole(self) -> bool:
        """True if nothing is missing before the first."""
        return self.begin == START


class Archive:
    """Reads the files of one database's archive. `folder` is where they are looked for before where they were put."""

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder
        self._index: tuple[tuple[int, ChainPosition], Index] | None = None
        self._read: OrderedDict[str, list[str]] = OrderedDict()

    def index(self, connection: Connection) -> Index:
        """Tell which files there are to be. It does not look whether they are there."""
        chosen = select(AUDIT.c.number, AUDIT.c.action, AUDIT.c.entry).where(AUDIT.c.action.in_((TRIMMED, REMOVED)))
        newest = select(AUDIT.c.number).where(AUDIT.c.action.in_((TRIMMED, REMOVED))).order_by(AUDIT.c.number.desc())
        begin = run_journal.last_trimmed(connection)
        key = connection.execute(newest.limit(1)).scalar() or 0, begin
        known = self._index
        if known is None or known[0] != key:
            rows = connection.execute(chosen.order_by(AUDIT.c.number)).all()
            known = self._index = key, _index([(row.action, json.loads(row.entry)["details"]) for row in rows], begin)
        return known[1]

    def path(self, segment: Segment) -> Path:
        """Return where the file is: in the folder that is named, or else where it was put."""
        if self.folder is not None and (named := self.folder / segment.file).exists():
            return named
        return Path(segment.folder) / segment.file

    def lines(self, segment: Segment) -> list[str]:
        """The records of a file, each as its line. Raises `ArchiveError` unless they are those that were written."""
        found = self._read.pop(segment.sha256, None)
        if found is None:
            file = self.path(segment)
            found = list(lines(file, segment.sha256))[1:]
            if len(found) != segment.last - segment.first + 1:
                raise ArchiveError(
                    f"{file} has {len(found)} records and not those from {segment.first} to {segment.last}"
                )
        self._read[segment.sha256] = found
        while len(self._read) > _KEPT_IN_MEMORY:
            self._read.popitem(last=False)
        return found


def header(segment_of: tuple[ChainPosition, ChainPosition], since: float, until: float) -> str:
    """The first line of a file: what follows, and behind which hash."""
    begin, end = segment_of
    said = {"archive": "run", "first": begin.number + 1, "last": end.number, "before": begin.hash, "hash": end.hash}
    return json.dumps({**said, "since": since, "until": until}, separators=(",", ":"))


def verified(archive: Archive, index: Index) -> Iterator[str]:
    """Yield what is wrong with the files, in words; nothing where all are as they were written, and follow on one
    another.
    """
    for before, segment in pairwise((None, *index.segments)):
        assert segment is not None
        if before is not None and (before.last, before.hash) != (segment.first - 1, segment.before):
            yield f"the archive has nothing between the records {before.last} and {segment.first} of what happened"
        try:
            wrong = broken_at(archive, segment)
        except ArchiveError as error:
            yield f"records {segment.first} to {segment.last} of what happened: {error}"
            continue
        if wrong is not None:
            yield f"record {wrong} of what happened is missing in {archive.path(segment)}, or is not as it was written"


def broken_at(archive: Archive, segment: Segment) -> int | None:
    """The first record of a file that is not as it was written. Raises `ArchiveError`."""
    number, last = segment.first, segment.before
    for line in lines(archive.path(segment), segment.sha256):
        if line.startswith('{"archive"'):
            continue
        record = RunRecord.parse(line)
        if record is None or record.number != number or not record.is_whole(last):
            return number
        number, last = number + 1, record.hash
    return None if (number - 1, last) == (segment.last, segment.hash) else number


def _index(entries: list[tuple[str, dict[str, Any]]], begin: ChainPosition) -> Index:
    segments: list[Segment] = []
    first = START
    for action, details in entries:
        if action == REMOVED:
            first = ChainPosition(details["number"], details["hash"])
            segments = [each for each in segments if each.last > first.number]
            continue
        segment = Segment.from_details(details)
        if segment is None:
            segments, first = [], ChainPosition(details["number"], details["hash"])
        else:
            if segments and segments[-1].hash != segment.before:
                segments = []
            segments.append(segment)
    if segments and (segments[-1].last, segments[-1].hash) == (begin.number, begin.hash):
        return Index(tuple(segments), segments[0].begin)
    return Index((), begin)
