"""A station in which there is nothing yet: it runs, so that it can be modelled from the page."""

from __future__ import annotations

from pathlib import Path

from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.planning.planner import Planner
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise


def test_it_ticks_and_has_nothing_to_plan(tmp_path: Path) -> None:
    (tmp_path / "station.yaml").write_text("name: cell\n", encoding="utf-8")
    automaton = prepare_station(tmp_path).automaton
    supervisor = synthesise(automaton)
    execution = Executor(automaton, supervisor)
    execution.start_production()
    outcome = execution.tick({}, Timestamp(1.0, 1.0))
    assert (outcome.started, outcome.conflicts, execution.active) == ((), (), frozenset())
    assert execution.request(1.0) is None
    assert execution.safe
    Planner(automaton, supervisor)
