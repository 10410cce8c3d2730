"""People for whom a provider vouches, their sign-ins under way, and the secret of a key before its last rotation."""

from __future__ import annotations

from alembic import op
from sqlalchemy import Column, Double, String

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
    """Add the columns, and make the table."""
    op.add_column("people", Column("issuer", String(400), nullable=True))
    op.add_column("people", Column("subject", String(255), nullable=True))
    op.create_index("ix_people_issuer_subject", "people", ["issuer", "subject"], unique=True)
    op.create_table(
        "provider_flows",
        Column("token_hash", String(64), primary_key=True),
        Column("page", String(2000), nullable=False),
        Column("expires", Double, nullable=False),
    )
    op.create_index("ix_provider_flows_expires", "provider_flows", ["expires"])
    op.add_column("keys", Column("former_hash", String(64), nullable=True))
    op.add_column("keys", Column("former_until", Double, nullable=True))
