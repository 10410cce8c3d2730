"""People and actors that tests begin with."""

from __future__ import annotations

import pytest
from sqlalchemy import select

from sequence_planner.auth import sessions, users
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import SignedIn
from sequence_planner.auth.users import Person
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database
from sequence_planner.db.metadata import METADATA
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry
from support.people import CHEAP

NOW = 1_800_000_000.0
HERE, AGENT = "127.0.0.1", "Browser 1.0"
ADA = Actor(kind=ActorKind.PERSON, id="ada", name="Ada")
PASSWORD = "correct horse battery"
BOTH = pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)


def add(database: Database, name: str, role: Role = Role.OPERATOR, *, temporary: bool = False) -> Person:
    """A person with the password of all tests."""
    with database.writing() as connection:
        return users.create(connection, name, role, CHEAP.hash(PASSWORD), ADA, NOW, temporary=temporary)


def signed_in(database: Database, person: Person, now: float = NOW) -> tuple[str, SignedIn]:
    """A session of a person."""
    with database.writing() as connection:
        return sessions.open_session(connection, person, now, kind=ActorKind.PERSON, address=HERE, agent=AGENT)


def is_good(database: Database, token: str, now: float = NOW) -> bool:
    """Whether the token is that of a live session."""
    with database.reading() as connection:
        return sessions.find_session(connection, token, now) is not None


def entries(database: Database, action: str) -> list[Entry]:
    """What the journal says of an action, the newest first."""
    with database.reading() as connection:
        return [record.entry for record in audit.read(connection, action=action, limit=1000)]


def everything_kept(database: Database) -> str:
    """All that is in the database, as text."""
    with database.reading() as connection:
        return "\n".join(repr(row) for table in METADATA.sorted_tables for row in connection.execute(select(table)))
