"""A station ready to run: its automaton, its pipelines and its message types, all checked."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from sequence_planner.automaton.grounding import ground
from sequence_planner.automaton.structure import Automaton
from sequence_planner.model.loading import load_station
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.pipelines.building import build_pipelines, load_messages
from sequence_planner.pipelines.pipeline import StationPipelines
from sequence_planner.ros.messages import MessageRegistry


@dataclass(frozen=True)
class ReadyStation:
    """What the controller runs, and what the emulated devices are made from."""

    automaton: Automaton
    pipelines: StationPipelines
    registry: MessageRegistry


def prepare_station(folder: Path) -> ReadyStation:
    """Load and check a station's folder. Raises `ModelError` with the findings."""
    station = load_station(folder)
    findings: list[Finding] = []
    try:
        automaton = ground(station)
    except ModelError as error:
        findings += error.findings
    try:
        registry = load_messages(station)
    except ModelError as error:
        findings += error.findings
    if findings:
        raise ModelError(findings)
    return ReadyStation(automaton, build_pipelines(station, automaton, registry), registry)
