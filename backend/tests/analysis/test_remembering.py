"""What the controller has found is there at its next start, and never taken from where others could have put it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.cache import MOST_KEPT, cache, remember, remembered, supervisor_of
from sequence_planner.analysis.finding import analyses
from sequence_planner.analysis.mutual_exclusion import NeverTogether
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.types import BOOLEAN
from sequence_planner.synthesis import supervisor
from support.automata import Does, automaton


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
    remember(folder, lamp("lamp"), found(lamp("lamp")))
    assert remembered(folder, lamp("lamp"), Analysis) == found(lamp("lamp"))
    assert remembered(folder, lamp("not lamp"), Analysis) is None


def test_nothing_is_known_at_first_or_of_a_damaged_file(folder: Path) -> None:
    assert remembered(folder, lamp("lamp"), Analysis) is None
    remember(folder, lamp("lamp"), found(lamp("lamp")))
    [file] = folder.iterdir()
    file.write_bytes(b"\x80\x04nonsense")
    assert remembered(folder, lamp("lamp"), Analysis) is None


def test_a_file_of_which_one_bit_is_wrong_is_not_believed(folder: Path) -> None:
    """Another set of safe states would be one in which robots are let loose."""
    remember(folder, lamp("lamp"), supervisor_of(lamp("lamp")))
    [file] = folder.iterdir()
    content = file.read_bytes()
    for place in range(0, len(content), 7):
        file.write_bytes(content[:place] + bytes([content[place] ^ 4]) + content[place + 1 :])
        assert remembered(folder, lamp("lamp"), Supervisor) is None
    file.write_bytes(content)
    assert remembered(folder, lamp("lamp"), Supervisor) == supervisor_of(lamp("lamp"))


def test_a_folder_that_others_can_use_is_neither_written_nor_read(folder: Path) -> None:
    remember(folder, lamp("lamp"), found(lamp("lamp")))
    folder.chmod(0o755)
    assert remembered(folder, lamp("lamp"), Analysis) is None
    [file] = folder.iterdir()
    file.unlink()
    remember(folder, lamp("lamp"), found(lamp("lamp")))
    assert not list(folder.iterdir())


def test_only_the_newest_are_kept_of_each_kind(folder: Path) -> None:
    nothing = NeverTogether(frozenset(), None)
    remember(folder, lamp("lamp"), nothing)
    for number in range(MOST_KEPT + 5):
        goal = " and ".join(["lamp"] * (number + 1))
        remember(folder, lamp(goal), found(lamp("lamp")))
        file = max(folder.glob("analysis-*"), key=lambda each: each.stat().st_mtime_ns)
        os.utime(file, (number, number))
    assert len(list(folder.glob("analysis-*"))) == MOST_KEPT
    assert remembered(folder, lamp("lamp"), Analysis) is None, "it was the first"
    assert remembered(folder, lamp(goal), Analysis) == found(lamp("lamp"))
    assert remembered(folder, lamp("lamp"), NeverTogether) == nothing


def test_the_cache_is_used_where_it_is_the_users_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    found_here = cache()
    assert found_here == tmp_path / "sequence-planner"
    assert found_here.stat().st_mode & 0o777 == 0o700
    found_here.chmod(0o750)
    assert cache() is None
    found_here.rmdir()
    found_here.write_text("in the way")
    assert cache() is None


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
    where = cache()
    assert where is not None
    remember(where, lamp("lamp"), found(lamp("lamp")))
    monkeypatch.delattr(supervisor, "synthesise")
    assert supervisor_of(lamp("lamp")) == found(lamp("lamp")).supervisor
