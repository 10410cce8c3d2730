"""The models that benchmarks write: the truck engine station several times in one, and a large one."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.station import prepare_station
from support.places import MODELS, REPOSITORY

WRITERS = REPOSITORY / "backend" / "benchmarks" / "stations"


def written(folder: Path, writer: str, *arguments: str) -> Automaton:
    """The model that a writer writes into the folder."""
    subprocess.run([sys.executable, str(WRITERS / writer), str(folder), *arguments], check=True)
    return prepare_station(folder).automaton


@pytest.mark.parametrize("number", [1, 2])
def test_each_station_beside_others_has_all_that_one_has(tmp_path: Path, number: int) -> None:
    alone = prepare_station(MODELS / "truck_engine_station").automaton
    several = written(tmp_path, "several.py", str(number))
    assert len(several.variables) == number * len(alone.variables)
    assert len(several.abilities) == number * len(alone.abilities)
    assert len(several.operations) == number * len(alone.operations)


def test_a_large_model_can_be_loaded(tmp_path: Path) -> None:
    assert len(written(tmp_path, "large.py").abilities) == 1000
