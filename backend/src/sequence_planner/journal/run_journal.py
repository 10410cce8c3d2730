"""Run journal: database tables of all station events, and queries in order of occurrence."""

from __future__ import annotations

import heapq
import json
import re
from bisect import bisect_right
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final, TypeAlias

from sqlalchemy import (
    Column,
    ColumnElement,
    Connection,
    Double,
    Index,
    Select,
    String,
    Table,
    Text,
    and_,
    or_,
    select,
)

from sequence_planner.db.metadata import METADATA
from sequence_planner.journal import hash_chain
from sequence_planner.journal.hash_chain import (
    BELOW_ALL,
    NUMBER,
    START,
    ChainLink,
    ChainPosition,
    position_table,
)

# The tables of the run: all that has happened at the station, from which it can be done again.

LONGEST_KIND: Final = 40  # characters

RUN: Final = Table(
    "run",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),
    Column("time", Double, nullable=False),
    Column("kind", String(LONGEST_KIND), nullable=False),
    Column("content", Text, nullable=False),
    Column("hash", String(64), nullable=False),
    Index("ix_run_kind_number", "kind", "number"),
)
"""`content` is JSON text."""

RUN_BEGIN: Final = position_table("run_begin")
"""One row with the last record that retention has cut off; the run begins behind it."""

RUN_END: Final = position_table("run_end")
"""One row with the last record, so that records missing at the end show, as does a second station that writes."""

RUN_CHECKPOINTS: Final = Table(
    "run_checkpoints",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),
    Column("run_number", NUMBER, nullable=False),
    Column("content", Text, nullable=False),
    Column("public_key", String(64), nullable=False),
    Column("signature", String(128), nullable=False),
)
"""Signed statements of how far both chains had come. `content` is the text that is signed."""


# Reading what has happened at the station, in the order in which it did.

_Chosen: TypeAlias = Select[*tuple[Any, ...]]

_PAGE: Final = 1000  # records read at once


@dataclass(frozen=True)
class RunRecord(ChainLink):
    """An event that has happened: `number` counts from 1 without gaps, `time` is in seconds since the epoch.

    `content` is JSON text on one line; what it says depends on the `kind`. `hash` chains it to the record before.
    """

    number: int
    time: float
    kind: str
    content: str
    hash: str

    def text(self) -> str:
        """It as a line of JSON, up to its hash."""
        return f'{{"number":{self.number},"time":{self.time!r},"kind":{_quoted(self.kind)},"content":{self.content}'

    @classmethod
    def parse(cls, line: str) -> RunRecord | None:
        """The record of a `line`; None for one that is none."""
        if (found := _LINE.fullmatch(line)) is None:
            return None
        number, time, kind, content, hash_ = found.groups()
        return cls(int(number), float(time), json.loads(kind), content, hash_)


@dataclass(frozen=True)
class RecordQuery:
    """The records that are sought: those that name `who`, one of `names` (or what begins with it), and one of `texts`.

    What is left empty is not asked for. Texts are found whatever their case. Beside those of the kinds that are asked
    for there are those with one of `parts`, as in `started`.
    """

    who: str = ""
    names: tuple[str, ...] = ()
    texts: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()

    def of_parts(self) -> ColumnElement[bool]:
        """That it has one of the parts, as a condition on the text of the content."""
        needles = (f'"{part}":{_BEGINNINGS.get(part, "[")}' for part in self.parts)
        return or_(*(RUN.c.content.contains(needle, autoescape=True) for needle in needles))

    def condition(self) -> ColumnElement[bool] | None:
        """It as a condition on the text of the content; None if everything is sought."""
        content, asked = RUN.c.content, list[ColumnElement[bool]]()
        if self.who:
            asked.append(content.contains(f'"by":{json.dumps(self.who)}', autoescape=True))
        if self.names:
            asked.append(or_(*(content.contains(f'"{_within(name)}', autoescape=True) for name in self.names)))
        if self.texts:
            asked.append(or_(*(content.icontains(_within(text), autoescape=True) for text in self.texts)))
        return and_(*asked) if asked else None

    def has_part(self, record: RunRecord) -> bool:
        """Return whether a record has one of the parts, as `of_parts` says it to the database."""
        return any(f'"{part}":{_BEGINNINGS.get(part, "[")}' in record.content for part in self.parts)

    def fits(self, record: RunRecord) -> bool:
        """Return whether a record is sought, as `condition` says it to the database."""
        content = record.content
        if self.who and f'"by":{json.dumps(self.who)}' not in content:
            return False
        if self.names and not any(f'"{_within(name)}' in content for name in self.names):
            return False
        return not self.texts or any(_within(text).lower() in content.lower() for text in self.texts)


_LINE: Final = re.compile(
    r'\{"number":(\d+),"time":([^,]+),"kind":("(?:[^"\\]|\\.)*"),"content":(.*),"hash":"([^"]*)"\}', re.DOTALL
)
_BEGINNINGS: Final = {"plan": '{"status"', "mode": '"'}  # of what a part holds; all else is a list


