"""Which backups are kept, what is in the way of another, and what a folder's own disk or a clock does to them."""

from __future__ import annotations

import contextlib
import errno
import shutil
import time
from pathlib import Path

import pytest

from journal.acts import filled
from sequence_planner.backup.archive import How, Maker
from sequence_planner.backup.errors import BackupError, Trouble, trouble_of
from sequence_planner.backup.service import BackupTask, Shelf, Step, back_up, do
from sequence_planner.backup.settings import Keeping
from sequence_planner.db.database import Database
from sequence_planner.db.location import mark_of
from support.places import CELL

MAKER = Maker(how=How.SCHEDULE, name="Sequence Planner")


@pytest.fixture
def shelf(tmp_path: Path) -> Shelf:
    """A folder that somebody has named, for the backups of a station that runs."""
    shutil.copytree(CELL, model := tmp_path / "cell")
    (folder := tmp_path / "kept").mkdir()
    url = f"sqlite:///{tmp_path}/state/station.sqlite"
    with contextlib.closing(Database.open(url)) as database:
        database.upgrade()
        filled(database, 3)
    return Shelf(url, model, Keeping(folder, kept=2))


def make(shelf: Shelf) -> tuple[Path, tuple[str, ...], list[Step]]:
    """A new backup, what was removed for its sake, and the steps on the way."""
    file, steps = shelf.new(time.time()), list[Step]()
    return file, do(BackupTask(shelf.url, shelf.model, shelf.keeping, file, MAKER), steps.append).removed, steps


def test_the_oldest_of_its_own_go_for_one_that_is_whole_and_others_stay(shelf: Shelf) -> None:
    mark = mark_of(shelf.model)
    own = [shelf.folder / f"{mark}-2026010{day}T000000Z.tar" for day in (1, 2, 3)]
    others = [shelf.folder / name for name in ("by-hand.tar", f"{mark}0-20260101T000000Z.tar")]
    for file in (*own, *others):
        back_up(shelf.url, shelf.model, file)
    (shelf.folder / "broken.tar").write_bytes(b"no backup")
    (shelf.folder / "letter.txt").write_text("kept")
    (shelf.folder / f"{shelf.scratch}left").mkdir()
    file, removed, steps = make(shelf)
    assert set(removed) == {own[0].name, own[1].name}
    assert steps == [Step.COPYING, Step.WRITING, Step.CHECKING]
    listed = {file.name, own[2].name, "broken.tar", *(each.name for each in others)}
    assert {each.name for each in shelf.folder.iterdir()} == {*listed, "letter.txt"}
    backups = shelf.folder_state().backups
    assert {each.file for each in backups} == listed
    assert [each.manifest and each.manifest.maker for each in backups] == [MAKER, *[None] * 4]
    assert shelf.new(time.time()) != file


def test_a_backup_that_a_slow_clock_has_made_is_not_the_one_to_go(
    shelf: Shelf, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = []
    for when in (2e9, 2e9 + 1, 1e9):
        monkeypatch.setattr(time, "time", lambda when=when: when)
        files.append(make(shelf)[0])
    assert [each.file for each in shelf.folder_state().backups] == [files[1].name, files[2].name]
    every_day = Keeping(every=24)
    assert every_day.is_due([2e9, 1e9 - 86401], 1e9)
    assert not every_day.is_due([2e9, 1e9 - 86399], 1e9)
    assert not Keeping().is_due([], 1e9)


def test_a_journal_that_was_changed_makes_no_backup_and_costs_none(shelf: Shelf) -> None:
    kept = [make(shelf)[0].name, make(shelf)[0].name]
    with contextlib.closing(Database.open(shelf.url)) as database, database.writing() as connection:
        connection.exec_driver_sql("DROP TRIGGER audit_no_update")
        connection.exec_driver_sql("UPDATE audit SET time = 99 WHERE number = 2")
    with pytest.raises(BackupError, match="record 2 of who did what") as wrong:
        make(shelf)
    assert wrong.value.trouble is Trouble.NOT_WHOLE
    assert sorted(each.name for each in shelf.folder.iterdir()) == sorted(kept)


def test_a_folder_that_somebody_named_is_not_made_and_the_usual_one_is(shelf: Shelf, tmp_path: Path) -> None:
    shelf.folder.rmdir()
    with pytest.raises(BackupError, match="make or mount it") as wrong:
        make(shelf)
    assert wrong.value.trouble is Trouble.NO_FOLDER
    usual = Shelf(shelf.url, shelf.model, Keeping())
    assert usual.folder_state().trouble is None
    file, _, _ = make(usual)
    assert file.parent == tmp_path / "state" / "station.backups"
    assert file.parent.stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize(
    ("number", "name", "trouble"),
    [
        (errno.ENOSPC, "/model/a.yaml", Trouble.NO_SPACE),  # copying names what is read
        (errno.EDQUOT, "/kept/a", Trouble.NO_SPACE),
        (errno.ENOENT, "/kept/a", Trouble.NO_FOLDER),
        (errno.EROFS, None, Trouble.NOT_WRITABLE),
        (errno.EACCES, "/kept", Trouble.NOT_WRITABLE),
        (errno.EACCES, "/model/a.yaml", Trouble.OTHER),
        (errno.EIO, "/kept/a", Trouble.OTHER),
    ],
)
def test_what_the_system_says_is_told_by_what_remedies_it(number: int, name: str | None, trouble: Trouble) -> None:
    error = trouble_of(OSError(number, "so it is", name), Path("/kept"))
    assert error.trouble is trouble
    assert "so it is" in str(error)
