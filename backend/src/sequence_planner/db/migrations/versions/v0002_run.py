"""The record of what has happened at the station, and signed checkpoints."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Column, Double, Integer, String, Text

revision = "0002"
down_revision = "0001"

NUMBER = BigInteger().with_variant(Integer, "sqlite")
REFUSAL = "the journal is only ever added to"

# Retention moves `run_begin` first, and may then take out what stands before it and nothing else.
GUARDED = {"run": "number", "run_checkpoints": "run_number"}
FORWARD = {
    "sqlite": (
        "CREATE TRIGGER run_begin_forward BEFORE UPDATE ON run_begin WHEN NEW.number < OLD.number "
        f"BEGIN SELECT RAISE(ABORT, '{REFUSAL}'); END",
    ),
    "postgresql": (
        "CREATE TRIGGER run_begin_forward BEFORE UPDATE ON run_begin FOR EACH ROW "
        "WHEN (NEW.number < OLD.number) EXECUTE FUNCTION audit_append_only()",
    ),
}


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "run",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("time", Double, nullable=False),
        Column("kind", String(40), nullable=False),
        Column("content", Text, nullable=False),
        Column("hash", String(64), nullable=False),
    )
    op.create_index("ix_run_kind_number", "run", ["kind", "number"])
    for name in ("run_begin", "run_end"):
        place = op.create_table(
            name,
            Column("id", Integer, primary_key=True, autoincrement=False),
            Column("number", NUMBER, nullable=False),
            Column("hash", String(64), nullable=False),
        )
        op.bulk_insert(place, [{"id": 1, "number": 0, "hash": ""}])
    op.create_table(
        "run_checkpoints",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("run_number", NUMBER, nullable=False),
        Column("content", Text, nullable=False),
        Column("public_key", String(64), nullable=False),
        Column("signature", String(128), nullable=False),
    )
    dialect = op.get_bind().dialect.name
    guards = _sqlite if dialect == "sqlite" else _postgresql
    for table, column in GUARDED.items():
        for statement in guards(table, column):
            op.execute(statement)
    for statement in FORWARD[dialect]:
        op.execute(statement)


def _sqlite(table: str, column: str) -> tuple[str, ...]:
    refuse = f"BEGIN SELECT RAISE(ABORT, '{REFUSAL}'); END"
    return (
        f"CREATE TRIGGER {table}_no_update BEFORE UPDATE ON {table} {refuse}",
        f"CREATE TRIGGER {table}_no_delete BEFORE DELETE ON {table} "
        f"WHEN OLD.{column} > (SELECT number FROM run_begin) {refuse}",
        # INSERT OR REPLACE deletes without asking the trigger above.
        f"CREATE TRIGGER {table}_no_replace BEFORE INSERT ON {table} "
        f"WHEN NEW.number IN (SELECT number FROM {table}) {refuse}",
    )


def _postgresql(table: str, column: str) -> tuple[str, ...]:
    return (
        f"CREATE FUNCTION {table}_no_delete() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN "
        f"IF OLD.{column} > (SELECT number FROM run_begin) THEN "
        f"RAISE EXCEPTION '{REFUSAL}' USING ERRCODE = 'integrity_constraint_violation'; END IF; RETURN OLD; END $$",
        f"CREATE TRIGGER {table}_no_delete BEFORE DELETE ON {table} FOR EACH ROW EXECUTE FUNCTION {table}_no_delete()",
        f"CREATE TRIGGER {table}_append_only BEFORE UPDATE OR TRUNCATE ON {table} "
        "FOR EACH STATEMENT EXECUTE FUNCTION audit_append_only()",
    )
