"""Orders that are shown, and their responses, are found however many there were that are not any more."""

from __future__ import annotations

from alembic import op
from sqlalchemy import Column, Double, text

revision = "0008"
down_revision = "0007"

SHOWN = text("removed IS NULL")


def upgrade() -> None:
    """Make the indexes of what is shown; a response then says by itself whether it is."""
    op.add_column("job_responses", Column("removed", Double, nullable=True))
    op.execute(
        "UPDATE job_responses SET removed = "
        "(SELECT job_orders.removed FROM job_orders WHERE job_orders.id = job_responses.job_order)"
    )
    op.drop_index("ix_job_orders_state_number", "job_orders")
    for name, table, columns in (
        ("ix_job_orders_shown", "job_orders", ["number"]),
        ("ix_job_orders_shown_state", "job_orders", ["state", "number"]),
        ("ix_job_responses_shown", "job_responses", ["number"]),
    ):
        op.create_index(name, table, columns, sqlite_where=SHOWN, postgresql_where=SHOWN)
