"""SQLite: durable, for this user alone, and what goes wrong in plain words."""

from __future__ import annotations

import resource
import signal
import sqlite3
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from sqlalchemy import text

from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry

APPENDING = """
import os, sys
from sequence_planner.core.actor import SYSTEM
from sequence_planner.journal import audit
from sequence_planner.journal.entry import Entry
from sequence_planner.db.database import Database, StorageError

def record(database):
    with database.writing() as connection:
        return audit.append(connection, Entry(actor=SYSTEM, action="try", details={"text": "x" * 10_000}), 1.0)
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "state" / "press" / "station.sqlite"


@pytest.fixture
def opened(file: Path) -> Iterator[Database]:
    database = Database.open(f"sqlite:///{file}")
    database.upgrade()
    yield database
    database.close()


def _mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_what_is_written_is_on_the_disk_before_anybody_goes_on(opened: Database) -> None:
    for block, patience in ((opened.reading, 5000), (opened.writing, 0), (opened.reading, 5000)):  # in milliseconds
        with block() as connection:
            settings = {
                name: connection.execute(text(f"PRAGMA {name}")).scalar_one()
                for name in ("journal_mode", "synchronous", "foreign_keys", "busy_timeout")
            }
        assert settings == {"journal_mode": "wal", "synchronous": 2, "foreign_keys": 1, "busy_timeout": patience}


def test_files_are_for_this_user_alone(opened: Database, file: Path) -> None:
    with opened.writing() as connection:
        connection.execute(text("INSERT INTO first_start_links (token_hash, expires) VALUES ('a', 1)"))
        files = sorted(file.parent.iterdir())
        assert [each.name for each in files] == ["station.sqlite", "station.sqlite-shm", "station.sqlite-wal"]
        assert [_mode(each) for each in files] == [0o600] * 3
    assert _mode(file.parent) == 0o700


def test_a_file_that_others_could_read_is_closed_to_them_and_its_folder_stays_as_it_is(tmp_path: Path) -> None:
    tmp_path.chmod(0o755)
    file = tmp_path / "station.sqlite"
    file.touch()
    file.chmod(0o644)
    Database.open(f"sqlite:///{file}").close()
    assert (_mode(file), _mode(tmp_path)) == (0o600, 0o755)


def test_nothing_is_made_for_somebody_who_only_reads(file: Path) -> None:
    with pytest.raises(StorageError, match=f"{file} is not there"):
        Database.open(f"sqlite:///{file}", create=False)
    assert not file.parent.exists()


@pytest.mark.parametrize("content", [b"certainly no database, but long enough to be looked at" * 40, b"garbage"])
def test_a_file_that_is_no_database_is_left_alone(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "station.sqlite"
    file.write_bytes(content)
    with pytest.raises(StorageError) as refusal:
        Database.open(f"sqlite:///{file}")
    assert str(refusal.value) == f"{file} is not a database: name another file, or move this one away"
    assert file.read_bytes() == content


def test_a_damaged_file_is_named(opened: Database, file: Path) -> None:
    opened.close()
    content = bytearray(file.read_bytes())
    content[4096:] = b"\xa5" * (len(content) - 4096)
    file.write_bytes(content)
    with pytest.raises(StorageError, match=f"{file} is damaged: move it away and put a copy in its place"):
        Database.open(f"sqlite:///{file}")


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("station.sqlite", "the database's URL cannot be read"),
        ("", "the database's URL cannot be read"),
        ("sqlite://", "must name a file"),
        ("sqlite:///:memory:", "must name a file"),
        ("sqlite:////folder/a.sqlite?mode=memory", "must name a file"),
        ("sqlite://host/a.sqlite", "must name a file"),
        ("mysql://user:hidden@host/database", "of the kind `mysql` is not supported"),
        ("sqlite+aiosqlite:////folder/a.sqlite", "of the kind `sqlite\\+aiosqlite` is not supported"),
        ("sqlite:////proc/nowhere/a.sqlite", "the folder /proc/nowhere cannot be made: "),
        (f"sqlite:///{Path(__file__)}/a.sqlite", "cannot be made: File exists"),
        ("sqlite:////tmp", "/tmp cannot be opened: Is a directory"),
    ],
)
def test_where_nothing_can_be_kept(url: str, said: str) -> None:
    with pytest.raises(StorageError, match=said) as refusal:
        Database.open(url)
    assert "hidden" not in str(refusal.value)


def test_a_database_that_somebody_else_holds(opened: Database, file: Path) -> None:
    holder = sqlite3.connect(file, isolation_level=None)
    holder.execute("BEGIN IMMEDIATE")
    with pytest.raises(StorageError, match=f"{file} is held by another program for more than 5 s"), opened.writing():
        pass
    with opened.reading() as connection:  # readers do not wait
        assert connection.execute(text("SELECT count(*) FROM audit")).scalar_one() == 0
    holder.execute("COMMIT")
    holder.close()
    with opened.writing():
        pass


def test_who_writes_a_lot_keeps_nobody_out(opened: Database, file: Path) -> None:
    code = f"""{APPENDING}
