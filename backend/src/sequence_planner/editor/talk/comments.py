"""Comments on what is changed in the model, verdicts on revisions among them, and their table. Times are seconds since
the epoch.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from sqlalchemy import (
    BigInteger,
    Column,
    Connection,
    Double,
    Integer,
    RowMapping,
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
    Column("revision", String(40)),  # where it is a verdict
    Column("verdict", String(20)),
)


class Verdict(StrEnum):
    """What somebody thinks of a revision; `withdrawn` takes back what they thought before."""

    APPROVED = "approved"
    CHANGES_REQUESTED = "changes-requested"
    WITHDRAWN = "withdrawn"


@dataclass(frozen=True)
class Comment:
    """What somebody has said of the draft, as it was after its change `draft`, or with a `verdict` of a `revision`;
    numbers count from 1.
    """

    number: int
    time: float
    by_id: str
    by_name: str
    draft: int
    text: str
    revision: str | None = None
    verdict: Verdict | None = None


def append_comment(connection: Connection, by: Actor, draft: int, text: str, now: float) -> Comment:
    """Write a comment, within a `writing()` block; the oldest go where there are more than `MOST_KEPT`."""
    return _append(connection, Comment(newest_comment(connection) + 1, now, by.id, by.name, draft, text))


def append_verdict(
    connection: Connection, by: Actor, draft: int, revision: str, verdict: Verdict, text: str, now: float
) -> Comment:
    """Write a verdict on a revision, within a `writing()` block. Verdicts stay."""
    number = newest_comment(connection) + 1
    return _append(connection, Comment(number, now, by.id, by.name, draft, text, revision, verdict))


def _append(connection: Connection, made: Comment) -> Comment:
    connection.execute(insert(COMMENTS).values(**vars(made)))
    old = (COMMENTS.c.number <= made.number - MOST_KEPT) & COMMENTS.c.verdict.is_(None)
    connection.execute(delete(COMMENTS).where(old))
    return made


def read_comments(connection: Connection, limit: int) -> list[Comment]:
    """The newest comments, in the order in which they were made."""
    chosen = select(COMMENTS).order_by(COMMENTS.c.number.desc()).limit(limit)
    return [_comment(row) for row in connection.execute(chosen).mappings()][::-1]


def read_verdicts(connection: Connection) -> list[Comment]:
    """All verdicts, in the order in which they were given."""
    chosen = select(COMMENTS).where(COMMENTS.c.verdict.is_not(None)).order_by(COMMENTS.c.number)
    return [_comment(row) for row in connection.execute(chosen).mappings()]


def newest_comment(connection: Connection) -> int:
    """The number of the newest comment; 0 where there is none."""
    found: int | None = connection.execute(select(func.max(COMMENTS.c.number))).scalar_one()
    return found or 0


def _comment(row: RowMapping) -> Comment:
    verdict = row["verdict"]
    return Comment(**{**row, "verdict": None if verdict is None else Verdict(verdict)})
