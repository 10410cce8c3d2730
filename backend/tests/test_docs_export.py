"""What the page about exports shows is what the program prints, and what it says of the worked example is so."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from sequence_planner.exporting.station import plain_of_station
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.supervision import Supervision

REPOSITORY = Path(__file__).parents[2]
TEXT = (REPOSITORY / "docs" / "export.md").read_text(encoding="utf-8")
SESSIONS = re.findall(r"^```console\n\$ (.*)\n((?:.*\n)*?)```$", TEXT, re.MULTILINE)


def test_there_is_something_to_try() -> None:
    assert len(SESSIONS) == 2


@pytest.mark.parametrize(("line", "printed"), SESSIONS)
def test_it_prints_what_is_shown(line: str, printed: str) -> None:
    program = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", line],
        cwd=REPOSITORY,
        env={**os.environ, "PATH": program},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.stdout == printed


def test_how_many_states_there_are() -> None:
    [here, there] = map(int, re.findall(r"has (\d+) of its own and (\d+) in all", TEXT)[0])
    station = prepare_station(REPOSITORY / "backend" / "tests" / "stations" / "worked_example").automaton
    for automaton, count in ((station, here), (plain_of_station(station), there)):
        supervision = Supervision(Plant(automaton, tuple(automaton.variables)))
        assert supervision.plant.diagrams.count(supervision.reachable(supervised=False)) == count
