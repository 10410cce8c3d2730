"""A database on a disk or in a folder that this user cannot write to: what is wrong is said, and what to do."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from sequence_planner.db.errors import file_trouble

OPENED = """
import sys
from sequence_planner.db.database import Database, StorageError
try:
    database = Database.open(sys.argv[1])
    if len(sys.argv) > 2:
        import subprocess
        database.upgrade()
        subprocess.run(sys.argv[2:], check=True)
        database.try_writing()
except StorageError as error:
    print(error)
"""


def within_a_disk(folder: Path, script: str) -> str:
    """What a script of the shell prints, with a small disk at `folder` that nobody else sees."""
    room = ["unshare", "--mount", *([] if os.geteuid() == 0 else ["--map-root-user"]), "sh", "-c"]
    begun = f'mount -t tmpfs -o size=8m tmpfs "{folder}" || exit 77; {script}'
    environ = {**os.environ, "FOLDER": str(folder), "PYTHON": sys.executable, "OPENED": OPENED}
    try:
        done = subprocess.run([*room, begun], capture_output=True, text=True, check=False, env=environ, timeout=120)
    except FileNotFoundError:
        pytest.skip("there is no `unshare` here")
    if done.returncode in (1, 77) and not done.stdout:
        pytest.skip(f"no disk can be mounted here: {done.stderr.strip()}")
    return done.stdout.strip()


@pytest.mark.parametrize(
    "script",
    [
        'touch $FOLDER/s.sqlite; mount -o remount,ro $FOLDER; "$PYTHON" -c "$OPENED" sqlite:///$FOLDER/s.sqlite',
        'mount -o remount,ro $FOLDER; "$PYTHON" -c "$OPENED" sqlite:///$FOLDER/s.sqlite',
        'mount -o remount,ro $FOLDER; "$PYTHON" -c "$OPENED" sqlite:///$FOLDER/new/s.sqlite',
    ],
    ids=["a file that is there", "a new file", "a new folder"],
)
def test_a_disk_that_can_only_be_read_is_said_to_be_one(tmp_path: Path, script: str) -> None:
    said = within_a_disk(tmp_path, script)
    assert str(tmp_path) in said
    assert "its disk can only be read: have it mounted so that it can be written to" in said
    assert "ermission denied" not in said


def test_a_folder_of_somebody_else_is_said_to_be_one(tmp_path: Path) -> None:
    said = file_trouble(PermissionError(errno.EACCES, os.strerror(errno.EACCES)), tmp_path / "station.sqlite")
    assert f"{tmp_path} belongs to " in said
    assert "give this user the right" in said


def test_a_full_disk_is_said_to_be_one(tmp_path: Path) -> None:
    assert "no room" in file_trouble(OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), tmp_path)
