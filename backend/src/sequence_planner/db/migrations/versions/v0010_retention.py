"""Job orders that are over long enough, their events and responses go; their numbers and ids never come again."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Column, Double, Integer, String

revision = "0010"
down_revision = "0009"

NUMBER = BigInteger().with_variant(Integer, "sqlite")


def upgrade() -> None:
    """Make the tables: nothing was cut yet."""
    begin = op.create_table(
        "job_begin",
        Column("id", Integer, primary_key=True, autoincrement=False),
        Column("orders", NUMBER, nullable=False),
        Column("events", NUMBER, nullable=False),
        Column("responses", NUMBER, nullable=False),
    )
    op.bulk_insert(begin, [{"id": 1, "orders": 0, "events": 0, "responses": 0}])
    op.create_table(
        "job_orders_gone",
        Column("id", String(64), primary_key=True),
        Column("ended", Double, nullable=False),
    )
