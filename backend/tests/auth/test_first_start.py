"""The link of the first start."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

from auth.situations import BOTH, HERE, NOW, PASSWORD, add, entries, everything_kept
from sequence_planner.auth import first_start, users
from sequence_planner.auth.roles import IdentityRefused, Role
from sequence_planner.auth.users import Person
from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from support.people import CHEAP

HASH = CHEAP.hash(PASSWORD)


def new_token(database: Database, now: float = NOW) -> str:
    with database.writing() as connection:
        return first_start.new_link_token(connection, now)


def usable(database: Database, token: str, now: float = NOW) -> bool:
    with database.reading() as connection:
        return first_start.link_usable(connection, token, now)


def use(database: Database, token: str, name: str = "Eva", now: float = NOW) -> Person | str:
    try:
        with database.writing() as connection:
            return first_start.use_link(connection, token, name, HASH, now, address=HERE)
    except IdentityRefused as refused:
        return f"{refused.status} {refused.slug}"


def test_the_first_administrator(database: Database) -> None:
    token = new_token(database)
    assert usable(database, token)
    eva = use(database, token)
    assert isinstance(eva, Person)
    assert (eva.role, eva.must_change_password) == (Role.ADMINISTRATOR, False)
    (entry,) = entries(database, "first-administrator")
    assert (entry.actor.id, entry.actor.address, entry.subject) == (eva.id, HERE, "person Eva")
    (entry,) = entries(database, "first-start-link")
    assert entry.actor == SYSTEM
    assert token not in everything_kept(database)


def test_a_link_works_once(database: Database) -> None:
    token = new_token(database)
    assert isinstance(use(database, token), Person)
    assert not usable(database, token)
    assert use(database, token, "Adam") == "403 setup-link-invalid"


@BOTH
def test_a_link_works_once_also_for_two_at_once(database: Database) -> None:
    token = new_token(database)
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda number: use(database, token, f"Eva {number}"), range(8)))
    assert answers.count("403 setup-link-invalid") == 7


def test_a_link_works_for_a_quarter_of_an_hour(database: Database) -> None:
    token = new_token(database)
    assert usable(database, token, NOW + 899)
    assert not usable(database, token, NOW + 900)
    assert use(database, token, now=NOW + 900) == "403 setup-link-invalid"


def test_a_new_link_replaces_the_one_before(database: Database) -> None:
    before, token = new_token(database), new_token(database)
    assert use(database, before) == "403 setup-link-invalid"
    assert isinstance(use(database, token), Person)


@pytest.mark.parametrize("token", ["", "x", "\ud800", "A" * 43])
def test_what_is_no_link(database: Database, token: str) -> None:
    assert use(database, token) == "403 setup-link-invalid"
    new_token(database)
    assert use(database, token) == "403 setup-link-invalid"


def test_no_link_while_there_is_an_administrator(database: Database) -> None:
    token = new_token(database)
    add(database, "Adam", Role.ENGINEER)
    assert usable(database, token)
    add(database, "Ada", Role.ADMINISTRATOR)
    assert not usable(database, token)
    assert use(database, token) == "403 setup-link-invalid"
    with pytest.raises(IdentityRefused) as refused:
        new_token(database)
    assert (refused.value.slug, refused.value.status) == ("administrator-exists", 409)


def test_a_name_that_may_not_be_uses_nothing_up(database: Database) -> None:
    token = new_token(database)
    add(database, "Adam")
    assert use(database, token, "adam") == "409 name-taken"
    assert use(database, token, "\u202e") == "422 invalid-name"
    assert isinstance(use(database, token), Person)
    with database.reading() as connection:
        assert len(users.everybody(connection)) == 2
