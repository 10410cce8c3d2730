"""Comments on what is changed in the model, and their table. Times are seconds since the epoch."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import (
    BigInteger,
    Column,
    Connection,
    Double,
    Integer,
    String,
    Table,
    Text,
    delete,
    func,
    insert,
    select,
)

from sequence_planner.core.actor import Actor
from sequence_planner.db.metadata import METADATA

MOST_KEPT = 2000

COMMENTS = Table(
    "model_comments",
    METADATA,
    Column("number", BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=False),
    Column("time", Double, nullable=False),
    Column("by_id", String(200), nullable=False),
    Column("by_name", String(200), nullable=False),
    Column("draft", BigInteger().with_variant(Integer, "sqlite"), nullable=False),  # the change it was made after
    Column("text", Text, nullable=False),
)


@dataclass(frozen=True)
class Comment:
    """What somebody has said of the draft, as it was after its change `draft`; numbers count from 1."""

    number: int
    time: float
    by_id: str
    by_name: str
    draft: int
    text: str


def append_comment(connection: Connection, by: Actor, draft: int, text: str, now: float) -> Comment:
    """Write a comment, within a `writing()` block; the oldest go where there are more than `MOST_KEPT`."""
    number = newest_comment(connection) + 1
    made = Comment(number, now, by.id, by.name, draft, text)
    connection.execute(insert(COMMENTS).values(**vars(made)))
    connection.execute(delete(COMMENTS).where(COMMENTS.c.number <= number - MOST_KEPT))
    return made


def read_comments(connection: Connection, limit: int) -> list[Comment]:
    """The newest comments, in the order in which they were made."""
    chosen = select(COMMENTS).order_by(COMMENTS.c.number.desc()).limit(limit)
    return [Comment(**row) for row in connection.execute(chosen).mappings()][::-1]


def newest_comment(connection: Connection) -> int:
    """The number of the newest comment; 0 where there is none."""
    found: int | None = connection.execute(select(func.max(COMMENTS.c.number))).scalar_one()
    return found or 0
