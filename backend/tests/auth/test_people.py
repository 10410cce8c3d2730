"""People: added once, changed with care, out at once when disabled, and never without an administrator."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

from auth.situations import ADA, BOTH, HERE, NOW, PASSWORD, add, entries, is_good, signed_in
from sequence_planner.auth import sessions, users
from sequence_planner.auth.roles import IdentityRefused, Role
from sequence_planner.auth.users import DEMONSTRATOR, Person
from sequence_planner.core.actor import ActorKind
from sequence_planner.db.database import Database
from support.people import CHEAP


def change(
    database: Database, person: Person, *, role: Role | None = None, disabled: bool | None = None
) -> Person | str:
    """The person as changed, or why not."""
    try:
        with database.writing() as connection:
            return users.change(connection, person.id, person.revision, ADA, NOW, role=role, disabled=disabled)
    except IdentityRefused as refused:
        return f"{refused.status} {refused.slug}"


def now_known(database: Database, person: Person) -> Person | None:
    with database.reading() as connection:
        return users.find(connection, person.id)


@BOTH
def test_somebody_is_added(database: Database) -> None:
    eva = add(database, "  Eva  Lind", Role.ENGINEER, temporary=True)
    assert (eva.name, eva.role, eva.disabled, eva.must_change_password) == ("Eva Lind", Role.ENGINEER, False, True)
    adam = add(database, "Adam")
    with database.reading() as connection:
        assert users.everybody(connection) == [adam, eva]
        assert users.find(connection, eva.id) == eva
        assert users.find_by_name(connection, "eva LIND ") == eva
        assert users.find_by_name(connection, "Eva") is None
    entry = entries(database, "person-created")[1]
    assert (entry.actor, entry.subject) == (ADA, "person Eva Lind")
    assert entry.details == {"id": eva.id, "role": "engineer", "temporary_password": True}


@pytest.mark.parametrize("name", ["eva", "EVA ", "Еva", "Ev\u00e1", "Demonstration", "sequence planner"])
def test_nobody_goes_by_a_name_that_is_mistaken(database: Database, name: str) -> None:
    add(database, "Eva")
    with pytest.raises(IdentityRefused) as refused:
        add(database, name)
    assert (refused.value.slug, refused.value.status) == ("name-taken", 409)
    assert len(entries(database, "person-created")) == 1


@BOTH
def test_of_two_who_take_a_name_at_once_one_gets_it(database: Database) -> None:
    def attempt(_: int) -> bool:
        try:
            add(database, "Eva")
        except IdentityRefused:
            return False
        return True

    with ThreadPoolExecutor(4) as pool:
        assert sum(pool.map(attempt, range(8))) == 1


@BOTH
@pytest.mark.parametrize("id", ["", "nobody", "\0", "\ud800", "' OR 1=1", "x" * 1000, DEMONSTRATOR.id])
def test_what_is_no_id_finds_nobody(database: Database, id: str) -> None:
    with database.reading() as connection:
        assert users.find(connection, id) is None
    with pytest.raises(IdentityRefused) as refused, database.writing() as connection:
        users.change(connection, id, 1, ADA, NOW, role=Role.VIEWER)
    assert (refused.value.slug, refused.value.status) == ("no-user", 404)


@BOTH
def test_a_change_is_made_and_recorded(database: Database) -> None:
    eva = add(database, "Eva")
    changed = change(database, eva, role=Role.ENGINEER)
    assert isinstance(changed, Person)
    assert changed == now_known(database, eva)
    assert (changed.role, changed.revision) == (Role.ENGINEER, eva.revision + 1)
    (entry,) = entries(database, "person-changed")
    assert entry.details == {"id": eva.id, "role": ["operator", "engineer"], "sessions_ended": 0}


def test_what_changes_nothing_is_no_change(database: Database) -> None:
    eva = add(database, "Eva")
    token, _ = signed_in(database, eva)
    assert change(database, eva, role=Role.OPERATOR, disabled=False) == eva
    assert is_good(database, token)
    assert not entries(database, "person-changed")


@pytest.mark.parametrize("revision", [0, 2, -1, 10**30])
def test_of_two_who_change_a_person_the_second_notices(database: Database, revision: int) -> None:
    eva = add(database, "Eva")
    assert change(database, eva.model_copy(update={"revision": revision}), disabled=True) == "412 user-changed"
    assert now_known(database, eva) == eva


@BOTH
def test_who_is_disabled_or_has_another_role_is_out_at_once(database: Database) -> None:
    eva, adam = add(database, "Eva"), add(database, "Adam")
    hers, his = signed_in(database, eva)[0], signed_in(database, adam)[0]
    also_hers = signed_in(database, eva)[0]
    changed = change(database, eva, role=Role.VIEWER)
    assert isinstance(changed, Person)
    assert [is_good(database, each) for each in (hers, also_hers, his)] == [False, False, True]
    hers = signed_in(database, changed)[0]
    disabled = change(database, changed, disabled=True)
    assert isinstance(disabled, Person)
    assert not is_good(database, hers)
    assert isinstance(change(database, disabled, disabled=False), Person)
    assert not is_good(database, hers)
    assert entries(database, "person-changed")[2].details["sessions_ended"] == 2


def test_a_session_opened_for_somebody_who_is_disabled_is_none(database: Database) -> None:
    eva = add(database, "Eva")
    change(database, eva, disabled=True)
    token, opened = signed_in(database, eva)
    with database.reading() as connection:
        assert sessions.find_session(connection, token, NOW) is None
        assert sessions.find_live(connection, opened.session, NOW) is None
        assert sessions.live_sessions(connection, eva.id, NOW) == []


def test_the_last_administrator_stays(database: Database) -> None:
    eva = add(database, "Eva", Role.ADMINISTRATOR)
    adam = add(database, "Adam", Role.ADMINISTRATOR)
    adam_disabled = change(database, adam, disabled=True)
    assert isinstance(adam_disabled, Person)
    assert change(database, eva, role=Role.ENGINEER) == "409 last-administrator"
    assert change(database, eva, disabled=True) == "409 last-administrator"
    assert isinstance(change(database, adam_disabled, disabled=False), Person)
    assert isinstance(change(database, eva, role=Role.ENGINEER), Person)
    with database.reading() as connection:
        assert users.administrator_exists(connection)


@BOTH
def test_two_administrators_who_put_each_other_out_at_once(database: Database) -> None:
    for round in range(6):
        both = [add(database, f"{name} {round}", Role.ADMINISTRATOR) for name in ("Eva", "Adam")]
        before = [each for each in _administrators(database) if each not in both]
        for each in before:
            assert isinstance(change(database, each, role=Role.VIEWER), Person)
        with ThreadPoolExecutor(2) as pool:
            answers = list(pool.map(lambda each: change(database, each, disabled=True), both))
        assert answers.count("409 last-administrator") == 1
        assert len(_administrators(database)) == 1


def _administrators(database: Database) -> list[Person]:
    with database.reading() as connection:
        everybody = users.everybody(connection)
    return [each for each in everybody if each.role is Role.ADMINISTRATOR and not each.disabled]


def test_a_password_is_set_for_somebody(database: Database) -> None:
    eva = add(database, "Eva")
    token, _ = signed_in(database, eva)
    with database.writing() as connection:
        users.set_password(connection, eva.id, CHEAP.hash("another fine password"), ADA, NOW, temporary=True)
    changed = now_known(database, eva)
    assert changed is not None
    assert (changed.must_change_password, changed.revision) == (True, eva.revision + 1)
    assert not is_good(database, token)
    (entry,) = entries(database, "password-reset")
    assert entry.subject == "person Eva"
    with database.reading() as connection:
        found = users.find_password(connection, "eva")
    assert found is not None
    assert CHEAP.verify(found[1], "another fine password")
    assert PASSWORD not in repr(entry)


def test_whoever_sits_at_a_demonstration_is_nobody_of_the_database(database: Database) -> None:
    with database.writing() as connection:
        token, opened = sessions.open_session(
            connection, DEMONSTRATOR, NOW, kind=ActorKind.DEMONSTRATION, address=HERE, agent=""
        )
        assert users.everybody(connection) == []
        assert not users.administrator_exists(connection)
        assert sessions.find_session(connection, token, NOW) is None
        assert sessions.find_session(connection, token, NOW, demonstration=True) == opened
        assert sessions.live_counts(connection, NOW) == {}
    assert not DEMONSTRATOR.role.includes(Role.ADMINISTRATOR)
    assert opened.actor(HERE).kind is ActorKind.DEMONSTRATION
