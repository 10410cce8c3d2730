"""Reading what has happened at the station, in the order in which it did."""

from __future__ import annotations

import heapq
import json
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final, TypeAlias

from sqlalchemy import Connection, Select, select

from sequence_planner.journal import chain
from sequence_planner.journal.chain import BELOW_ALL, START, Link, Position
from sequence_planner.journal.run_tables import RUN, RUN_BEGIN, RUN_END

_Chosen: TypeAlias = Select[*tuple[Any, ...]]

_PAGE: Final = 1000  # records read at once


@dataclass(frozen=True)
class RunRecord(Link):
    """What has happened: `number` counts from 1 without gaps, `time` is in seconds since the epoch.

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
    connection: Connection, number: int | None, limit: int, kinds: Collection[str] | None = None
) -> list[RunRecord]:
    """Up to `limit` records with numbers below `number` (None: the latest), the newest first; only of these kinds."""

    def chosen() -> _Chosen:
        newest = select(RUN).order_by(RUN.c.number.desc()).limit(limit)
        return newest if number is None else newest.where(RUN.c.number < number)

    return _page(connection, chosen, limit, kinds, lambda record: -record.number)


def last(connection: Connection, kind: str) -> RunRecord | None:
    """The newest record of a kind."""
    return next(iter(before(connection, None, 1, {kind})), None)


def get(connection: Connection, number: int) -> RunRecord | None:
    """The record of this number; None if there is none, or none any more."""
    return next(iter(_records(connection, select(RUN).where(RUN.c.number == number))), None)


def begin(connection: Connection) -> Position:
    """The last record that retention has cut off; `START` if it has cut nothing."""
    return chain.position(connection, RUN_BEGIN) or START


def end(connection: Connection) -> Position | None:
    """Where the run ends; None if somebody has taken that out."""
    return chain.position(connection, RUN_END)


def broken_at(connection: Connection) -> int | None:
    """The number of the first record that is not as it was written, or is missing; None when all are whole."""
    first = begin(connection)
    return chain.broken_at(_everything(connection, first), first, end(connection))


def _everything(connection: Connection, first: Position) -> Iterator[RunRecord]:
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
