"""PostgreSQL, a real server: one writer at a time, and what goes wrong in plain words."""

from __future__ import annotations

import socket
import time
import traceback
from collections.abc import Iterator
from contextlib import closing

import psycopg
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import text

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db import postgresql as postgresql_storage
from sequence_planner.db.database import Database
from sequence_planner.db.location import PostgresqlServer, address
from support.examples import examples
from support.postgresql import PASSWORD, USER, Server


@pytest.fixture
def opened(postgresql: Server) -> Iterator[Database]:
    database = Database.open(postgresql.new_database())
    database.upgrade()
    yield database
    database.close()


def _refusal(url: str) -> str:
    with pytest.raises(StorageError) as refusal:
        Database.open(url)
    assert PASSWORD not in "".join(traceback.format_exception(refusal.value))
    return str(refusal.value)


@pytest.mark.parametrize("scheme", ["postgresql", "postgres", "postgresql+psycopg"])
def test_all_ways_to_write_its_url(postgresql: Server, scheme: str) -> None:
    database = Database.open(postgresql.url().replace("postgresql", scheme, 1))
    assert str(database.place) == f"PostgreSQL database postgres at {postgresql.folder}"
    database.close()


def test_what_is_written_is_durable_whatever_the_database_is_set_to(opened: Database) -> None:
    with opened.writing() as connection:
        name = connection.execute(text("SELECT current_database()")).scalar_one()
        connection.execute(text(f"ALTER DATABASE {name} SET synchronous_commit = off"))
        connection.execute(text(f"ALTER DATABASE {name} SET default_transaction_isolation = 'serializable'"))
    opened.close()
    with opened.writing() as connection:
        assert connection.execute(text("SHOW synchronous_commit")).scalar_one() == "on"
        assert connection.execute(text("SHOW transaction_isolation")).scalar_one() == "read committed"
    with opened.reading() as connection:
        assert connection.execute(text("SHOW synchronous_commit")).scalar_one() == "off"
        assert connection.execute(text("SHOW transaction_isolation")).scalar_one() == "repeatable read"


def test_the_writer_is_the_only_one(opened: Database) -> None:
    other = Database.open(_url_of(opened))
    with opened.writing():
        with pytest.raises(StorageError, match="is kept from being written to for more than 5 s"), other.writing():
            pass
        with other.reading() as connection:  # readers do not wait
            assert connection.execute(text("SELECT count(*) FROM audit")).scalar_one() == 0
    with other.writing():
        pass
    other.close()


def test_a_writer_that_stands_still_loses_its_turn(opened: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(postgresql_storage, "LONGEST_STANDSTILL", 0.3)
    written = False
    with pytest.raises(StorageError), opened.writing() as connection:
        time.sleep(0.5)
        with closing(Database.open(_url_of(opened))) as other, other.writing() as its:
            its.execute(text("INSERT INTO first_start_links (token_hash, expires) VALUES ('late', 1)"))
        written = True
        connection.execute(text("SELECT 1"))
    assert written


def test_a_reader_cannot_write(opened: Database) -> None:
    with pytest.raises(StorageError, match="cannot be written to"), opened.reading() as connection:
        connection.execute(text("DELETE FROM first_start_links"))


def test_a_wrong_password(postgresql: Server) -> None:
    place = f"PostgreSQL database postgres at {postgresql.folder}"
    said = _refusal(postgresql.url(password="wrong@" + PASSWORD))
    assert said == f'{place} cannot be reached: password authentication failed for user "{USER}"'


def test_a_database_that_is_not_there(postgresql: Server) -> None:
    assert 'cannot be reached: database "nowhere" does not exist' in _refusal(postgresql.url("nowhere"))


def test_a_server_that_is_not_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    said = _refusal(f"postgresql://{USER}:hidden@127.0.0.1:{port}/station")
    assert said == f"PostgreSQL database station at 127.0.0.1:{port} cannot be reached: Connection refused"


def test_a_server_that_says_nothing_is_waited_for_5_s() -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        said = _refusal(f"postgresql://{USER}:hidden@127.0.0.1:{silent.getsockname()[1]}/station")
    assert said.endswith(" cannot be reached: connection timeout expired")


def test_a_user_without_rights(postgresql: Server) -> None:
    url = postgresql.new_database()
    database = Database.open(url)
    with database.writing() as connection:
        connection.execute(text("DROP ROLE IF EXISTS guest"))
        connection.execute(text("CREATE ROLE guest LOGIN PASSWORD 'guest'"))
    database.close()
    guest = Database.open(url.replace(url.partition("//")[2].partition("@")[0], "guest:guest"))
    with pytest.raises(StorageError, match="gives this user too few rights: let the user own the database"):
        guest.upgrade()
    guest.close()


def test_a_database_that_cannot_keep_every_name(postgresql: Server) -> None:
    url = postgresql.new_database()
    with psycopg.connect(url, autocommit=True) as connection:
        connection.execute("CREATE DATABASE latin ENCODING 'LATIN1' TEMPLATE template0")
    assert "keeps text as LATIN1: make one with createdb --encoding=UTF8" in _refusal(postgresql.url("latin"))


def test_after_the_server_has_ended_connections_it_goes_on(opened: Database, postgresql: Server) -> None:
    with opened.reading() as connection:
        name = connection.execute(text("SELECT current_database()")).scalar_one()
    with psycopg.connect(postgresql.url(), autocommit=True) as killer:
        ended = killer.execute(
            "SELECT pg_terminate_backend(pid, 5000) FROM pg_stat_activity WHERE datname = %s", [name]
        ).fetchall()
    assert ended == [(True,)]
    with opened.writing() as connection:
        assert connection.execute(text("SELECT count(*) FROM audit")).scalar_one() == 0


@examples(300)
@given(st.text(st.characters(min_codepoint=33, max_codepoint=126), min_size=4, max_size=12), st.booleans())
def test_no_place_shows_a_password_even_one_that_is_not_escaped(password: str, named: bool) -> None:
    password = f"{password}hidden"
    try:
        place = address(f"postgresql://{'user' if named else ''}:{password}@host:5432/station")
    except StorageError as refusal:
        assert "hidden" not in str(refusal)
    else:
        assert isinstance(place, PostgresqlServer)
        assert str(place) == "PostgreSQL database station at host:5432"


def _url_of(database: Database) -> str:
    assert isinstance(database.place, PostgresqlServer)
    return database.place.url.render_as_string(hide_password=False)
