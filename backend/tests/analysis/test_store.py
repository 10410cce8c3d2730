"""What was found is there the next time, of the same model only, and never taken from where others could put it."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.finding import analyses
from sequence_planner.analysis.mutual_exclusion import NeverTogether
from sequence_planner.analysis.store import MOST_KEPT, key, read, supervisor_of, user_cache, write
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import BOOLEAN
from sequence_planner.synthesis import supervisor
from support.automata import Does, automaton
from support.cell import cell
from support.simulated import truck_engine


def lamp(goal: str) -> Automaton:
    return automaton({"shine": Does(start=("lamp := true",))}, output={"lamp": (BOOLEAN, False)}, goals={"light": goal})


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "station"
    made.mkdir(mode=0o700)
    return made


def found(of: Automaton) -> Analysis:
    *_, last = analyses(of)
    return last


def test_it_is_the_same_for_the_same_model_and_nothing_for_another(folder: Path) -> None:
    write(key(lamp("lamp")), found(lamp("lamp")), folder)
    assert read(key(lamp("lamp")), Analysis, folder) == found(lamp("lamp"))
    assert read(key(lamp("not lamp")), Analysis, folder) is None


def test_nothing_is_known_at_first_or_of_a_damaged_file(folder: Path) -> None:
    assert read(key(lamp("lamp")), Analysis, folder) is None
    write(key(lamp("lamp")), found(lamp("lamp")), folder)
    [file] = folder.iterdir()
    file.write_bytes(b"\x80\x04nonsense")
    assert read(key(lamp("lamp")), Analysis, folder) is None


def test_a_file_of_which_one_bit_is_wrong_is_not_believed(folder: Path) -> None:
    """Another set of safe states would be one in which robots are let loose."""
    write(key(lamp("lamp")), supervisor_of(lamp("lamp")), folder)
    [file] = folder.iterdir()
    content = file.read_bytes()
    for place in range(0, len(content), 7):
        file.write_bytes(content[:place] + bytes([content[place] ^ 4]) + content[place + 1 :])
        assert read(key(lamp("lamp")), Supervisor, folder) is None
    file.write_bytes(content)
    assert read(key(lamp("lamp")), Supervisor, folder) == supervisor_of(lamp("lamp"))


def test_a_folder_that_others_can_use_is_neither_written_nor_read(folder: Path) -> None:
    write(key(lamp("lamp")), found(lamp("lamp")), folder)
    folder.chmod(0o755)
    assert read(key(lamp("lamp")), Analysis, folder) is None
    [file] = folder.iterdir()
    file.unlink()
    write(key(lamp("lamp")), found(lamp("lamp")), folder)
    assert not list(folder.iterdir())


def test_only_the_newest_are_kept_of_each_kind(folder: Path) -> None:
    nothing = NeverTogether(frozenset(), None)
    write(key(lamp("lamp")), nothing, folder)
    for number in range(MOST_KEPT + 5):
        goal = " and ".join(["lamp"] * (number + 1))
        write(key(lamp(goal)), found(lamp("lamp")), folder)
        file = max(folder.glob("Analysis-*"), key=lambda each: each.stat().st_mtime_ns)
        os.utime(file, (number, number))
    assert len(list(folder.glob("Analysis-*"))) == MOST_KEPT
    assert read(key(lamp("lamp")), Analysis, folder) is None, "it was the first"
    assert read(key(lamp(goal)), Analysis, folder) == found(lamp("lamp"))
    assert read(key(lamp("lamp")), NeverTogether, folder) == nothing


def test_the_cache_is_used_where_it_is_the_users_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    found_here = user_cache()
    assert found_here == tmp_path / "sequence-planner"
    assert found_here.stat().st_mode & 0o777 == 0o700
    found_here.chmod(0o750)
    assert user_cache() is None
    found_here.rmdir()
    found_here.write_text("in the way")
    assert user_cache() is None


def test_where_there_are_too_many_states_they_are_not_counted_and_all_else_is_found() -> None:
    *_, last = analyses(lamp("lamp"), 0)
    assert (last.pending, last.reachable_states, last.supervised_states) == (None, None, None)
    assert (last.supervisor, last.warnings) == (found(lamp("lamp")).supervisor, found(lamp("lamp")).warnings)


def test_a_supervisor_is_computed_once_by_whoever_needs_it_first(
    folder: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    first = supervisor_of(lamp("lamp"))
    monkeypatch.delattr(supervisor, "synthesise")
    assert supervisor_of(lamp("lamp")) == first
    with pytest.raises(ImportError):
        supervisor_of(lamp("not lamp"))


def test_what_a_controller_has_found_serves_commands_too(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    write(key(lamp("lamp")), found(lamp("lamp")))
    monkeypatch.delattr(supervisor, "synthesise")
    assert supervisor_of(lamp("lamp")) == found(lamp("lamp")).supervisor


def test_another_model_is_another_one() -> None:
    station = cell()[0].automaton
    assert key(cell()[0].automaton) == key(station)
    assert key(replace(station, rest=TRUE)) != key(station)
    assert key(replace(station, effects=station.effects[:-1])) != key(station)


def test_what_new_products_bring_counts_and_the_order_of_a_job_does_not() -> None:
    """A finding can be that nothing ever makes a condition true, and a new product may."""
    station = truck_engine()[0].automaton
    ((name, master),) = station.work_masters.items()
    assert key(replace(station, work_masters={name: replace(master, operations={})})) == key(station)
    assert key(replace(station, work_masters={name: replace(master, brings=())})) != key(station)


def test_where_nothing_can_be_written_nothing_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    write(key(lamp("lamp")), found(lamp("lamp")))
    assert read(key(lamp("lamp")), Analysis) is None


def test_without_a_home_nothing_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", homeless)
    write(key(lamp("lamp")), found(lamp("lamp")))
    assert read(key(lamp("lamp")), Analysis) is None
