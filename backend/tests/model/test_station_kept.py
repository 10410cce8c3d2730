"""A station is read once for all of its processes, and again as soon as one of its files is another."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sequence_planner.model.source import ModelError
from sequence_planner.station import ReadStation, prepare_station, read_station
from support.places import MODELS, SINGLE_BOLT

KEPT = f"{ReadStation.__name__}-*"  # the name of a file in the cache


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's cache, empty."""
    folder = tmp_path / "cache"
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder))
    return folder / "sequence-planner"


@pytest.mark.parametrize("name", ["bolt_tightening", "truck_engine_station"])
def test_what_is_kept_is_what_the_files_mean(name: str, cache: Path) -> None:
    first, again, read = prepare_station(MODELS / name), prepare_station(MODELS / name), read_station(MODELS / name)
    assert list(cache.glob(KEPT))
    for station in (first, again):
        assert station.automaton == read.automaton
        assert dict(station.automaton.places) == dict(read.automaton.places)
        assert station.registry.type_names() == read.registry.type_names()
    assert (again.pipelines.incoming.keys(), again.pipelines.outgoing.keys()) == (
        first.pipelines.incoming.keys(),
        first.pipelines.outgoing.keys(),
    )
    assert (again.ros_1, again.goes_on, len(again.examples)) == (first.ros_1, first.goes_on, len(first.examples))


def test_a_change_is_seen(tmp_path: Path, cache: Path) -> None:
    folder = tmp_path / "single_bolt"
    shutil.copytree(SINGLE_BOLT, folder)
    prepare_station(folder)
    resource = min(folder.glob("resources/*.yaml"))
    whole = resource.read_text(encoding="utf-8")
    resource.write_text(f"{whole}\nnothing_like_that: 1\n", encoding="utf-8")
    with pytest.raises(ModelError, match="nothing_like_that"):
        prepare_station(folder)
    resource.write_text(whole, encoding="utf-8")
    assert prepare_station(folder).automaton == read_station(folder).automaton


def test_what_is_damaged_is_read_anew(cache: Path) -> None:
    expected = prepare_station(SINGLE_BOLT).automaton
    (kept,) = cache.glob(KEPT)
    kept.write_bytes(kept.read_bytes()[:-10])
    assert prepare_station(SINGLE_BOLT).automaton == expected
