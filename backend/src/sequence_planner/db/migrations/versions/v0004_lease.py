"""The lease of the command over the devices, where several stations share a database."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Boolean, Column, Integer, String

revision = "0004"
down_revision = "0003"

NUMBER = BigInteger().with_variant(Integer, "sqlite")


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "command_lease",
        Column("id", Integer, primary_key=True, autoincrement=False),
        Column("holder", String(100), nullable=False),
        Column("model", String(64), nullable=False),
        Column("epoch", NUMBER, nullable=False),
        Column("renewals", NUMBER, nullable=False),
        Column("free", Boolean, nullable=False),
    )
    op.create_table(
        "standbys",
        Column("name", String(100), primary_key=True),
        Column("model", String(64), nullable=False),
        Column("signs", NUMBER, nullable=False),
    )
