"""What was found is found again, and only for the same model and the same program."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from sequence_planner.analysis import store
from sequence_planner.analysis.finding import analyses
from sequence_planner.analysis.report import document_of, read_supervisor, supervisor_document
from sequence_planner.analysis.store import Kept, keep, kept
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.language.syntax import TRUE
from support.cell import cell
from support.simulated import truck_engine


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "sequence-planner"


def found(automaton: Automaton) -> Kept:
    *_, analysis = analyses(automaton)
    assert analysis.supervisor is not None
    return Kept(analysis=document_of(automaton, analysis), supervisor=supervisor_document(analysis.supervisor))


def test_it_comes_back_as_it_was(cache: Path) -> None:
    station, supervisor = cell()
    assert kept(station.automaton) is None
    keep(station.automaton, found(station.automaton))
    again = kept(cell()[0].automaton)
    assert again == found(station.automaton)
    assert again is not None
    assert again.supervisor is not None
    assert read_supervisor(station.automaton, again.supervisor) == supervisor
    assert (cache.stat().st_mode & 0o777) == 0o700


def test_another_model_is_another_one(cache: Path) -> None:
    automaton = cell()[0].automaton
    keep(automaton, found(automaton))
    assert kept(replace(automaton, rest=TRUE)) is None
    assert kept(replace(automaton, effects=automaton.effects[:-1])) is None
    assert len(list(cache.iterdir())) == 1


@pytest.mark.parametrize("damage", ["", "{}", "[1]", "not json", None])
def test_what_is_damaged_is_not_believed(cache: Path, damage: str | None) -> None:
    automaton = cell()[0].automaton
    keep(automaton, found(automaton))
    [file] = cache.iterdir()
    if damage is None:  # well-formed, but not what was written
        content = json.loads(file.read_text())
        damage = json.dumps({**content, "text": content["text"].replace('"root":', '"root":1', 1)})
    file.write_text(damage)
    assert kept(automaton) is None
    keep(automaton, found(automaton))
    assert kept(automaton) == found(automaton)


def test_only_so_much_is_kept(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "MOST_KEPT", 3)
    automaton = cell()[0].automaton
    analysis = found(automaton)
    for number in range(5):
        keep(replace(automaton, title=f"cell {number}"), analysis)
    assert len(list(cache.iterdir())) == 3


def test_where_nothing_can_be_written_nothing_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    automaton = cell()[0].automaton
    keep(automaton, found(automaton))
    assert kept(automaton) is None


def test_what_new_products_bring_counts_and_the_order_of_a_job_does_not(cache: Path) -> None:
    """A finding can be that nothing ever makes a condition true, and a new product may."""
    automaton = truck_engine()[0].automaton
    keep(automaton, found(automaton))
    ((name, master),) = automaton.work_masters.items()
    assert kept(replace(automaton, work_masters={name: replace(master, operations={})})) is not None
    assert kept(replace(automaton, work_masters={name: replace(master, brings=())})) is None


def test_without_a_home_nothing_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", homeless)
    automaton = cell()[0].automaton
    keep(automaton, found(automaton))
    assert kept(automaton) is None
