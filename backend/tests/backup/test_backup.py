"""Backups of both databases, made while somebody writes, and put in place again."""

from __future__ import annotations

import contextlib
import io
import json
import shutil
import tarfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from journal.acts import act, filled
from journal.happened import happened
from sequence_planner.auth import users
from sequence_planner.auth.roles import Role
from sequence_planner.auth.sessions import find_session, open_session
from sequence_planner.backup import archive
from sequence_planner.backup.service import back_up, restore
from sequence_planner.core.actor import SYSTEM, ActorKind
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import PostgresqlServer, address, revisions_folder
from sequence_planner.editor.revisions import Revisions
from sequence_planner.journal import audit, checkpoints, run_journal
from sequence_planner.journal.checkpoints import key_file
from sequence_planner.journal.verify import verify
from sequence_planner.model.files import read_files
from support.commands import command
from support.places import CELL
from support.postgresql import Server

Anew = Callable[[], str]


@pytest.fixture
def model(tmp_path: Path) -> Path:
    folder = tmp_path / "cell"
    shutil.copytree(CELL, folder)
    return folder


@pytest.fixture
def anew(database_url: str, tmp_path: Path, request: pytest.FixtureRequest) -> Anew:
    """Names an empty database of the same kind as `database_url`."""
    if database_url.startswith("sqlite"):
        return lambda: f"sqlite:///{tmp_path}/elsewhere/station.sqlite"
    server: Server = request.getfixturevalue("postgresql")
    return server.new_database


@pytest.fixture
def at_work(database: Database, database_url: str, model: Path) -> Iterator[str]:
    """The token of somebody who is signed in at a station with a journal, a checkpoint and a revision."""
    filled(database, 20)
    happened(database, range(1, 31))
    checkpoints.make(database, 31.0)
    files = read_files(model)
    folder = revisions_folder(database_url, model)
    shutil.rmtree(folder, ignore_errors=True)
    Revisions(folder).save(files, files, "First", "", SYSTEM, 40.0)
    with database.writing() as connection:
        person = users.create(connection, "Eva", Role.ENGINEER, "none", SYSTEM, time.time(), temporary=False)
        token, _ = open_session(connection, person, time.time(), kind=ActorKind.PERSON, address="", agent="")
    yield token
    shutil.rmtree(folder, ignore_errors=True)


@contextlib.contextmanager
def opened(url: str) -> Iterator[Database]:
    with contextlib.closing(Database.open(url, create=False)) as database:
        yield database


def test_what_was_there_is_there_again_and_everybody_has_to_sign_in(
    at_work: str, database_url: str, anew: Anew, model: Path, tmp_path: Path
) -> None:
    kept, revisions = tmp_path / "kept.tar", revisions_folder(database_url, model)
    made = back_up(database_url, model, kept)
    assert kept.stat().st_mode & 0o777 == 0o600
    shutil.move(revisions, tmp_path / "moved.git")  # of PostgreSQL it is where it was
    url, elsewhere = anew(), tmp_path / "new" / "cell"
    if url.startswith("postgresql"):
        elsewhere = model
    restored = restore(kept, url, elsewhere, SYSTEM)
    assert (restored, restored.run.number, restored.audit.number >= 20) == (made, 30, True)
    assert read_files(elsewhere) == read_files(model)
    assert (revisions_folder(url, elsewhere) / "HEAD").exists()
    (revision, _) = [*Revisions(revisions_folder(url, elsewhere)).all(), None][:2]
    assert revision is not None
    assert revision.name == "First"
    with opened(url) as database, database.reading() as connection:
        assert verify(connection).wrong == ()
        assert len(run_journal.after(connection, 0, 100)) == 30
        assert find_session(connection, at_work, time.time()) is None
        assert [person.name for person in users.everybody(connection)] == ["Eva"]
        (last,) = audit.read(connection, limit=1)
        assert (last.entry.action, last.entry.details["run"]) == ("backup-restored", 30)
    with opened(database_url) as database, database.reading() as connection:
        assert find_session(connection, at_work, time.time()) is not None


def test_the_key_that_signs_checkpoints_is_not_in_it(
    at_work: str, database: Database, database_url: str, model: Path, tmp_path: Path
) -> None:
    back_up(database_url, model, tmp_path / "kept.tar")
    key = key_file(database.place).read_bytes()
    assert key not in (tmp_path / "kept.tar").read_bytes()
    with tarfile.open(tmp_path / "kept.tar") as tar:
        assert not any("key" in name for name in tar.getnames())


def test_while_somebody_writes_it_is_of_one_moment(
    database: Database, database_url: str, anew: Anew, model: Path, tmp_path: Path
) -> None:
    filled(database, 5)
    over, written = threading.Event(), 5

    def write() -> None:
        nonlocal written
        while not over.is_set():
            with database.writing() as connection:
                audit.append(connection, act(written + 1), float(written))
            written += 1

    writing = threading.Thread(target=write)
    writing.start()
    try:
        made = back_up(database_url, model, tmp_path / "kept.tar")
    finally:
        over.set()
        writing.join()
    assert 5 <= made.audit.number <= written
    url = anew()
    restore(tmp_path / "kept.tar", url, model if url.startswith("postgresql") else tmp_path / "new", SYSTEM)
    with opened(url) as restored, restored.reading() as connection:
        assert verify(connection).wrong == ()


