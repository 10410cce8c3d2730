"""Runs migrations on the connection that `upgrading` hands over; alembic demands this file."""

from alembic import context

from sequence_planner.db.metadata import METADATA

context.configure(connection=context.config.attributes["connection"], target_metadata=METADATA)
context.run_migrations()