database = Database.open(sys.argv[1])
record(database)
print("ready", flush=True)
while True:
    record(database)
"""
    with subprocess.Popen([sys.executable, "-c", code, f"sqlite:///{file}"], stdout=subprocess.PIPE) as busy:
        assert busy.stdout is not None
        assert busy.stdout.readline() == b"ready\n"
        first, *_, last = (_append(opened) for _ in range(50))
        assert busy.poll() is None
        busy.kill()
    assert 49 <= last - first < 50 * 20


def _append(database: Database) -> int:
    with database.writing() as connection:
        return audit.append(connection, Entry(actor=SYSTEM, action="try"), 1.0).number


def test_who_opens_it_once_more_takes_no_lock_from_who_has_it_open(opened: Database, file: Path) -> None:
    """Else another process would take itself for the last one, and remove the log that is still written to."""

    def elsewhere() -> int:
        code = f"{APPENDING}\nprint(record(Database.open(sys.argv[1])).number)"
        command = [sys.executable, "-c", code, f"sqlite:///{file}"]
        return int(subprocess.run(command, capture_output=True, text=True, check=True).stdout)

    numbers = [_append(opened)]
    Database.open(f"sqlite:///{file}").close()
    numbers += [elsewhere(), _append(opened), elsewhere(), _append(opened)]
    assert numbers == [1, 2, 3, 4, 5]


def test_a_reader_cannot_write(opened: Database) -> None:
    with pytest.raises(StorageError, match="cannot be written to"), opened.reading() as connection:
        connection.execute(text("INSERT INTO first_start_links (token_hash, expires) VALUES ('a', 1)"))


@pytest.mark.parametrize("replaced", [False, True])
def test_nothing_is_written_to_a_file_that_was_taken_away(opened: Database, file: Path, replaced: bool) -> None:
    file.rename(file.with_name("elsewhere"))
    if replaced:
        file.touch()
    for block in (opened.reading, opened.writing):
        with pytest.raises(StorageError, match=f"{file} was removed or replaced while it was in use"), block():
            pass
    file.unlink(missing_ok=True)
    file.with_name("elsewhere").rename(file)
    with opened.writing():
        pass


def test_a_disk_without_room(opened: Database, file: Path) -> None:
    """The limit on a file's size stands in for a full disk; what was recorded before stays whole."""
    code = f"""{APPENDING}
database = Database.open(sys.argv[1])
written = 0
try:
    while True:
        written = record(database).number
except StorageError as error:
    print(written)
    print(error)
"""
    done = subprocess.run(
        [sys.executable, "-c", code, f"sqlite:///{file}"],
        preexec_fn=_little_room,
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    written, said = done.stdout.splitlines()
    assert said.startswith(f"{file} cannot be ")
    assert "disk" in said
    with opened.reading() as connection:
        assert connection.execute(text("SELECT max(number) FROM audit")).scalar_one() == int(written) > 5


def _little_room() -> None:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (500_000, 500_000))


def test_a_folder_that_may_only_be_read() -> None:
    """As a user without the right to write: root would have it."""
    code = """
import os, sys
from sequence_planner.db.database import Database, StorageError

for line in ("1", "2"):
    try:
        Database.open(sys.argv[1], create=False)
    except StorageError as error:
        print(error)
    if os.geteuid() == 0:
        os.setgroups([])
        os.setgid(65534)
        os.setuid(65534)
try:
    Database.open(sys.argv[1])
except StorageError as error:
    print(error)
"""
    with TemporaryDirectory() as folder:
        Path(folder).chmod(0o555)
        file = Path(folder) / "station.sqlite"
        done = subprocess.run(
            [sys.executable, "-c", code, f"sqlite:///{file}"], capture_output=True, text=True, check=True, timeout=60
        )
    missing = f"{file} is not there: no station has kept its database there yet\n"
    said = done.stdout.removeprefix(f"{missing}{missing}{file} cannot be opened: {folder} belongs to ")
    assert said != done.stdout
    assert said.endswith(": give this user the right to read and write it, and to write to its folder\n")
