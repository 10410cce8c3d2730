"""Keys of systems."""

from __future__ import annotations

import pytest

from auth.situations import ADA, BOTH, HERE, NOW, entries, everything_kept
from sequence_planner.auth import api_keys
from sequence_planner.auth.api_keys import DAY, Key
from sequence_planner.auth.login import clear
from sequence_planner.auth.roles import IdentityRefused, Scope
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.db.database import Database


def make(database: Database, *scopes: Scope, days: int = 30, name: str = "MES") -> tuple[str, Key]:
    with database.writing() as connection:
        return api_keys.make_key(connection, name, frozenset(scopes or {Scope.READ}), days, ADA, NOW)


def found(database: Database, secret: str, now: float = NOW) -> Key | None:
    with database.reading() as connection:
        return api_keys.find_key(connection, secret, now)


@BOTH
def test_a_key_opens_what_it_is_for(database: Database) -> None:
    secret, key = make(database, Scope.AUDIT, Scope.READ)
    assert found(database, secret) == key
    assert key.scopes == (Scope.READ, Scope.AUDIT)
    assert (key.created_by, key.expires, key.last_used, key.revoked) == ("Ada", NOW + 30 * DAY, None, None)
    assert key.actor(HERE) == Actor(kind=ActorKind.KEY, id=key.id, name="MES", address=HERE)
    (entry,) = entries(database, "key-created")
    assert entry.details == {"id": key.id, "scopes": "read audit", "expires": key.expires}


def test_the_secret_is_shown_once_and_kept_nowhere(database: Database) -> None:
    secret, key = make(database)
    assert secret.startswith(f"sp_{key.id}_")
    assert secret not in everything_kept(database)
    assert secret.removeprefix(f"sp_{key.id}_") not in everything_kept(database)


@BOTH
def test_other_secrets_open_nothing(database: Database) -> None:
    secret, key = make(database)
    other, _ = make(database)
    mixed = f"sp_{key.id}_{other.split('_', 2)[2]}"
    for wrong in (
        "",
        "sp_",
        key.id,
        secret[:-1],
        secret + "A",
        secret + "\n",
        secret.upper(),
        mixed,
        "\ud800",
        "sp_'_x",
    ):
        assert found(database, wrong) is None


def test_a_key_expires(database: Database) -> None:
    secret, _ = make(database, days=1)
    assert found(database, secret, NOW + DAY - 1) is not None
    assert found(database, secret, NOW + DAY) is None


def test_a_key_is_revoked_at_once_and_for_good(database: Database) -> None:
    secret, key = make(database)
    other, _ = make(database)
    for _ in range(2):
        with database.writing() as connection:
            api_keys.revoke_key(connection, key.id, ADA, NOW + 5)
    assert found(database, secret) is None
    assert found(database, other) is not None
    assert len(entries(database, "key-revoked")) == 1
    with database.reading() as connection:
        assert {each.revoked for each in api_keys.all_keys(connection) if each.id == key.id} == {NOW + 5}


@pytest.mark.parametrize("id", ["", "0" * 16, "\0", "\ud800", "x" * 500])
def test_what_is_no_key_is_not_revoked(database: Database, id: str) -> None:
    with pytest.raises(IdentityRefused) as refused, database.writing() as connection:
        api_keys.revoke_key(connection, id, ADA, NOW)
    assert (refused.value.slug, refused.value.status) == ("no-key", 404)


@pytest.mark.parametrize(
    ("name", "scopes", "days", "slug"),
    [
        ("", {Scope.READ}, 1, "invalid-name"),
        ("MES", set(), 1, "no-scope"),
        ("MES", {Scope.READ}, 0, "invalid-days"),
        ("MES", {Scope.READ}, 731, "invalid-days"),
    ],
)
def test_keys_that_cannot_be(database: Database, name: str, scopes: set[Scope], days: int, slug: str) -> None:
    with pytest.raises(IdentityRefused) as refused, database.writing() as connection:
        api_keys.make_key(connection, name, frozenset(scopes), days, ADA, NOW)
    assert (refused.value.slug, refused.value.status) == (slug, 422)


def test_use_is_noted_at_most_once_a_minute(database: Database) -> None:
    secret, key = make(database)

    def last_used(now: float) -> float | None:
        with database.writing() as connection:
            api_keys.used(connection, key.id, now)
            (only,) = api_keys.all_keys(connection)
            return only.last_used

    assert key.due(NOW)
    assert [last_used(NOW + pause) for pause in (0, 59, 60)] == [NOW, NOW, NOW + 60]
    after = found(database, secret)
    assert after is not None
    assert [after.due(NOW + pause) for pause in (119, 120)] == [False, True]


@BOTH
def test_keys_that_work_no_more_are_listed_for_ninety_days(database: Database) -> None:
    _, expired = make(database, days=1)
    _, revoked = make(database)
    with database.writing() as connection:
        api_keys.revoke_key(connection, revoked.id, ADA, NOW)
        clear(connection, NOW + 90 * DAY - 1)
        assert len(api_keys.all_keys(connection)) == 2
        clear(connection, NOW + 90 * DAY)
        assert [each.id for each in api_keys.all_keys(connection)] == [expired.id]
        clear(connection, NOW + 91 * DAY)
        assert api_keys.all_keys(connection) == []
