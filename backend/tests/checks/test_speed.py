"""A station of a thousand abilities is checked while somebody waits."""

from __future__ import annotations

import time
from pathlib import Path

from checks.large import write_large_station
from sequence_planner.analysis.checks.rules import check_automaton
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.model.loader import load_station
from support.examples import TIMED


def test_a_thousand_abilities(tmp_path: Path) -> None:
    automaton = ground(load_station(write_large_station(tmp_path / "large")))
    assert len(automaton.abilities) == 1000
    began = time.process_time()
    assert check_automaton(automaton) == []
    assert not TIMED or time.process_time() - began < 2  # 0.5 s on a machine that does nothing else
