"""Where a station's database is by default."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import SqliteFile, address, default_url


@pytest.fixture
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state" / "sequence-planner"


def _file(url: str) -> Path:
    place = address(url)
    assert isinstance(place, SqliteFile)
    return place.path


def test_one_station_has_one_place_however_it_is_named(
    state: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "press").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "press")
    monkeypatch.chdir(tmp_path)
    urls = {
        default_url(Path(name)) for name in ("press", "./press/", "link", "press/../press", str(tmp_path / "press"))
    }
    assert len(urls) == 1
    file = _file(urls.pop())
    assert file.name == "station.sqlite"
    assert file.parent.parent == state
    assert file.parent.name.startswith("press-")


def test_stations_of_one_name_have_places_of_their_own(state: Path, tmp_path: Path) -> None:
    assert default_url(tmp_path / "hall_1" / "press") != default_url(tmp_path / "hall_2" / "press")


@pytest.mark.parametrize("name", ["press?mode=memory", "press #1", "100%", "Prässe", "a:b@c", "..."])
def test_any_folder_name_will_do(state: Path, tmp_path: Path, name: str) -> None:
    url = default_url(tmp_path / name)
    Database.open(url).close()
    assert _file(url).exists()
    assert _file(url).parent.parent == state


def test_any_home_will_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = tmp_path / "50% of a@home?#"
    monkeypatch.setenv("XDG_STATE_HOME", str(home))
    url = default_url(tmp_path / "press")
    Database.open(url).close()
    assert _file(url).is_relative_to(home)
    assert _file(url).exists()


def test_without_the_variable_it_is_below_the_home(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    for value in ("", "relative/path"):
        monkeypatch.setenv("XDG_STATE_HOME", value)
        assert _file(default_url(tmp_path / "press")).is_relative_to(tmp_path / ".local" / "state" / "sequence-planner")


def test_without_a_home_one_is_asked_for(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def no_home() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setenv("XDG_STATE_HOME", "")
    monkeypatch.setattr(Path, "home", no_home)
    with pytest.raises(StorageError, match="--database URL"):
        default_url(tmp_path / "press")
