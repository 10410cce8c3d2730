"""A last word beside a journal that is not the one it was said of: a new station's, or that of a restored backup."""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from running.workshops import EditedStation, edited
from sequence_planner.db.location import SqliteFile, address, default_url
from sequence_planner.startup.station_process import UNUSABLE
from support.examples import SHARE
from support.network import free_port
from support.station import finished, process
from support.waiting import until

# That a last word counts only beside its own journal is tested in `journal/test_last_word.py`, too.
IN_CAMPAIGNS = pytest.mark.skipif(SHARE < 1, reason="stations that begin one after another take long: `make campaign`")


def works(station: EditedStation) -> None:
    """A person lets it work."""
    until(station.up, seconds=240.0)
    station.control()
    if undecided := station.get("undecided", "station"):
        values = {name: each["value"] for name, each in undecided.items()}
        station.asked("PUT", "restored-outputs", {"values": values, "reason": "as it was"})
    station.asked("POST", "production/start", {})
    station.asked("PUT", "mode", {"mode": "automatic"})
    until(lambda: bool(station.get("tasks")))


def paused_later(folder: Path, model: Path) -> None:
    """It works on, and somebody pauses it."""
    with edited(folder, "--emulator", model=model) as station:
        works(station)
        station.asked("PUT", "mode", {"mode": "paused"})


def database_of(model: Path) -> Path:
    """The file of its database."""
    place = address(default_url(model))
    assert isinstance(place, SqliteFile)
    return place.path


def gone(model: Path) -> Path:
    """The file of its database, which is not there any more, and nothing that is part of it."""
    file = database_of(model)
    for part in (file, Path(f"{file}-wal"), Path(f"{file}-shm")):
        part.unlink(missing_ok=True)
    return file


def begun(station: EditedStation) -> tuple[str, bool]:
    """The mode in which it is once it is up, and whether it says that it began at rest."""
    until(station.up, seconds=240.0)
    return str(station.get("mode", "station")), "begins-at-rest" in station.get("alarms")


@IN_CAMPAIGNS
def test_a_new_station_begins_without_the_last_word_of_the_one_before(tmp_path: Path) -> None:
    with edited(tmp_path, "--emulator") as station:
        model = station.model
        works(station)
        station.asked("PUT", "mode", {"mode": "paused"})
    file = gone(model)
    refused = finished("run", str(model), "--port", str(free_port()), "--emulator")
    assert (refused.returncode, "run --new" in refused.stderr) == (UNUSABLE, True)
    log = tmp_path / "new.log"
    with process(log, "run", str(model), "--port", str(free_port()), "--emulator", "--new"):
        until(lambda: "runs: open" in log.read_text(), seconds=240.0)
    (kept,) = file.parent.glob("*-last-word-aside-*")
    assert f"is kept as {kept}" in log.read_text()
    with edited(tmp_path, "--emulator", "--new", model=model) as station:
        assert begun(station) == ("automatic", False)
        assert list(file.parent.glob("*-aside-*")) == [kept], "it is new once"


@IN_CAMPAIGNS
def test_a_restored_backup_begins_at_rest_once(tmp_path: Path) -> None:
    with edited(tmp_path, "--emulator") as station:
        model = station.model
        works(station)
    copy = tmp_path / "copy"
    with closing(sqlite3.connect(database_of(model))) as was, closing(sqlite3.connect(copy)) as backup:
        was.backup(backup)
    paused_later(tmp_path, model)
    shutil.copy(copy, gone(model))
    with edited(tmp_path, "--emulator", model=model) as station:
        assert begun(station) == ("paused", True)
        works(station)
    for _ in range(2):
        with edited(tmp_path, "--emulator", model=model) as station:
            assert begun(station) == ("automatic", False)
