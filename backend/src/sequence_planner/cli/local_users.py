"""The work of `users` in the database, in the name of the program: who may run it has the database in hand anyway."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass

from sequence_planner.auth.first_start import new_link_token
from sequence_planner.auth.passwords import Passwords, check_password
from sequence_planner.auth.roles import IdentityRefused, Role
from sequence_planner.auth.tokens import clean_name
from sequence_planner.auth.users import Person, create, everybody, find_by_name, get_user, set_password
from sequence_planner.cli.local_actor import at_the_command_line
from sequence_planner.core.actor import Actor
from sequence_planner.db.database import Database
from sequence_planner.texts.message import message


@dataclass(frozen=True)
class PeopleAtHand:
    """The people of an open database. What is not done is raised as `IdentityRefused` or `StorageError`."""

    database: Database
    by: Actor

    def everybody(self) -> list[Person]:
        """All people, by name."""
        with self.database.reading() as connection:
            return everybody(connection)

    def add(self, name: str, role: Role, ask: Callable[[], str]) -> Person:
        """Add a person; `ask` gets the password, which is temporary."""
        hashed = _hash(ask(), clean_name(name))
        with self.database.writing() as connection:
            return create(connection, name, role, hashed, self.by, time.time(), temporary=True)

    def reset(self, name: str, ask: Callable[[], str]) -> Person:
        """Give a person another password, which is temporary."""
        with self.database.reading() as connection:
            person = find_by_name(connection, name)
        if person is None:
            raise IdentityRefused("no-user", message("refused.no-user.name", name=name), 404)
        hashed = _hash(ask(), person.name)
        with self.database.writing() as connection:
            set_password(connection, person.id, hashed, self.by, time.time(), temporary=True, recovery=True)
            return get_user(connection, person.id)

    def link_token(self) -> str:
        """The token of a new link for the first administrator."""
        with self.database.writing() as connection:
            return new_link_token(connection, time.time())


@contextmanager
def people_at_hand(url: str) -> Iterator[PeopleAtHand]:
    """Open a database, which is made if there is none."""
    with closing(Database.open(url)) as database:
        database.upgrade()
        yield PeopleAtHand(database, at_the_command_line())


def _hash(password: str, name: str) -> str:
    check_password(password, name)
    with closing(Passwords()) as passwords:
        return asyncio.run(passwords.hash(password))
