"""Chained records: each has a hash over itself and the hash of the one before, so that a change shows."""

from __future__ import annotations

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Final

from sqlalchemy import (
    BigInteger,
    Column,
    Connection,
    Integer,
    String,
    Table,
    Update,
    bindparam,
    select,
    update,
)

from sequence_planner.db.metadata import METADATA

NUMBER: Final = BigInteger().with_variant(Integer, "sqlite")
BELOW_ALL: Final = -(2**63)  # also below numbers that were never given


@dataclass(frozen=True)
class ChainPosition:
    """A place in a chain: the number and the hash of a record."""

    number: int
    hash: str


START: Final = ChainPosition(0, "")
"""Before the first record."""


class ChainLink(ABC):
    """A record of a chain."""

    number: int
    hash: str

    @abstractmethod
    def text(self) -> str:
        """It as a line of JSON, up to its hash."""

    def line(self) -> str:
        """The record as a line of JSON that anybody can verify: the hash is over all that stands before it.

        It is the SHA-256 over the hash of the record before (nothing, for the first), and the line up to `,"hash":`.
        """
        return f'{self.text()},"hash":"{self.hash}"}}'

    def is_whole(self, before: str) -> bool:
        """Return whether it is what was written behind a record with the hash `before`."""
        return self.hash == digest(before, self.text())


def digest(before: str, text: str) -> str:
    """The hash of a record with this text, behind one with the hash `before`."""
    return hashlib.sha256((before + text).encode()).hexdigest()


def broken_at(links: Iterable[ChainLink], begin: ChainPosition, end: ChainPosition | None) -> int | None:
    """The number of the first record that is not as it was written, or is missing; None when all are whole.

    `links` are those behind `begin`, in order; `end` is where the chain was said to end, None if that is not known.
    """
    number, last = begin.number, begin.hash
    for link in links:
        number += 1
        if link.number != number or not link.is_whole(last):
            return number
        last = link.hash
    if end is None or end.number > number:
        return number + 1
    return None if end == ChainPosition(number, last) else number


def position_table(name: str) -> Table:
    """A table of one row, which holds a place in a chain."""
    return Table(
        name,
        METADATA,
        Column("id", Integer, primary_key=True, autoincrement=False),
        Column("number", NUMBER, nullable=False),
        Column("hash", String(64), nullable=False),
    )


def position(connection: Connection, table: Table) -> ChainPosition | None:
    """The place that a table holds; None if somebody has taken it out."""
    found = connection.execute(select(table.c.number, table.c.hash)).one_or_none()
    return None if found is None else ChainPosition(found.number, found.hash)


def move(connection: Connection, table: Table, to: ChainPosition, source: ChainPosition) -> bool:
    """Let a table hold another place; whether it held `source`, as otherwise nothing is done."""
    values = {"number": to.number, "hash": to.hash, "from_number": source.number, "from_hash": source.hash}
    return connection.execute(_moving(table), values).rowcount == 1


@cache
def _moving(table: Table) -> Update:
    """Made once, which takes longer than to carry it out."""
    found = (table.c.number == bindparam("from_number"), table.c.hash == bindparam("from_hash"))
    return update(table).where(*found).values(number=bindparam("number"), hash=bindparam("hash"))
