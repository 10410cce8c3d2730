"""Backup files: the tar archive with its manifest, consistent database copies, and verification."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import io
import os
import shutil
import sqlite3
import subprocess
import tarfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Final, Literal, TypeAlias
from urllib.parse import quote

from pydantic import ValidationError
from sqlalchemy import Connection, inspect, text

from sequence_planner.backup.errors import BackupError, Trouble, no_space, trouble_of
from sequence_planner.core.data_models import DataModel
from sequence_planner.core.secrets import PASSWORD, environment
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import PostgresqlServer, SqliteFile, address
from sequence_planner.journal.hash_chain import ChainPosition
from sequence_planner.journal.verify import Verified, verify

# The file of a backup: a tar archive with a manifest that says what is in it, and the SHA-256 of each member.

MANIFEST: Final = "manifest.json"
DATABASE: Final = "database"  # a file of SQLite, or what pg_dump has written
REVISIONS: Final = "revisions.git"
MODEL: Final = "model"
_CHUNK: Final = 1024 * 1024  # bytes


class ChainEnd(DataModel):
    """The last record of a chain."""

    number: int
    hash: str


class How(StrEnum):
    """Reason for which a backup was made."""

    ASKED = "asked"  # by somebody on the page
    SCHEDULE = "schedule"
    COMMAND_LINE = "command-line"


class Maker(DataModel):
    """The one who has made a backup; `name` is what people read."""

    how: How
    name: str


class Manifest(DataModel):
    """The contents of a backup. `time` is in seconds since the epoch; `files` has the SHA-256 of all other members."""

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
    """Give what a backup holds, unpacked to a folder in `beside` as long as the block lasts, each member as it was
    written.

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
    """Return what a backup says that is in it, by its beginning alone. Raises `StorageError`."""
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


# PostgreSQL's own programs, with which its databases are copied: this machine needs its client.

_INSTALLED: Final = Path("/usr/lib/postgresql")  # where Debian has the programs, by version


def run(name: str, server: PostgresqlServer, *options: str) -> None:
    """Run `pg_dump` or `pg_restore` on a database. Raises `StorageError` with what it says.

    The password goes by the environment: everybody on this machine can read what stands on a command line.
    """
    from psycopg.conninfo import make_conninfo  # noqa: PLC0415 - stations with SQLite do without

    url = server.url
    words = {"host": url.host, "port": url.port, "user": url.username, "dbname": url.database, **url.query}
    told = make_conninfo(**{name: str(value) for name, value in words.items() if value})
    secret = {} if url.password is None else {"PGPASSWORD": str(url.password)}
    _run(str(server), name, [f"--dbname={told}", "--no-password", *options], secret)


def read_through(dump: Path) -> None:
    """Read what `pg_dump` has written to its end. Raises `StorageError` where that cannot be done."""
    _run(str(dump), "pg_restore", [f"--file={os.devnull}", str(dump)], {})


def _run(of: str, name: str, arguments: Sequence[str], secret: Mapping[str, str]) -> None:
    done = subprocess.run(
        [program(name), *arguments],
        env={**environment(PASSWORD), **secret, "LC_ALL": "C"},  # what it says of a full disk is looked for
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"it ended with code {done.returncode}"]
        full = any(os.strerror(errno.ENOSPC) in line for line in said)
        raise BackupError(Trouble.NO_SPACE if full else Trouble.OTHER, f"{of}: {name} failed: {'; '.join(said[:3])}")


def program(name: str) -> Path:
    """The newest there is: it can speak to all servers that are no newer. Raises `BackupError`."""
    by_version = sorted(_INSTALLED.glob(f"*/bin/{name}"), key=lambda file: float(file.parents[1].name), reverse=True)
    found = by_version[0] if by_version else shutil.which(name)
    if found is None:
        raise BackupError(
            Trouble.NO_PROGRAM,
            f"{name} is not here, which copies a database of PostgreSQL: install its client, as in "
            "sudo apt-get install postgresql-client",
        )
    return Path(found)


# Copies of a database that are of one moment, while others write to it; and putting such a copy in place.

Kind: TypeAlias = Literal["sqlite", "postgresql"]
_BESIDE: Final = ("-wal", "-shm", "-journal")  # what SQLite keeps beside a file that is in use
_OTHERS: Final = text(
    "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND pid <> pg_backend_pid()"
)


def kind_of(url: str) -> Kind:
    """Return which of the two a URL names. Raises `StorageError`."""
    return "sqlite" if isinstance(address(url), SqliteFile) else "postgresql"


