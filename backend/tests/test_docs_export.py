"""What the page about exports says of the worked example is so; what it shows is tried with the command line's page."""

from __future__ import annotations

import re

from sequence_planner.export.efa import plain_of_station
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import Plant
from support.places import DOCS, WORKED_EXAMPLE

TEXT = (DOCS / "export.md").read_text(encoding="utf-8")


def test_how_many_states_there_are() -> None:
    [here, there] = map(int, re.findall(r"has (\d+) of its own and (\d+) in all", TEXT)[0])
    station = prepare_station(WORKED_EXAMPLE).automaton
    for automaton, count in ((station, here), (plain_of_station(station), there)):
        supervision = Supervision(Plant(automaton, tuple(automaton.variables)))
        assert supervision.plant.diagrams.count(supervision.reachable(supervised=False)) == count
