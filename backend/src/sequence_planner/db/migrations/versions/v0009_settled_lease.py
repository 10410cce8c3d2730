"""The lease tells up to which holder nothing was accepted that is not recorded."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Column, Integer

revision = "0009"
down_revision = "0008"

NUMBER = BigInteger().with_variant(Integer, "sqlite")


def upgrade() -> None:
    """Add the column; of those before nobody knows."""
    op.add_column("command_lease", Column("settled", NUMBER, nullable=False, server_default="-1"))
