"""What engineers say to one another about the changes of the model."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Column, Double, Integer, String, Text

revision = "0011"
down_revision = "0010"

NUMBER = BigInteger().with_variant(Integer, "sqlite")


def upgrade() -> None:
    """Make the table."""
    op.create_table(
        "model_comments",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("time", Double, nullable=False),
        Column("by_id", String(200), nullable=False),
        Column("by_name", String(200), nullable=False),
        Column("draft", NUMBER, nullable=False),
        Column("text", Text, nullable=False),
    )
