"""All that has happened, in order: what the database has, and before that what the archive has, as if it were one.

Of an archive nothing is read but what is asked for. Raises `ArchiveError` where a file that is needed cannot be read.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterator
from typing import Final

from sqlalchemy import Connection

from sequence_planner.journal import run_journal
from sequence_planner.journal.archive import Archive, Index, Segment
from sequence_planner.journal.hash_chain import ChainPosition
from sequence_planner.journal.run_journal import RecordPlace, RecordQuery, RunRecord

MOST_FILES: Final = 8
"""Files that are looked through for what is sought: more would take too long for who waits."""


class WholeRun:
    """The run as one `connection` sees it, with what the `archive` has of it."""

    def __init__(self, connection: Connection, archive: Archive | None = None) -> None:
        self.connection = connection
        self._archive = archive or Archive()
        self._index: Index | None = None
        self.reached: int | None = None
        """Below this number nothing was looked through by the last `before`; None where it was at the end."""

    @property
    def index(self) -> Index:
        """The files that there are to be."""
        if self._index is None:
            self._index = self._archive.index(self.connection)
        return self._index

    @property
    def last_trimmed(self) -> ChainPosition:
        """The last record that is kept nowhere any more; `START` if all are."""
        return self.index.begin

    def get(self, number: int) -> RunRecord | None:
        """The record of this number; None if there is none, or none any more."""
        segment = self._having(number)
        if segment is None:
            return run_journal.get(self.connection, number)
        return _read(self._archive.lines(segment)[number - segment.first])

    def after(self, number: int, limit: int, kinds: Collection[str] | None = None) -> list[RunRecord]:
        """As `run_journal.after`."""
        found: list[RunRecord] = []
        for segment in self.index.segments:
            if segment.last > number and len(found) < limit:
                start = max(0, number + 1 - segment.first)
                lines = self._archive.lines(segment)[start:]
                found += _up_to(lines, limit - len(found), kinds)
        if len(found) < limit:
            begin = max(number, run_journal.last_trimmed(self.connection).number)
            found += run_journal.after(self.connection, begin, limit - len(found), kinds)
        return found

    def before(
        self,
        number: int | None,
        limit: int,
        kinds: Collection[str] | None = None,
        sought: RecordQuery | None = None,
        most_files: int | None = None,
    ) -> list[RunRecord]:
        """As `run_journal.before`; `reached` says where it stopped looking after `most_files`."""
        found, self.reached = list[RunRecord](), None
        begin = run_journal.last_trimmed(self.connection).number
        if number is None or number > begin + 1:
            # What an earlier cut has left in the database is in the archive by now.
            chosen = run_journal.before(self.connection, number, limit, kinds, sought)
            found = [each for each in chosen if each.number > begin]
        looked = 0
        for segment in reversed(self.index.segments):
            if len(found) >= limit:
                break
            if number is not None and segment.first >= number:
                continue
            if most_files is not None and looked >= most_files:
                self.reached = segment.last + 1
                break
            looked += 1
            lines = self._archive.lines(segment)
            end = len(lines) if number is None else min(len(lines), number - segment.first)
            found += _up_to(reversed(lines[:end]), limit - len(found), kinds, sought)
        return found

    def bounds(self) -> tuple[RecordPlace, RecordPlace] | None:
        """The first record that there is and the last one; None if there is none."""
        within = run_journal.bounds(self.connection)
        if within is None or not self.index.segments:
            return within
        first = self.index.segments[0]
        return RecordPlace(first.first, first.since), within[1]

    def at(self, time: float) -> int:
        """The number of the last record up to a time; below the first if there is none. See `run_journal.at`."""
        within = run_journal.bounds(self.connection)
        if within is None:
            return 0
        segments, begin = self.index.segments, run_journal.last_trimmed(self.connection).number
        if segments and time < segments[-1].until:
            segment = segments[bisect_right(segments, time, key=lambda each: each.since) - 1]
            if time < segments[0].since:
                return segments[0].first - 1
            if time >= segment.until:
                return segment.last
            lines = self._archive.lines(segment)
            return segment.first - 1 + bisect_right(lines, time, key=lambda line: _read(line).time)
        first = run_journal.get(self.connection, begin + 1)
        return (
            begin
            if first is None
            else run_journal.at(self.connection, time, RecordPlace(first.number, first.time), within[1])
        )

    def _having(self, number: int) -> Segment | None:
        segments = self.index.segments
        place = bisect_left(segments, number, key=lambda each: each.last)
        return segments[place] if place < len(segments) and segments[place].first <= number else None


def _up_to(
    lines: Collection[str] | Iterator[str], limit: int, kinds: Collection[str] | None, sought: RecordQuery | None = None
) -> list[RunRecord]:
    found: list[RunRecord] = []
    for line in lines:
        if kinds is not None and sought is None and not any(f'"kind":"{kind}"' in line[:120] for kind in kinds):
            continue
        record = _read(line)
        if _is_chosen(record, kinds, sought):
            found.append(record)
            if len(found) == limit:
                break
    return found


def _is_chosen(record: RunRecord, kinds: Collection[str] | None, sought: RecordQuery | None) -> bool:
    """As the database chooses."""
    if sought is not None and not sought.fits(record):
        return False
    if sought is not None and sought.parts:
        return record.kind in (kinds or ()) or sought.has_part(record)
    return kinds is None or record.kind in kinds


def _read(line: str) -> RunRecord:
    record = RunRecord.parse(line)
    assert record is not None, line  # the file is as it was written
    return record
