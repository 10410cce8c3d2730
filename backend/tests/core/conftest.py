from __future__ import annotations

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.model.loader import load_station
from sequence_planner.synthesis.supervisor import Supervision, relevant, synthesise
from sequence_planner.synthesis.transition_relation import Plant
from support.places import WORKED_EXAMPLE


@pytest.fixture(scope="session")
def worked_example() -> Automaton:
    """The station of the worked example, read from its folder as any other."""
    return ground(load_station(WORKED_EXAMPLE))


@pytest.fixture(scope="session")
def supervision(worked_example: Automaton) -> Supervision:
    """The safe states of the worked example."""
    return Supervision(Plant(worked_example, relevant(worked_example)))


@pytest.fixture(scope="session")
def supervisor(worked_example: Automaton) -> Supervisor:
    """The supervisor of the worked example."""
    return synthesise(worked_example)
