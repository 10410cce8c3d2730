"""A file of an archive: lines of JSON, compressed, written once and never changed.

It is gzip (RFC 1952), which any machine can read in thirty years. The first line says what follows.
"""

from __future__ import annotations

import contextlib
import errno
import gzip
import hashlib
import os
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Final

from sequence_planner.durable import sync_folder
from sequence_planner.storage.error import StorageError

ENDING: Final = ".jsonl.gz"
_PARTIAL: Final = ".partial"
_LEVEL: Final = 6  # of gzip: a higher one takes twice as long for a few per cent
_CHUNK: Final = 1024 * 1024  # bytes


class ArchiveError(StorageError):
    """A file of the archive is not there, or is not as it was written; the message names it and says what to do."""


class ArchiveFullError(ArchiveError):
    """There is no room for another file of the archive."""


@dataclass(frozen=True)
class Written:
    """A file that is on the disk: how many bytes it has, and their SHA-256 in hexadecimal digits."""

    size: int
    sha256: str


def write(file: Path, lines: Iterable[str]) -> Written:
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


def _sum(file: Path) -> Written:
    with file.open("rb") as opened:
        return Written(file.stat().st_size, _digest(opened))


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