def _within(text: str) -> str:
    """As it is written within a string of JSON."""
    return json.dumps(text)[1:-1]


@dataclass(frozen=True)
class RecordPlace:
    """A record's number, and when it was written."""

    number: int
    time: float


@lru_cache(256)
def _quoted(kind: str) -> str:
    """As JSON: a kind with a quotation mark in it must not read as a shorter one with other content."""
    return json.dumps(kind)


def after(connection: Connection, number: int, limit: int, kinds: Collection[str] | None = None) -> list[RunRecord]:
    """Up to `limit` records with numbers above `number`, the oldest first; only of these kinds, if any are named."""
    return _page(
        connection,
        lambda: select(RUN).where(RUN.c.number > number).order_by(RUN.c.number).limit(limit),
        limit,
        kinds,
        lambda record: record.number,
    )


def before(
    connection: Connection,
    number: int | None,
    limit: int,
    kinds: Collection[str] | None = None,
    sought: RecordQuery | None = None,
) -> list[RunRecord]:
    """Up to `limit` records with numbers below `number` (None: the latest), the newest first; only of these kinds, and
    only what is sought.
    """
    condition = None if sought is None else sought.condition()

    def order(record: RunRecord) -> int:
        return -record.number

    def chosen() -> _Chosen:
        newest = select(RUN).order_by(RUN.c.number.desc()).limit(limit)
        if condition is not None:
            newest = newest.where(condition)
        return newest if number is None else newest.where(RUN.c.number < number)

    found = [] if not kinds and sought and sought.parts else _page(connection, chosen, limit, kinds, order)
    if sought is None or not sought.parts:
        return found
    with_parts = _records(connection, chosen().where(sought.of_parts(), RUN.c.kind.not_in(kinds or ())))
    return list(heapq.merge(found, with_parts, key=order))[:limit]


def last(connection: Connection, kind: str) -> RunRecord | None:
    """The newest record of a kind."""
    return next(iter(before(connection, None, 1, {kind})), None)


def get(connection: Connection, number: int) -> RunRecord | None:
    """The record of this number; None if there is none, or none any more."""
    return next(iter(_records(connection, select(RUN).where(RUN.c.number == number))), None)


def bounds(connection: Connection) -> tuple[RecordPlace, RecordPlace] | None:
    """The first record that there is and the last one; None if there is none."""
    ends = (select(RUN.c.number, RUN.c.time).order_by(order).limit(1) for order in (RUN.c.number, RUN.c.number.desc()))
    found = [connection.execute(each).one_or_none() for each in ends]
    first, last_ = (None if each is None else RecordPlace(each.number, each.time) for each in found)
    return None if first is None or last_ is None else (first, last_)


def at(connection: Connection, time: float, first: RecordPlace, last_: RecordPlace) -> int:
    """The number of the last record up to a time, among those from `first` to `last_`; below `first` if there is none.

    Where the clock has been set back, one of the records at which it passes that time.
    """
    numbers = range(first.number, last_.number + 1)
    return first.number - 1 + bisect_right(numbers, time, key=lambda number: _time(connection, number))


def _time(connection: Connection, number: int) -> float:
    found: float = connection.execute(select(RUN.c.time).where(RUN.c.number == number)).scalar_one()
    return found


def last_trimmed(connection: Connection) -> ChainPosition:
    """The last record that retention has cut off; `START` if it has cut nothing."""
    return hash_chain.position(connection, RUN_BEGIN) or START


def end(connection: Connection) -> ChainPosition | None:
    """Return where the run ends; None if somebody has taken that out."""
    return hash_chain.position(connection, RUN_END)


def broken_at(connection: Connection) -> int | None:
    """The number of the first record that is not as it was written, or is missing; None when all are whole."""
    first = last_trimmed(connection)
    return hash_chain.broken_at(_everything(connection, first), first, end(connection))


def _everything(connection: Connection, first: ChainPosition) -> Iterator[RunRecord]:
    number = BELOW_ALL if first == START else first.number
    while page := after(connection, number, _PAGE):
        yield from page
        number = page[-1].number


def _page(
    connection: Connection,
    chosen: Callable[[], _Chosen],
    limit: int,
    kinds: Collection[str] | None,
    order: Callable[[RunRecord], int],
) -> list[RunRecord]:
    """Records in order, each kind asked for by itself: so the index has them in order, however many there are."""
    if kinds is None:
        return _records(connection, chosen())
    each = [_records(connection, chosen().where(RUN.c.kind == kind)) for kind in sorted({*kinds})]
    return list(heapq.merge(*each, key=order))[:limit]


def _records(connection: Connection, chosen: _Chosen) -> list[RunRecord]:
    return [RunRecord(*row) for row in connection.execute(chosen)]