def copy(database: Database, to: Path) -> Verified:
    """Copy a database to a file, and verify the journal as it is in the copy. Raises `StorageError`."""
    place = database.place
    if isinstance(place, SqliteFile):
        _copy_file(place, to)
        return _verified(to)
    with database.reading() as connection:  # sees one moment, and pg_dump the same one
        snapshot: str = connection.execute(text("SELECT pg_export_snapshot()")).scalar_one()
        options = ("--format=custom", "--no-owner", "--no-privileges", f"--snapshot={snapshot}", f"--file={to}")
        run("pg_dump", place, *options)
        return verify(connection)


def require_empty(url: str) -> None:
    """Raises `StorageError` unless there is nothing yet where a copy is to be put, and nobody is at it."""
    place = address(url)
    if not isinstance(place, SqliteFile):
        with contextlib.closing(Database.open(url)) as database, database.reading() as connection:
            _require_nobody(connection, str(place))
        return
    if place.path.exists():
        raise StorageError(
            f"{place} is there already, and a station may be running on it: stop the station and move the file away "
            "with those beside it, or name another database"
        )
    for left in (place.path.with_name(place.path.name + ending) for ending in _BESIDE):
        if left.exists():
            raise StorageError(
                f"{left} is left of another database, and a station may be running on it: stop the station and move "
                "this file away too"
            )


def put(url: str, copied: Path) -> Verified:
    """Put a copy where a URL names, where nothing is yet, and verify the journal there. Raises `StorageError`.

    A file of SQLite is verified before it is put in place, and on the same disk already.
    """
    place = address(url)
    if not isinstance(place, SqliteFile):
        run(
            "pg_restore", place, "--no-owner", "--no-privileges", "--exit-on-error", "--single-transaction", str(copied)
        )
        return _verified_at(url)
    verified = _verified(copied)
    if not verified.wrong:
        try:
            os.link(copied, place.path)  # which takes no other file's place
        except OSError as error:
            raise StorageError(f"{place} cannot be written: {error.strerror}") from error
    return verified


def verified_copy(kind: Kind, copied: Path) -> Verified | None:
    """The journal of a copy that is in no place yet; None where only a server reads it. Raises `StorageError`."""
    if kind == "sqlite":
        return _verified(copied)
    read_through(copied)
    return None


def _require_nobody(connection: Connection, place: str) -> None:
    if inspect(connection).get_table_names():
        raise StorageError(
            f"{place} is not empty, and a station may be running on it: stop the station, and name an empty database"
        )
    if connection.execute(_OTHERS).scalar_one():
        raise StorageError(f"{place} is in use by somebody else: end what uses it, then try again")


def _copy_file(file: SqliteFile, to: Path) -> None:
    """All pages in one step, so that no writer makes it begin anew; no writer waits for it."""
    try:
        with (
            contextlib.closing(sqlite3.connect(f"{file.path.as_uri()}?mode=rw", uri=True)) as source,
            contextlib.closing(sqlite3.connect(to)) as target,
        ):
            source.backup(target)
            (found,) = target.execute("PRAGMA integrity_check").fetchone()
    except sqlite3.Error as error:
        if error.sqlite_errorcode & 0xFF == sqlite3.SQLITE_FULL:
            raise no_space(to.parent, str(error)) from error
        raise StorageError(f"{file} cannot be copied: {error}") from error
    if found != "ok":
        raise BackupError(Trouble.NOT_WHOLE, f"{file} is damaged: {found}")


def _verified(file: Path) -> Verified:
    return _verified_at(f"sqlite:///{quote(str(file.absolute()))}")


def _verified_at(url: str) -> Verified:
    """The journal of a copy, whose tables are brought up to date first."""
    with contextlib.closing(Database.open(url, create=False)) as database:
        database.upgrade()
        with database.reading() as connection:
            return verify(connection)


# Whether a backup is whole: each member as it was written, and the journal in the copy as the manifest says.


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
    """Yield what is wrong with the journal of a copy, or other than the manifest says."""
    yield from verified.wrong
    for name, end, then in (("audit", verified.audit, manifest.audit), ("run", verified.run, manifest.run)):
        if not _is(end, then):
            yield f"the chain {name} ends with record {end.number}, and the backup says {then.number}"


def _is(end: ChainPosition, then: ChainEnd) -> bool:
    return (end.number, end.hash) == (then.number, then.hash)
