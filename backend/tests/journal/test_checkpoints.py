"""Signed checkpoints, and what they show that the chains alone do not."""

from __future__ import annotations

import asyncio
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from sqlalchemy import Connection, text

from journal.acts import act, filled
from journal.happened import content, durable, happened, with_writer
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import SqliteFile
from sequence_planner.journal import audit, checkpointing, checkpoints, run_journal
from sequence_planner.journal.checkpoints import Checkpoint, key_file, public_key, signing_key
from sequence_planner.journal.hash_chain import START, digest
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.journal.verify import verify
from sequence_planner.journal.writer import RunWriter

MAKE_KEY = """
import sys
from pathlib import Path
from sequence_planner.journal.checkpoints import public_key, signing_key
print("ready", flush=True)
sys.stdin.readline()
signing_key(Path(sys.argv[1]))
print(public_key(Path(sys.argv[1])))
"""


def _wrong(database: Database, kept: Checkpoint | None = None) -> tuple[str, ...]:
    with database.reading() as connection:
        return verify(connection, public_key(key_file(database.place)), kept).wrong


def _newest(database: Database) -> Checkpoint | None:
    with database.reading() as connection:
        return checkpoints.newest(connection)


def _unguarded(connection: Connection) -> None:
    """As somebody may do who may change the database's structure."""
    if connection.dialect.name == "postgresql":
        for table in ("run", "run_checkpoints", "audit"):
            connection.execute(text(f"ALTER TABLE {table} DISABLE TRIGGER ALL"))
        return
    for name in ("run_no_update", "run_checkpoints_no_update", "run_checkpoints_no_delete", "audit_no_update"):
        connection.execute(text(f"DROP TRIGGER {name}"))


def _history_made_anew(database: Database) -> None:
    """Change the third record of what happened, and make all hashes fit again."""
    with database.writing() as connection:
        _unguarded(connection)
        last = START.hash
        for old in run_journal.after(connection, 0, 1000):
            changed = content(99) if old.number == 3 else old.content
            last = digest(last, RunRecord(old.number, old.time, old.kind, changed, "").text())
            values = {"number": old.number, "content": changed, "hash": last}
            connection.execute(text("UPDATE run SET content = :content, hash = :hash WHERE number = :number"), values)
        connection.execute(text("UPDATE run_end SET hash = :hash"), {"hash": last})
        assert run_journal.broken_at(connection) is None


def test_it_signs_how_far_both_chains_have_come(database: Database) -> None:
    records = filled(database, 3)
    happened(database, range(1, 6))
    first = checkpoints.make(database, 12.5)
    happened(database, range(6, 9))
    second = checkpoints.make(database, 13.5)
    said = second.statement()
    assert (said.checkpoint, said.time) == (2, 13.5)
    with database.reading() as connection:
        assert said.run.position() == run_journal.end(connection)
        assert said.audit.position() == audit.end(connection)
        assert [*checkpoints.everything(connection)] == [first, second]
    assert said.audit.hash == records[-1].hash
    assert first.public_key == second.public_key == public_key(key_file(database.place))
    assert first.is_signed()
    assert not first.model_copy(update={"content": first.content.replace("12.5", "12.6")}).is_signed()
    assert not first.model_copy(update={"signature": second.signature}).is_signed()
    assert _wrong(database) == _wrong(database, first) == ()


def test_the_key_is_of_this_user_alone_and_stays(database: Database, tmp_path: Path) -> None:
    file = key_file(database.place)
    assert public_key(file) is None
    checkpoints.make(database, 1.0)
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    if isinstance(database.place, SqliteFile):
        assert file == tmp_path / "state" / "station.sqlite-checkpoint-key.pem"
    assert [each.name for each in file.parent.iterdir() if "checkpoint-key" in each.name].count(file.name) == 1
    assert not [each for each in file.parent.iterdir() if each.name.startswith(f"{file.name}.")]


