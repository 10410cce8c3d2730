"""What is suspicious in a station as it is written, its scenarios among it."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.analysis.checks.warning import ModelWarning
from sequence_planner.analysis.written import suspicious_in
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.model.loader import Station
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.scenarios.scenario import unusable_scenarios_of


def all_suspicions(
    station: Station | None, automaton: Automaton, pipelines: StationPipelines
) -> Iterator[ModelWarning]:
    """Yield what is suspicious in the documents and pipelines of a station, and each scenario that cannot be carried
    out.
    """
    yield from suspicious_in(station, automaton, pipelines)
    if station is not None:
        for finding in unusable_scenarios_of(automaton, station, pipelines):
            yield ModelWarning(finding.place, "broken-scenario", finding.message)
