"""A database that is empty, gone or cut off where a station was: nothing begins anew there unless somebody says so."""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import text

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal.checkpoints import key_file, signing_key
from sequence_planner.journal.last_accepted import last_word_file


def _station(url: str) -> None:
    """One that has made its tables."""
    with closing(Database.open(url)) as database:
        database.upgrade()


def _refused(url: str) -> str:
    with pytest.raises(StorageError) as refused:
        _station(url)
    return str(refused.value)


def _leave(file: Path, what: str) -> Path:
    """What a station leaves beside its database."""
    left = file.with_name(what)
    if what.endswith((".git", ".backups")):
        left.mkdir()
        (left / "something").write_text("something", encoding="utf-8")
    else:
        left.write_text("something", encoding="utf-8")
    return left


@pytest.mark.parametrize(
    "what",
    [
        "station.sqlite-checkpoint-key.pem",
        "station.sqlite-webhook-key.key",
        "station.sqlite-last-word",
        "station.revisions.git",
        "station.backups",
    ],
)
@pytest.mark.parametrize("how", ["missing", "of no length", "without tables"])
def test_an_empty_file_beside_what_a_station_has_left_is_refused_unless_a_new_one_is_meant(
    tmp_path: Path, what: str, how: str
) -> None:
    file = tmp_path / "station.sqlite"
    url, left = f"sqlite:///{file}", _leave(file, what)
    if how == "of no length":
        file.touch()
    elif how == "without tables":
        with closing(sqlite3.connect(file)) as connection:
            connection.execute("PRAGMA journal_mode = WAL").close()
            connection.execute("PRAGMA user_version = 1").close()
            connection.commit()
        assert file.stat().st_size
    size = file.stat().st_size if file.exists() else None
    said = _refused(url)
    assert str(file) in said and str(left) in said and "run --new" in said
    assert (file.stat().st_size if file.exists() else None) == size, "it is as it was"
    with closing(Database.open(url, new=True)) as database:
        database.upgrade(new=True)
    _station(url)


def test_a_file_of_no_length_with_nothing_beside_it_is_a_new_station(tmp_path: Path) -> None:
    file = tmp_path / "station.sqlite"
    file.touch()
    (tmp_path / "other.sqlite-checkpoint-key.pem").write_text("of another one", encoding="utf-8")
    _station(f"sqlite:///{file}")


def test_a_file_whose_end_is_missing_is_refused_and_stays_as_it_is(tmp_path: Path) -> None:
    file, whole = tmp_path / "station.sqlite", tmp_path / "whole"
    _station(f"sqlite:///{file}")
    assert not Path(f"{file}-wal").exists()
    shutil.copy(file, whole)
    size = file.stat().st_size
    for length in (99, 4096, size // 2, size // 2 + 100, size - 1):
        data = whole.read_bytes()[:length]
        file.write_bytes(data)
        said = _refused(f"sqlite:///{file}")
        assert "move it away and put a copy in its place" in said or "is not a database" in said, length
        assert file.read_bytes() == data
    shutil.copy(whole, file)
    _station(f"sqlite:///{file}")


def test_what_only_the_log_beside_a_file_has_is_not_missing(tmp_path: Path) -> None:
    file = tmp_path / "station.sqlite"
    _station(f"sqlite:///{file}")
    with closing(Database.open(f"sqlite:///{file}")) as database:
        with database.writing() as connection:
            connection.execute(text("CREATE TABLE large (data BLOB)"))
            connection.execute(text("INSERT INTO large VALUES (zeroblob(1000000))"))
        copied = tmp_path / "copied.sqlite"
        for ending in ("", "-wal"):
            shutil.copy(f"{file}{ending}", f"{copied}{ending}")
    with closing(Database.open(f"sqlite:///{copied}")) as database, database.reading() as connection:
        assert connection.execute(text("SELECT length(data) FROM large")).scalar_one() == 1_000_000


def test_a_database_that_lost_its_tables_is_refused_where_a_key_or_the_last_word_of_its_station_is(
    database_url: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "home"))
    with closing(Database.open(database_url)) as database:
        key, word = key_file(database.place), last_word_file(database.place, "press-a")
        signing_key(key)
        assert "run --new" in _refused(database_url)
        key.unlink()
        word.write_text("something", encoding="utf-8")
        assert "run --new" in _refused(database_url)
        word.unlink()
    _station(database_url)