def test_it_takes_the_place_of_nothing(
    at_work: str, database_url: str, anew: Anew, model: Path, tmp_path: Path
) -> None:
    kept = tmp_path / "kept.tar"
    back_up(database_url, model, kept)
    with pytest.raises(StorageError, match="there already"):
        back_up(database_url, model, kept)
    before = kept.read_bytes()
    with pytest.raises(StorageError, match="a station may be running on it"):
        restore(kept, database_url, model, SYSTEM)
    url = anew()
    if url.startswith("postgresql"):
        shutil.rmtree(revisions_folder(url, model))
        with (
            pytest.raises(StorageError, match="in use by somebody else"),
            opened(url) as held,
            held.reading(),
        ):
            restore(kept, url, model, SYSTEM)
    else:
        left = tmp_path / "elsewhere" / "station.sqlite-wal"
        left.parent.mkdir()
        left.touch()
        with pytest.raises(StorageError, match=r"station.sqlite-wal is left of another database"):
            restore(kept, url, model, SYSTEM)
        left.unlink()
    (model / "station.yaml").write_text("name: another\n", encoding="utf-8")
    with pytest.raises(StorageError, match="another model than the backup"):
        restore(kept, url, model, SYSTEM)
    assert kept.read_bytes() == before


def changed(kept: Path, to: Path, change: Callable[[str, bytes], tuple[str, bytes] | None]) -> Path:
    """A copy of a backup with other members."""
    with tarfile.open(kept) as tar, tarfile.open(to, "w") as out:
        for member in tar:
            content = tar.extractfile(member)
            assert content is not None
            if (new := change(member.name, content.read())) is not None:
                info = tarfile.TarInfo(new[0])
                info.size = len(new[1])
                out.addfile(info, io.BytesIO(new[1]))
    return to


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda name, text: (name, text[:-1] + b"x") if name == "database" else (name, text), "not as it was written"),
        (lambda name, text: None if name.startswith("model/") else (name, text), "not as it was written"),
        (lambda name, text: (f"../{name}", text) if name.startswith("model/") else (name, text), "no file of a backup"),
        (lambda name, text: (f"/tmp/{name}", text) if name == "database" else (name, text), "no file of a backup"),
        (lambda name, text: None if name == "manifest.json" else (name, text), "does not begin with manifest.json"),
        (
            lambda name, text: (name, b'{"format": 2}') if name == "manifest.json" else (name, text),
            "of another version",
        ),
    ],
)
def test_what_was_changed_is_not_restored(
    tmp_path: Path, model: Path, change: Callable[[str, bytes], tuple[str, bytes] | None], said: str
) -> None:
    url = f"sqlite:///{tmp_path}/state/station.sqlite"
    with contextlib.closing(Database.open(url)) as database:
        database.upgrade()
        filled(database, 3)
    kept = tmp_path / "kept.tar"
    back_up(url, model, kept)
    wrong = changed(kept, tmp_path / "wrong.tar", change)
    with pytest.raises(StorageError, match=said):
        restore(wrong, f"sqlite:///{tmp_path}/new/station.sqlite", model, SYSTEM)
    assert not (tmp_path / "new" / "station.sqlite").exists()
    assert list((tmp_path / "new").iterdir()) == []


def test_a_journal_that_was_changed_is_not_backed_up_as_whole(tmp_path: Path, model: Path) -> None:
    url = f"sqlite:///{tmp_path}/state/station.sqlite"
    with contextlib.closing(Database.open(url)) as database:
        database.upgrade()
        filled(database, 3)
        with database.writing() as connection:
            connection.exec_driver_sql("DROP TRIGGER audit_no_update")
            connection.exec_driver_sql("UPDATE audit SET time = 99 WHERE number = 2")
    with pytest.raises(StorageError, match="record 2 of who did what"):
        back_up(url, model, tmp_path / "kept.tar")
    assert not (tmp_path / "kept.tar").exists()


def test_by_the_command_line(tmp_path: Path, model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    url = f"sqlite:///{tmp_path}/state/station.sqlite"
    with contextlib.closing(Database.open(url)) as database:
        database.upgrade()
        filled(database, 3)
    kept = tmp_path / "kept.tar"
    code, out, err = command("backup", model, "--to", kept, "--database", url)
    assert (code, err) == (0, "")
    assert "up to record 0 of what happened and 3 of who did what" in out
    with tarfile.open(kept) as tar:
        manifest = tar.extractfile("manifest.json")
        assert manifest is not None
        assert json.load(manifest)["station"] == "cell"
    code, out, err = command("restore", kept, tmp_path / "new", "--database", f"sqlite:///{tmp_path}/new.sqlite")
    assert (code, err) == (0, "")
    assert "verified" in out
    assert command("restore", kept, model, "--database", url)[0] == 2
    assert command("backup", model, "--to", kept, "--database", url)[0] == 2
    monkeypatch.setattr(archive, "_INSTALLED", tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(StorageError, match="sudo apt-get install postgresql-client"):
        archive.program("pg_dump")


@pytest.mark.parametrize(
    "url", ["postgresql://press:s3cret@there/press", "postgresql://press@there/press?password=s3cret"]
)
def test_a_password_is_on_no_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, url: str) -> None:
    program = tmp_path / "pg_dump"
    program.write_text(f'#!/bin/sh\necho "$@" > {tmp_path}/arguments\necho "$PGPASSWORD" > {tmp_path}/password\n')
    program.chmod(0o700)
    monkeypatch.setattr(archive, "_INSTALLED", tmp_path)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    server = address(url)
    assert isinstance(server, PostgresqlServer)
    archive.run("pg_dump", server)
    assert "dbname=press" in (tmp_path / "arguments").read_text()
    assert "s3cret" not in (tmp_path / "arguments").read_text()
    assert (tmp_path / "password").read_text() == "s3cret\n"