def test_of_several_that_make_the_key_one_wins(tmp_path: Path) -> None:
    file = tmp_path / "key.pem"
    started = [
        subprocess.Popen(
            [sys.executable, "-c", MAKE_KEY, file], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        for _ in range(3)
    ]
    for process in started:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    keys = {process.communicate("go\n", timeout=60)[0] for process in started}
    assert keys == {f"{public_key(file)}\n"}
    assert [*tmp_path.iterdir()] == [file]


def test_a_key_that_cannot_be_used_is_named(tmp_path: Path) -> None:
    file = tmp_path / "key.pem"
    file.write_text("nothing")
    with pytest.raises(StorageError, match=r"key\.pem holds no Ed25519 key"):
        signing_key(file)
    with pytest.raises(StorageError, match="cannot be used: File exists"):
        signing_key(file / "key.pem")


def test_a_history_that_was_made_anew_does_not_fit(database: Database) -> None:
    happened(database, range(1, 6))
    kept = checkpoints.make(database, 1.0)
    _history_made_anew(database)
    said = "does not fit: record 5 of what happened is missing, or is another one"
    assert _wrong(database) == (f"checkpoint 1 of those in the database {said}",)
    with database.writing() as connection:
        connection.execute(text("DELETE FROM run_checkpoints"))
    assert _wrong(database) == ()  # nothing in the database tells: this is what a checkpoint is kept for
    assert _wrong(database, kept) == (f"the checkpoint that was kept {said}",)


def test_who_has_not_got_the_key_cannot_sign_a_history_made_anew(database: Database) -> None:
    happened(database, range(1, 6))
    kept = checkpoints.make(database, 1.0)
    happened(database, range(6, 9))
    file = key_file(database.place)
    own = file.read_bytes()
    file.unlink()
    checkpoints.make(database, 2.0)  # by another key
    assert _wrong(database) == ()
    assert _wrong(database, kept) == (
        "the newest checkpoint is signed with another key than the checkpoint that was kept",
    )
    file.write_bytes(own)
    assert _wrong(database) == ("the newest checkpoint is not signed with the key of this station",)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("content = '{}'", "is not as it was signed"),
        ("content = replace(content, ' ', '')", "is not as it was signed"),
        ("signature = 'ab'", "a checkpoint in the database cannot be read: it was changed"),
    ],
)
def test_a_checkpoint_that_was_changed_is_found(database: Database, change: str, said: str) -> None:
    happened(database, range(1, 6))
    checkpoints.make(database, 1.0)
    with database.writing() as connection:
        _unguarded(connection)
        connection.execute(text(f"UPDATE run_checkpoints SET {change}"))
    (wrong,) = _wrong(database)
    assert wrong.endswith(said)


def test_an_act_that_was_changed_together_with_its_chain_does_not_fit(database: Database) -> None:
    filled(database, 2)
    kept = checkpoints.make(database, 1.0)
    with database.writing() as connection:
        _unguarded(connection)
        connection.execute(text("UPDATE audit SET hash = 'another' WHERE number = 2"))
    assert (
        "the checkpoint that was kept does not fit: record 2 of who did what is missing, or is another one"
        in _wrong(database, kept)
    )
    with database.writing() as connection:
        audit.append(connection, act(3), 3.0)


def test_the_writer_signs_after_so_many_records(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checkpointing, "RECORDS", 40)
    happened(database, range(1, 31))
    assert _newest(database) is None
    happened(database, range(31, 41))  # those of another start count too
    newest = _newest(database)
    assert newest is not None
    assert newest.statement().run.number == 40
    happened(database, range(41, 80))
    assert _newest(database) == newest


def test_the_writer_signs_after_some_time_also_when_nothing_happens_any_more(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checkpointing, "SECONDS", 0.3)

    async def write(writer: RunWriter) -> None:
        writer.write("ticked", 1.0, content(1))
        await durable(writer, 1)
        assert _newest(database) is None
        await _signed(database, 1)

    with_writer(database, write)


async def _signed(database: Database, number: int) -> None:
    async with asyncio.timeout(10):
        while (newest := _newest(database)) is None:  # noqa: ASYNC110 (the thread tells nobody)
            await asyncio.sleep(0.02)
    assert newest.statement().run.number == number


def test_without_a_key_the_station_writes_all_the_same(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checkpointing, "RECORDS", 10)
    file = key_file(database.place)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("nothing")
    happened(database, range(1, 31))
    assert _newest(database) is None
    with database.reading() as connection:
        assert run_journal.broken_at(connection) is None
    file.unlink()
