"""What engineers think of a revision: verdicts among their comments."""

from __future__ import annotations

from alembic import op
from sqlalchemy import Column, String

revision = "0012"
down_revision = "0011"


def upgrade() -> None:
    """Add what they are about, and what they say."""
    op.add_column("model_comments", Column("revision", String(40)))
    op.add_column("model_comments", Column("verdict", String(20)))
