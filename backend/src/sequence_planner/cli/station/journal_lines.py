"""The lines that `journal` prints of a station's database."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path

from pydantic import ValidationError
from sqlalchemy import Connection

from sequence_planner.core.numerals import counted
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import audit
from sequence_planner.journal.archive import Archive, Index
from sequence_planner.journal.archive import verified as wrong_in
from sequence_planner.journal.checkpoints import Checkpoint, key_file, public_key
from sequence_planner.journal.entry import Record
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.hash_chain import START, ChainLink
from sequence_planner.journal.verify import Verified, verify
from sequence_planner.mes.retention import OrderFile, order_files, wrong_files

_PAGE = 1000  # records read at once


def verification(database: Database, kept: Path | None, folder: Path | None = None) -> tuple[bool, Sequence[str]]:
    """Return whether a record was changed or is missing, and lines that say so or tell the last records.

    `kept` is a file with a checkpoint that was kept elsewhere, `folder` where the archive is by now. Raises
    `StorageError` if it holds none.
    """
    checkpoint, archive = None if kept is None else _kept(kept), Archive(folder)
    with database.reading() as connection:
        verified = verify(connection, public_key(key_file(database.place)), checkpoint)
        index, of_orders = archive.index(connection), order_files(connection)
    wrong = [*verified.wrong, *wrong_in(archive, index), *wrong_files(of_orders, folder)]
    return bool(wrong), wrong or [*_whole(verified, checkpoint, index), *_of_orders(of_orders)]


def documents(database: Database) -> Iterator[str]:
    """All records of who did what in order, as JSON."""
    return _lines(database, 0, audit.page_after)


def happenings(database: Database, after: int, folder: Path | None = None) -> Iterator[str]:
    """All records of what happened with numbers above `after`, in order, as JSON: those of the archive too."""
    archive = Archive(folder)
    return _lines(database, after, lambda connection, number, most: WholeRun(connection, archive).after(number, most))


def latest(database: Database, limit: int, action: str | None) -> Iterator[str]:
    """The latest records, the newest last, as lines for people."""
    with database.reading() as connection:
        records = audit.read(connection, limit=limit, action=action)
    for record in reversed(records):
        yield _line(record)


def _lines(
    database: Database, number: int, read: Callable[[Connection, int, int], Sequence[ChainLink]]
) -> Iterator[str]:
    """Page by page, as a reader who takes long must not keep SQLite from clearing its log."""
    while True:
        with database.reading() as connection:
            page = read(connection, number, _PAGE)
        if not page:
            return
        for record in page:
            yield record.line()
        number = page[-1].number


def _kept(file: Path) -> Checkpoint:
    try:
        checkpoint = Checkpoint.model_validate_json(file.read_bytes())
        checkpoint.statement()
    except OSError as error:
        raise StorageError(f"{file} cannot be read: {error.strerror}") from error
    except (ValidationError, StorageError) as error:
        raise StorageError(f"{file} holds no checkpoint as `journal checkpoint` prints it") from error
    return checkpoint


def _whole(verified: Verified, kept: Checkpoint | None, index: Index) -> Iterator[str]:
    who, what, begin = verified.audit, verified.run, verified.run_begin
    if who == START:
        yield "nobody did anything yet"
    else:
        records = counted(who.number, "record")
        yield f"who did what: {records}, all as they were written; the hash of the last one is {who.hash}"
    if what == START:
        yield "nothing happened yet"
    else:
        cut = "" if begin == START else f" behind the hash {begin.hash}"
        yield (
            f"what happened: records {begin.number + 1} to {what.number}{cut}, all as they were written; "
            f"the hash of the last one is {what.hash}"
        )
    if index.segments:
        first, count = index.segments[0], len(index.segments)
        cut = "" if index.whole else f" behind the hash {index.begin.hash}"
        files = "1 file" if count == 1 else f"{count} files"
        yield f"archive: records {first.first} to {begin.number}{cut} in {files}, all as they were written"
    if verified.newest is not None:
        said = verified.newest.statement()
        yield f"checkpoint {said.checkpoint} of {_moment(said.time)}, signed with the key {verified.newest.public_key}"
    if kept is not None:
        yield f"the checkpoint of {_moment(kept.statement().time)} that was kept fits"


def _of_orders(files: Sequence[OrderFile]) -> Iterator[str]:
    if files:
        count = sum(each.orders for each in files)
        yield f"archive: {count} job orders in {len(files)} files, all as they were written"


def _line(record: Record) -> str:
    """A record for people. What would steer a terminal is written as its escape."""
    entry, actor = record.entry, record.entry.actor
    told = [
        str(record.number),
        _moment(record.time),
        actor.name + (f" ({actor.address})" if actor.address else ""),
        entry.action,
        entry.subject,
        entry.outcome + (f" ({entry.about})" if entry.about is not None else ""),
        json.dumps(entry.details, ensure_ascii=False) if entry.details else "",
        f'"{entry.reason}"' if entry.reason else "",
    ]
    return "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode("ascii")
        for each in "  ".join(part for part in told if part)
    )


def _moment(epoch: float) -> str:
    return datetime.fromtimestamp(epoch, UTC).isoformat(" ", "milliseconds").removesuffix("+00:00") + " UTC"
