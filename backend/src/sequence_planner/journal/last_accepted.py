"""Last-word file of a controller: unjournaled commands, and the detection of a lossy shutdown."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import hashlib
import os
import re
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Final

from pydantic import ValidationError
from sqlalchemy import Connection

from sequence_planner.core.data_models import DataModel
from sequence_planner.core.fsync import sync_folder
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.location import PostgresqlServer, SqliteFile, state_folder
from sequence_planner.journal import run_journal
from sequence_planner.journal.entry import Entry
from sequence_planner.journal.hash_chain import START, ChainPosition
from sequence_planner.journal.run_journal import RunRecord

# The last word of a station: a small file on its own machine with what was asked for last and is not in the journal.
#
# A command is answered when the journal has what it did, or else once it is written down here: so a stop that was
# accepted lasts, though the database is away, or the controller is killed in the same moment. The file belongs to one
# controller at a time, which holds a lock on it: who has the lock knows that the one before has ended, and all that it
# has answered.
#
# It has two places of fixed size, which are written by turns: one of them is always whole, and no full disk keeps the
# other from being written. Nothing is ever cleared in it. A word counts until the journal has gone past the record that
# it speaks of, or a later life of a controller has begun (see `last_accepted`).

_PLACE: Final = 16 * 1024  # bytes
_LONGEST: Final = 3000  # characters of a word, of up to four bytes
_HEAD: Final = 8  # hexadecimal digits of the checksum
_ASIDE: Final = re.compile(r"-aside-\d{8}T\d{6}$")


class Word(DataModel):
    """A command that was carried out at `time`: the run had `number` records then, and the station was in `mode`."""

    number: int
    mode: str
    time: float
    entry: Entry


class Life(DataModel):
    """The life of a controller, told by the record with which it begins. `epoch` is that of the lease that it held."""

    turn: int
    number: int
    hash: str
    epoch: int | None = None
    word: Word | None = None


def last_word_file(place: SqliteFile | PostgresqlServer, standby: str | None = None) -> Path:
    """Return where it is: beside the file of SQLite; for PostgreSQL in this user's state folder, one for each
    `standby`.
    """
    if isinstance(place, SqliteFile):
        return place.path.with_name(f"{place.path.name}-last-word")
    mark = hashlib.sha256(str(place).encode()).hexdigest()[:8]
    name = "" if standby is None else "-" + re.sub(r"[^\w.-]", "_", standby)
    return state_folder() / f"last-word-{mark}{name}"


def set_aside(place: SqliteFile | PostgresqlServer, when: datetime) -> list[tuple[Path, Path]]:
    """Give the last words of a station that is no more other names, so that a new one with its database does not begin
    with them: each file as it was called, and as it is called now.

    Raises `StorageError` where a controller has one of them, or it cannot be renamed.
    """
    moved = []
    for path in _left(place):
        with contextlib.closing(LastWord.open(path)) as word:
            if not word.lives:
                continue
            kept = path.with_name(f"{path.name}-aside-{when:%Y%m%dT%H%M%S}")
            try:
                path.rename(kept)
            except OSError as error:
                text = f"{path}, the last word of another station, cannot be set aside: {error.strerror}"
                raise StorageError(text) from error
            moved.append((path, kept))
    return moved


def _left(place: SqliteFile | PostgresqlServer) -> list[Path]:
    """The last words of all stations that this user has run with a database."""
    first = last_word_file(place)
    found = [first] if isinstance(place, SqliteFile) else sorted(first.parent.glob(f"{first.name}*"))
    return [path for path in found if path.is_file() and not _ASIDE.search(path.name)]


class LastWord:
    """The file at `path`, and what it says of earlier lives. Used from one thread at a time."""

    def __init__(self, path: Path, descriptor: int) -> None:
        self.path = path
        self._descriptor = descriptor
        self.lives = tuple(life for place in (0, 1) if (life := self._read(place)) is not None)
        self._life: Life | None = None

    @classmethod
    def open(cls, path: Path) -> LastWord:
        """Take it. Raises `StorageError` when it cannot be written to, or another controller has it."""
        try:
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError as error:
            raise StorageError(f"{path}, the last word of the station, cannot be opened: {error.strerror}") from error
        try:
            # Of this process alone: what it forks does not hold the lock when it has ended.
            fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.posix_fallocate(descriptor, 0, 2 * _PLACE)
            os.fsync(descriptor)
            sync_folder(path.parent)
            return cls(path, descriptor)
        except OSError as error:
            os.close(descriptor)
            if error.errno in (errno.EACCES, errno.EAGAIN):
                text = f"another controller of this station runs already (it holds {path}): end one of the two"
                raise StorageError(text) from error
            raise StorageError(f"{path}, the last word of the station, cannot be written: {error.strerror}") from error

    def start_life(self, begun: ChainPosition, epoch: int | None) -> None:
        """A life begins, of which `begun` is the first record, whether that is durable yet or not. Raises `OSError`."""
        self._write(Life(turn=0, number=begun.number, hash=begun.hash, epoch=epoch))

    def say(self, word: Word) -> None:
        """Write a word down; it is on the disk when this returns. Raises `OSError`."""
        assert self._life is not None, "a life begins before anything is said in it"
        if len(word.model_dump_json()) > _LONGEST:  # that it was asked for matters more than all that was said with it
            word = word.model_copy(update={"entry": word.entry.model_copy(update={"details": {}})})
        self._write(self._life.model_copy(update={"word": word}))

    def close(self) -> None:
        """Let go of it."""
        os.close(self._descriptor)

    def _write(self, life: Life) -> None:
        turn = 1 + max((each.turn for each in (*self.lives, self._life) if each is not None), default=0)
        life = life.model_copy(update={"turn": turn})
        text = life.model_dump_json().encode()
        data = b"%08x" % zlib.crc32(text) + text + b"\n"
        assert len(data) <= _PLACE, "an entry without its details is shorter"
        self._life = life  # also where it cannot be written: the next turn is another one
        os.pwrite(self._descriptor, data, turn % 2 * _PLACE)
        os.fsync(self._descriptor)

    def _read(self, place: int) -> Life | None:
        """Return what is whole at a place."""
        head, _, _ = os.pread(self._descriptor, _PLACE, place * _PLACE).partition(b"\n")
        checksum, text = head[:_HEAD], head[_HEAD:]
        if checksum != b"%08x" % zlib.crc32(text):
            return None
        try:
            return Life.model_validate_json(text)
        except ValidationError:  # of another version
            return None


# How the last life of a controller has ended: whether all that was accepted in it is in the journal.


@dataclass(frozen=True)
class LastEnding:
    """`is_certain` where the last that the journal has is the last that was accepted. If it is not, `word` is what is
    known of the rest, and None where nothing is. `life` is the last one, if it was of this station.
    """

    is_certain: bool
    word: Word | None = None
    life: Life | None = None


def ending(connection: Connection, lives: Sequence[Life], begun_kind: str) -> LastEnding:
    """Return what the journal and the last words of this station say together; `begun_kind` is that of records that
    begin a life.

    A word counts as long as the journal does not reach as far as it, and no other life has begun since: that began
    paused where it was not certain of this. So a word of records that a restored backup does not have counts once.
    """
    end, begun = run_journal.end(connection), run_journal.last(connection, begun_kind)
    number = START.number if end is None else end.number
    for life in sorted(lives, key=lambda each: each.turn, reverse=True):
        if life.word is not None and life.word.number > number and not _is_over(life, begun):
            return LastEnding(False, life.word, life if _has_begun(connection, life, number) else None)
        if _has_begun(connection, life, number):
            break  # with all that the lives before it had said
    for life in lives:
        if _has_begun(connection, life, number) and not _is_over(life, begun):
            return LastEnding(True, life=life)
    return LastEnding(number == START.number and begun is None)


def _is_over(life: Life, begun: RunRecord | None) -> bool:
    """Return whether another life has begun since."""
    return begun is not None and (begun.number > life.number or (begun.number == life.number and not _is(life, begun)))


def _has_begun(connection: Connection, life: Life, end: int) -> bool:
    """Return whether the journal has its first record, or had it before that was cut off."""
    if life.number > end:
        return False
    found = run_journal.get(connection, life.number)
    return life.number <= run_journal.last_trimmed(connection).number if found is None else _is(life, found)


def _is(life: Life, record: RunRecord) -> bool:
    return life.hash == record.hash
