"""What the controller has found is there at its next start, and never taken from where others could have put it."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.building import Does, automaton
from sequence_planner.analysis.analysis import Analysis, analyses
from sequence_planner.analysis.remembering import NAME, remember, remembered
from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.types import BOOLEAN


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
    assert remembered(folder, lamp("lamp")) == found(lamp("lamp"))
    assert remembered(folder, lamp("not lamp")) is None


def test_nothing_is_known_at_first_or_of_a_damaged_file(folder: Path) -> None:
    assert remembered(folder, lamp("lamp")) is None
    (folder / NAME).write_bytes(b"\x80\x04nonsense")
    assert remembered(folder, lamp("lamp")) is None


def test_a_folder_that_others_can_use_is_neither_written_nor_read(folder: Path) -> None:
    remember(folder, lamp("lamp"), found(lamp("lamp")))
    folder.chmod(0o755)
    assert remembered(folder, lamp("lamp")) is None
    (folder / NAME).unlink()
    remember(folder, lamp("lamp"), found(lamp("lamp")))
    assert not (folder / NAME).exists()
