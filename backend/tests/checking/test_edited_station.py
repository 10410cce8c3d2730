"""The truck engine station after an edit: what is proven again of it is what is found out from nothing."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree

import pytest

from cli.commands import TRUCK
from core.replaying import replay
from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.finding import without_numbers
from sequence_planner.checking.evidence import Evidence
from sequence_planner.cli.loading import load_model

STATION = TRUCK.with_name("truck_engine_station")
LOOSENED = (
    "position == AttachAtlasTCPPose implies end_effector.tool in {none, ATLASTOOL}",
    "position == AttachAtlasTCPPose implies end_effector.tool in {none, ATLASTOOL, OFTOOL}",
)


def found(station: Path, known: Evidence | None = None) -> tuple[Analysis, Evidence]:
    """What is found of a station, with what is `known` of it from before an edit or without, and what that rests on."""
    analysis = evidence = None
    for analysis in without_numbers(load_model(station).automaton, guards=False, far=True, evidence=known):
        evidence = analysis.evidence or evidence
    assert analysis is not None and evidence is not None
    return analysis, evidence


@pytest.mark.timeout(1200)
def test_after_a_guard_was_loosened_the_same_is_found_as_from_nothing(tmp_path: Path) -> None:
    """Tried on that very station, as its sets of states are what random stations do not have: large."""
    _, known = found(STATION)
    edited = copytree(STATION, tmp_path / STATION.name)
    file = edited / "resources" / "robot.yaml"
    text = file.read_text(encoding="utf-8")
    assert LOOSENED[0] in text
    file.write_text(text.replace(*LOOSENED), encoding="utf-8")
    again, evidence = found(edited, known)
    anew, _ = found(edited)
    assert evidence.ways and evidence.traps  # it was proven again, and not only its runs taken
    assert again.warnings is not None and anew.warnings is not None
    assert [(each.place, each.kind, each.message) for each in again.warnings] == [
        (each.place, each.kind, each.message) for each in anew.warnings
    ]
    for warning in again.warnings:
        if warning.trace is not None:
            replay(load_model(edited).automaton, warning.trace)
    assert again.guarded == anew.guarded
    assert again.supervised_at_most is not None and again.supervised_at_most > 0
