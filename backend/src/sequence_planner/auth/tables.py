"""The tables of this package. Times are seconds since the epoch; of tokens, codes and keys only hashes are kept.

A session, a link or an offer that has ended is a row that is gone; keys and watches stay a while to be looked up. What
was done is in the journal, which forgets nothing.
"""

from __future__ import annotations

from sqlalchemy import Boolean, Column, Double, ForeignKey, Index, Integer, String, Table

from sequence_planner.auth.oidc.addresses import LONGEST_ISSUER
from sequence_planner.db.metadata import METADATA

ID = String(40)
HASH = String(64)  # SHA-256 in hexadecimal digits
NAME = String(100)
TEXT = String(200)
LONGEST_KEY = 400  # characters of what a name is found by

PEOPLE = Table(
    "people",
    METADATA,
    Column("id", ID, primary_key=True),
    Column("name", NAME, nullable=False),
    Column("name_key", String(LONGEST_KEY), nullable=False, unique=True),  # what the name is found by: see `names`
    Column("name_shape", String(2000), nullable=False, unique=True),  # what it looks like
    Column("role", String(20), nullable=False),
    Column("created", Double, nullable=False),
    Column("disabled", Boolean, nullable=False),
    Column("must_change_password", Boolean, nullable=False),
    Column("password_hash", String(300), nullable=False),  # argon2id with its parameters and salt
    Column("revision", Integer, nullable=False),
    Column("issuer", String(LONGEST_ISSUER), nullable=True),  # the provider that vouches; none: a password here
    Column("subject", String(255), nullable=True),  # who it is for the provider
    Index("ix_people_issuer_subject", "issuer", "subject", unique=True),
)

SESSIONS = Table(
    "sessions",
    METADATA,
    Column("id", ID, primary_key=True),
    Column("token_hash", HASH, nullable=False, unique=True),
    Column("person", ID, ForeignKey("people.id"), nullable=True, index=True),  # none: a demonstration
    Column("created", Double, nullable=False),
    Column("expires", Double, nullable=False),
    Column("last_seen", Double, nullable=False),
    Column("address", TEXT, nullable=False),
    Column("agent", TEXT, nullable=False),
)

ATTEMPTS = Table(
    "attempts",
    METADATA,
    Column("kind", String(20), primary_key=True),
    Column("subject", HASH, primary_key=True),
    Column("wrong", Integer, nullable=False),
    Column("since", Double, nullable=False),  # when counting began
    Column("last", Double, nullable=False, index=True),
    Column("blocked_until", Double, nullable=False),
)

FIRST_START_LINKS = Table(
    "first_start_links",
    METADATA,
    Column("token_hash", HASH, primary_key=True),
    Column("expires", Double, nullable=False),
)

KEYS = Table(
    "keys",
    METADATA,
    Column("id", ID, primary_key=True),
    Column("secret_hash", HASH, nullable=False),
    Column("name", NAME, nullable=False),
    Column("scopes", TEXT, nullable=False),  # divided by blanks
    Column("created", Double, nullable=False),
    Column("created_by", TEXT, nullable=False),
    Column("expires", Double, nullable=False),
    Column("last_used", Double, nullable=True),
    Column("revoked", Double, nullable=True),
    Column("former_hash", HASH, nullable=True),  # of the secret before the last rotation
    Column("former_until", Double, nullable=True),  # when that one works no more
)

PROVIDER_FLOWS = Table(
    "provider_flows",
    METADATA,
    Column("token_hash", HASH, primary_key=True),
    Column("page", String(2000), nullable=False),  # of this server, where the sign-in leads
    Column("expires", Double, nullable=False, index=True),
)

PAIRING_OFFERS = Table(
    "pairing_offers",
    METADATA,
    Column("id", ID, primary_key=True),
    Column("code_hash", HASH, nullable=False),
    Column("name", NAME, nullable=False),
    Column("name_key", String(LONGEST_KEY), nullable=False),
    Column("resource", TEXT, nullable=False),
    Column("offered_by", TEXT, nullable=False),
    Column("expires", Double, nullable=False),
)

WATCHES = Table(
    "watches",
    METADATA,
    Column("id", ID, primary_key=True),
    Column("token_hash", HASH, nullable=False, unique=True),
    Column("name", NAME, nullable=False),
    Column("name_key", String(LONGEST_KEY), nullable=False),
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
