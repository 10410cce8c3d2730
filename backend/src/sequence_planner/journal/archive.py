"""The archive of what happened: files with the records that were cut from the database, as the record of who did what
tells of them.

That record is chained and never cut. So it says for ever which files there are, and what each has to hold.
"""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from pydantic import JsonValue
from sqlalchemy import Connection, select

from sequence_planner.journal import archive_file, run_journal
from sequence_planner.journal.archive_file import ArchiveError
from sequence_planner.journal.audit import AUDIT
from sequence_planner.journal.chain import START, Position
from sequence_planner.journal.run_journal import RunRecord

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
    def of(cls, details: dict[str, Any]) -> Segment | None:
        """What the record of a cut tells; None of one that was made without an archive."""
        if "file" not in details:
            return None
        return cls(**{name: details[name] for name in cls.__dataclass_fields__})

    @property
    def begin(self) -> Position:
        """The record before the first."""
        return Position(self.first - 1, self.before)


@dataclass(frozen=True)
class Index:
    """The files that follow on one another up to where the database begins, and the record `begin` before all of them.

    `whole` says whether that is the beginning of the run; else what was before was cut without an archive, or removed.
    """

    segments: tuple[Segment, ...]
    begin: Position

    @property
    def whole(self) -> bool:
        """Whether nothing is missing before the first."""
        return self.begin == START


class Archive:
    """Reads the files of one database's archive. `folder` is where they are looked for before where they were put."""

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder
        self._index: tuple[tuple[int, Position], Index] | None = None
        self._read: OrderedDict[str, list[str]] = OrderedDict()

    def index(self, connection: Connection) -> Index:
        """Which files there are to be. It does not look whether they are there."""
        chosen = select(AUDIT.c.number, AUDIT.c.action, AUDIT.c.entry).where(AUDIT.c.action.in_((TRIMMED, REMOVED)))
        newest = select(AUDIT.c.number).where(AUDIT.c.action.in_((TRIMMED, REMOVED))).order_by(AUDIT.c.number.desc())
        begin = run_journal.begin(connection)
        key = connection.execute(newest.limit(1)).scalar() or 0, begin
        known = self._index
        if known is None or known[0] != key:
            rows = connection.execute(chosen.order_by(AUDIT.c.number)).all()
            known = self._index = key, _index([(row.action, json.loads(row.entry)["details"]) for row in rows], begin)
        return known[1]

    def path(self, segment: Segment) -> Path:
        """Where the file is: in the folder that is named, or else where it was put."""
        if self.folder is not None and (named := self.folder / segment.file).exists():
            return named
        return Path(segment.folder) / segment.file

    def lines(self, segment: Segment) -> list[str]:
        """The records of a file, each as its line. Raises `ArchiveError` unless they are those that were written."""
        found = self._read.pop(segment.sha256, None)
        if found is None:
            file = self.path(segment)
            found = list(archive_file.lines(file, segment.sha256))[1:]
            if len(found) != segment.last - segment.first + 1:
                raise ArchiveError(
                    f"{file} has {len(found)} records and not those from {segment.first} to {segment.last}"
                )
        self._read[segment.sha256] = found
        while len(self._read) > _KEPT_IN_MEMORY:
            self._read.popitem(last=False)
        return found


def header(segment_of: tuple[Position, Position], since: float, until: float) -> str:
    """The first line of a file: what follows, and behind which hash."""
    begin, end = segment_of
    said = {"archive": "run", "first": begin.number + 1, "last": end.number, "before": begin.hash, "hash": end.hash}
    return json.dumps({**said, "since": since, "until": until}, separators=(",", ":"))


def verified(archive: Archive, index: Index) -> Iterator[str]:
    """What is wrong with the files, in words; nothing where all are as they were written, and follow on one another."""
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
    for line in archive_file.lines(archive.path(segment), segment.sha256):
        if line.startswith('{"archive"'):
            continue
        record = RunRecord.of(line)
        if record is None or record.number != number or not record.is_whole(last):
            return number
        number, last = number + 1, record.hash
    return None if (number - 1, last) == (segment.last, segment.hash) else number


def _index(entries: list[tuple[str, dict[str, Any]]], begin: Position) -> Index:
    segments: list[Segment] = []
    first = START
    for action, details in entries:
        if action == REMOVED:
            first = Position(details["number"], details["hash"])
            segments = [each for each in segments if each.last > first.number]
            continue
        segment = Segment.of(details)
        if segment is None:
            segments, first = [], Position(details["number"], details["hash"])
        else:
            if segments and segments[-1].hash != segment.before:
                segments = []
            segments.append(segment)
    if segments and (segments[-1].last, segments[-1].hash) == (begin.number, begin.hash):
        return Index(tuple(segments), segments[0].begin)
    return Index((), begin)
