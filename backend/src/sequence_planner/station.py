"""A station ready to run: its automaton, its pipelines and its message types, all checked."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from sequence_planner.automaton.grounding.declarations import OPERATION
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.structure import Automaton
from sequence_planner.collection import collection_put_off
from sequence_planner.model.loading import load_station
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.pipelines.building import build_pipelines, load_messages
from sequence_planner.pipelines.inference import with_inferred_variables
from sequence_planner.pipelines.pipeline import StationPipelines
from sequence_planner.planning.plan import NO_FORMULAS
from sequence_planner.ros.messages import MessageRegistry


@dataclass(frozen=True)
class ReadyStation:
    """What the controller runs, and what the emulated devices are made from."""

    automaton: Automaton
    pipelines: StationPipelines
    registry: MessageRegistry


@collection_put_off()
def prepare_station(folder: Path) -> ReadyStation:
    """Load and check a station's folder. Raises `ModelError` with the findings."""
    written = load_station(folder)
    registry = load_messages(written)
    station = with_inferred_variables(written, registry)
    automaton = ground(station)
    return ReadyStation(automaton, build_pipelines(station, automaton, registry), registry)


def require_runnable(station: ReadyStation) -> None:
    """Raises `ModelError` when the model says something that a running station would not keep to."""
    automaton = station.automaton
    formulas = [f"{OPERATION}.{o.name}.local" for o in automaton.operations.values() if o.local is not None]
    if formulas:
        raise ModelError([Finding(automaton.places[formula], NO_FORMULAS) for formula in formulas])
