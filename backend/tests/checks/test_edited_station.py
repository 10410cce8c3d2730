"""The truck engine station after an edit: what is proven again of it is what is found out from nothing."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree

import pytest

from core.replaying import replay
from sequence_planner.analysis.checks.evidence import Evidence
from sequence_planner.analysis.checks.large_reachability import FarAnswers, from_afar
from sequence_planner.analysis.checks.supervised import subjects_of
from sequence_planner.cli.loading import load_model
from sequence_planner.synthesis.supervisor import supervised, supervisor
from support.examples import ONLY_TIMED
from support.places import BOLT_TIGHTENING

STATION = BOLT_TIGHTENING.with_name("truck_engine_station")
LOOSENED = (
    "position in docked implies end_effector.tool in {none, tool_at[position]}",
    "position in docked implies end_effector.tool in {none, tool_at[position]} or position == AttachAtlasTCPPose and "
    "end_effector.tool == OFTOOL",
)
TIGHTENED = (
    "position in bolt_pair implies end_effector.tool == ATLASTOOL",
    "position in bolt_pair implies end_effector.tool == ATLASTOOL and end_effector.rsp_is_locked",
)

PLANNING = 120.0  # seconds at most: without runs that are known all takes much longer, also beside other tests


def found(station: Path, known: Evidence | None = None) -> FarAnswers:
    """What is found of a station, with what is `known` of it from before an edit or without."""
    automaton = load_model(station).automaton
    supervision = supervised(automaton)
    safe = supervision.plant.diagrams.exported(supervision.safe)
    return from_afar(automaton, list(subjects_of(automaton)), safe, supervisor(supervision), PLANNING, known)


@pytest.fixture(scope="module")
def known() -> Evidence:
    """What the answers about the station rest on."""
    evidence = found(STATION).evidence
    assert evidence is not None
    return evidence


@pytest.mark.timeout(1200)
@pytest.mark.parametrize(
    "edit",
    # From nothing, the one that is loosened takes minutes: it is for `make campaign`.
    [pytest.param(LOOSENED, marks=ONLY_TIMED), TIGHTENED],
    ids=["loosened", "tightened"],
)
def test_after_an_edit_of_a_guard_the_same_is_found_as_from_nothing(
    known: Evidence, edit: tuple[str, str], tmp_path: Path
) -> None:
    """Tried on that very station, as its sets of states are what random stations do not have: large."""
    edited = copytree(STATION, tmp_path / STATION.name)
    file = edited / "resources" / "robot.yaml"
    text = file.read_text(encoding="utf-8")
    assert edit[0] in text
    file.write_text(text.replace(*edit), encoding="utf-8")
    again, anew = found(edited, known), found(edited)
    assert again.findings
    assert [(each.subject.name, each.kind, each.message) for each in again.findings] == [
        (each.subject.name, each.kind, each.message) for each in anew.findings
    ]
    automaton = load_model(edited).automaton
    for each in again.findings:
        assert each.trace is not None
        replay(automaton, each.trace)
