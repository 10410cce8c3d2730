from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.model.loading import load_station
from sequence_planner.synthesis.enumeration import Enumeration, enumerate_states, synthesise

STATIONS = Path(__file__).parent.parent / "stations"


@pytest.fixture(scope="session")
def worked_example() -> Automaton:
    """The station of the worked example, read from its folder as any other."""
    return ground(load_station(STATIONS / "worked_example"))


@pytest.fixture(scope="session")
def enumeration(worked_example: Automaton) -> Enumeration:
    """All states of the worked example."""
    return enumerate_states(worked_example)


@pytest.fixture(scope="session")
def supervisor(worked_example: Automaton) -> Supervisor:
    """The supervisor of the worked example."""
    return synthesise(worked_example)
