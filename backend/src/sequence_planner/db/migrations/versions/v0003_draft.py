"""The draft of the station's model, and who changed what in it."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Column, Double, Integer, String, Text

revision = "0003"
down_revision = "0002"

NUMBER = BigInteger().with_variant(Integer, "sqlite")


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "draft_files",
        Column("path", String(300), primary_key=True),
        Column("text", Text, nullable=True),
        Column("base", Text, nullable=True),
    )
    op.create_table(
        "draft_changes",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("time", Double, nullable=False),
        Column("by_id", String(200), nullable=False),
        Column("by_name", String(200), nullable=False),
        Column("kind", String(20), nullable=False),
        Column("of", NUMBER, nullable=True),
        Column("title", String(300), nullable=False),
        Column("files", Text, nullable=False),
    )
