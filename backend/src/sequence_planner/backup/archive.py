"""The file of a backup: a tar archive with a manifest that says what is in it, and the SHA-256 of each member."""

from __future__ import annotations

import hashlib
import io
import os
import shutil
import tarfile
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Final, Literal

from pydantic import BaseModel, ConfigDict, ValidationError

from sequence_planner.backup.trouble import BackupError, Trouble, trouble_of
from sequence_planner.storage.error import StorageError

MANIFEST: Final = "manifest.json"
DATABASE: Final = "database"  # a file of SQLite, or what pg_dump has written
REVISIONS: Final = "revisions.git"
MODEL: Final = "model"
_CHUNK: Final = 1024 * 1024  # bytes


class ChainEnd(BaseModel):
    """The last record of a chain."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    number: int
    hash: str


class How(StrEnum):
    """How it came that a backup was made."""

    ASKED = "asked"  # by somebody on the page
    SCHEDULE = "schedule"
    COMMAND_LINE = "command-line"


class Maker(BaseModel):
    """Who has made a backup; `name` is what people read."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    how: How
    name: str


class Manifest(BaseModel):
    """What is in a backup. `time` is in seconds since the epoch; `files` has the SHA-256 of all other members."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    format: Literal[1]
    program: str
    time: float
    station: str  # the name of the model's folder
    maker: Maker | None = None  # None: a program made it that did not tell yet
    database: Literal["sqlite", "postgresql"]
    audit: ChainEnd
    run: ChainEnd
    files: dict[str, str]


def write(folder: Path, manifest: Manifest, file: Path) -> None:
    """Put what is in `folder` into `file`, for this user alone, whole or not at all. Raises `StorageError`."""
    partial = file.with_name(f".{file.name}.partial")
    try:
        partial.unlink(missing_ok=True)
        descriptor = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
        try:
            with os.fdopen(descriptor, "wb") as out:
                with tarfile.open(fileobj=out, mode="w") as tar:
                    _add(tar, MANIFEST, manifest.model_dump_json(indent=2).encode())
                    for name in manifest.files:
                        tar.add(folder / name, name, recursive=False, filter=_plain)
                out.flush()
                os.fsync(out.fileno())
            os.link(partial, file)  # which takes no other file's place
        finally:
            partial.unlink(missing_ok=True)
    except FileExistsError:
        raise StorageError(f"{file} is there already: name another file") from None
    except OSError as error:
        raise trouble_of(error, file.parent) from error


@contextmanager
def opened(file: Path, beside: Path, scratch: str = ".restoring-") -> Iterator[tuple[Manifest, Path]]:
    """What a backup holds, unpacked to a folder in `beside` as long as the block lasts, each member as it was written.

    The folder's name begins with `scratch`. Raises `StorageError` for what is no backup, or was changed.
    """
    try:
        beside.mkdir(mode=0o700, parents=True, exist_ok=True)
        with TemporaryDirectory(prefix=scratch, dir=beside) as folder, tarfile.open(file, mode="r:") as tar:
            manifest = _manifest(tar, file)
            found = dict(_unpacked(tar, Path(folder), file))
            if found != manifest.files:
                changed = sorted(name for name, _ in found.items() ^ manifest.files.items())
                raise _not_whole(f"{file} is not as it was written: see {', '.join(changed[:3])}")
            yield manifest, Path(folder)
    except tarfile.TarError as error:
        raise _not_whole(f"{file} is no backup: {error}") from error
    except OSError as error:
        if not file.exists():
            raise StorageError(f"{file} is not there") from error
        raise trouble_of(error, beside) from error


def manifest_of(file: Path) -> Manifest:
    """What a backup says that is in it, by its beginning alone. Raises `StorageError`."""
    try:
        with tarfile.open(file, mode="r:") as tar:
            return _manifest(tar, file)
    except tarfile.TarError as error:
        raise _not_whole(f"{file} is no backup: {error}") from error
    except OSError as error:
        raise StorageError(f"{file} cannot be read: {error.strerror or error}") from error


def sums(folder: Path) -> dict[str, str]:
    """The SHA-256 of each file below a folder, by its path there."""
    files = sorted(each for each in folder.rglob("*") if each.is_file() and not each.is_symlink())
    return {each.relative_to(folder).as_posix(): _sum(each) for each in files}


def _not_whole(message: str) -> BackupError:
    return BackupError(Trouble.NOT_WHOLE, message)


def _sum(file: Path) -> str:
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()


def _add(tar: tarfile.TarFile, name: str, content: bytes) -> None:
    info = tarfile.TarInfo(name)
    info.size, info.mode = len(content), 0o600
    tar.addfile(info, io.BytesIO(content))


def _plain(info: tarfile.TarInfo) -> tarfile.TarInfo:
    """Nothing of who made it on which machine."""
    info.uid = info.gid = 0
    info.uname = info.gname = ""
    info.mode = 0o600
    return info


def _manifest(tar: tarfile.TarFile, file: Path) -> Manifest:
    first = tar.next()
    content = tar.extractfile(first) if first is not None and first.name == MANIFEST and first.isreg() else None
    if content is None:
        raise _not_whole(f"{file} is no backup of a station: it does not begin with {MANIFEST}")
    try:
        return Manifest.model_validate_json(content.read())
    except ValidationError as error:
        raise _not_whole(f"{file} is of another version, or no backup: {MANIFEST} cannot be read") from error


def _unpacked(tar: tarfile.TarFile, folder: Path, file: Path) -> Iterator[tuple[str, str]]:
    """Each member with its SHA-256; only plain files, below the folder."""
    for number, member in enumerate(tar):
        if number == 0:
            continue  # the manifest, which was read
        path = PurePosixPath(member.name)
        if not member.isreg() or path.is_absolute() or ".." in path.parts or "\\" in member.name:
            raise _not_whole(f"{file} is not as it was written: {member.name!r} is no file of a backup")
        content = tar.extractfile(member)
        assert content is not None
        target = folder / path
        target.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with target.open("xb") as out:
            shutil.copyfileobj(content, out, _CHUNK)
        target.chmod(0o600)
        yield member.name, _sum(target)
