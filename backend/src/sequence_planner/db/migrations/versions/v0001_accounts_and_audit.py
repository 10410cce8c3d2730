"""People, their sessions, keys and watches, and the record of who did what."""

from __future__ import annotations

from alembic import op
from sqlalchemy import BigInteger, Boolean, Column, Double, ForeignKey, Integer, String, Text

revision = "0001"
down_revision = None

ID = String(40)
HASH = String(64)
NAME = String(100)
TEXT = String(200)
NUMBER = BigInteger().with_variant(Integer, "sqlite")

REFUSAL = "the journal is only ever added to"
APPEND_ONLY = {
    "sqlite": (
        f"CREATE TRIGGER audit_no_update BEFORE UPDATE ON audit BEGIN SELECT RAISE(ABORT, '{REFUSAL}'); END",
        f"CREATE TRIGGER audit_no_delete BEFORE DELETE ON audit BEGIN SELECT RAISE(ABORT, '{REFUSAL}'); END",
        # INSERT OR REPLACE deletes without asking the trigger above.
        "CREATE TRIGGER audit_no_replace BEFORE INSERT ON audit WHEN NEW.number IN (SELECT number FROM audit) "
        f"BEGIN SELECT RAISE(ABORT, '{REFUSAL}'); END",
    ),
    "postgresql": (
        "CREATE FUNCTION audit_append_only() RETURNS trigger LANGUAGE plpgsql AS "
        f"$$ BEGIN RAISE EXCEPTION '{REFUSAL}' USING ERRCODE = 'integrity_constraint_violation'; END $$",
        "CREATE TRIGGER audit_append_only BEFORE UPDATE OR DELETE OR TRUNCATE ON audit "
        "FOR EACH STATEMENT EXECUTE FUNCTION audit_append_only()",
    ),
}


def upgrade() -> None:
    """Make the tables."""
    _people()
    _keys_and_watches()
    _audit()


def _people() -> None:
    op.create_table(
        "people",
        Column("id", ID, primary_key=True),
        Column("name", NAME, nullable=False),
        Column("name_key", String(400), nullable=False, unique=True),
        Column("name_shape", String(2000), nullable=False, unique=True),
        Column("role", String(20), nullable=False),
        Column("created", Double, nullable=False),
        Column("disabled", Boolean, nullable=False),
        Column("must_change_password", Boolean, nullable=False),
        Column("password_hash", String(300), nullable=False),
        Column("revision", Integer, nullable=False),
    )
    op.create_table(
        "sessions",
        Column("id", ID, primary_key=True),
        Column("token_hash", HASH, nullable=False, unique=True),
        Column("person", ID, ForeignKey("people.id"), nullable=True, index=True),
        Column("created", Double, nullable=False),
        Column("expires", Double, nullable=False),
        Column("last_seen", Double, nullable=False),
        Column("address", TEXT, nullable=False),
        Column("agent", TEXT, nullable=False),
    )
    op.create_table(
        "attempts",
        Column("kind", String(20), primary_key=True),
        Column("subject", HASH, primary_key=True),
        Column("wrong", Integer, nullable=False),
        Column("since", Double, nullable=False),
        Column("last", Double, nullable=False, index=True),
        Column("blocked_until", Double, nullable=False),
    )
    op.create_table(
        "first_start_links",
        Column("token_hash", HASH, primary_key=True),
        Column("expires", Double, nullable=False),
    )


def _keys_and_watches() -> None:
    op.create_table(
        "keys",
        Column("id", ID, primary_key=True),
        Column("secret_hash", HASH, nullable=False),
        Column("name", NAME, nullable=False),
        Column("scopes", TEXT, nullable=False),
        Column("created", Double, nullable=False),
        Column("created_by", TEXT, nullable=False),
        Column("expires", Double, nullable=False),
        Column("last_used", Double, nullable=True),
        Column("revoked", Double, nullable=True),
    )
    op.create_table(
        "pairing_offers",
        Column("id", ID, primary_key=True),
        Column("code_hash", HASH, nullable=False),
        Column("name", NAME, nullable=False),
        Column("name_key", String(400), nullable=False),
        Column("resource", TEXT, nullable=False),
        Column("offered_by", TEXT, nullable=False),
        Column("expires", Double, nullable=False),
    )
    op.create_table(
        "watches",
        Column("id", ID, primary_key=True),
        Column("token_hash", HASH, nullable=False, unique=True),
        Column("name", NAME, nullable=False),
        Column("name_key", String(400), nullable=False),
        Column("resource", TEXT, nullable=False),
        Column("paired_by", TEXT, nullable=False),
        Column("created", Double, nullable=False),
        Column("confirmed", Double, nullable=True),
        Column("expires", Double, nullable=False),
        Column("last_seen", Double, nullable=False),
        Column("revoked", Double, nullable=True),
        Column("address", TEXT, nullable=False),
        Column("agent", TEXT, nullable=False),
    )


def _audit() -> None:
    op.create_table(
        "audit",
        Column("number", NUMBER, primary_key=True, autoincrement=False),
        Column("time", Double, nullable=False),
        Column("action", String(100), nullable=False, index=True),
        Column("actor", String(200), nullable=False, index=True),
        Column("entry", Text, nullable=False),
        Column("hash", String(64), nullable=False),
    )
    end = op.create_table(
        "audit_end",
        Column("id", Integer, primary_key=True, autoincrement=False),
        Column("number", NUMBER, nullable=False),
        Column("hash", String(64), nullable=False),
    )
    op.bulk_insert(end, [{"id": 1, "number": 0, "hash": ""}])
    for statement in APPEND_ONLY[op.get_bind().dialect.name]:
        op.execute(statement)
