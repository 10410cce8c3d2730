"""A station after an edit: what is proven again of it is what is found out from nothing."""

from __future__ import annotations

from functools import cache
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

ROBOT = Path("resources", "robot.yaml")
EDITS = {
    ("bolt_tightening", "loosened"): (
        "(pose == above_engine or position == above_engine)",
        "(pose == above_engine or position in {above_engine, home})",
    ),
    ("bolt_tightening", "tightened"): (
        "enabled: tool_is_attached and attach_tool",
        "enabled: tool_is_attached and attach_tool and pose == unknown and not moving",
    ),
    ("truck_engine_station", "loosened"): (
        "position in docked implies end_effector.tool in {none, tool_at[position]}",
        "position in docked implies end_effector.tool in {none, tool_at[position]} or position == AttachAtlasTCPPose "
        "and end_effector.tool == OFTOOL",
    ),
    ("truck_engine_station", "tightened"): (
        "position in bolt_pair implies end_effector.tool == ATLASTOOL",
        "position in bolt_pair implies end_effector.tool == ATLASTOOL and end_effector.rsp_is_locked",
    ),
}

PLANNING = 120.0  # seconds at most: without runs that are known all takes much longer, also beside other tests


def found(station: Path, known: Evidence | None = None) -> FarAnswers:
    """What is found of a station, with what is `known` of it from before an edit or without."""
    automaton = load_model(station).automaton
    supervision = supervised(automaton)
    safe = supervision.plant.diagrams.exported(supervision.safe)
    return from_afar(automaton, list(subjects_of(automaton)), safe, supervisor(supervision), PLANNING, known)


@cache
def known(station: Path) -> Evidence:
    """What the answers about `station` rest on."""
    evidence = found(station).evidence
    assert evidence is not None
    return evidence


# From nothing the truck engine station takes minutes: it is for `make campaign`.
@pytest.mark.timeout(1200)
@pytest.mark.parametrize(
    ("name", "edit"),
    [pytest.param(*each, marks=ONLY_TIMED if each[0] == "truck_engine_station" else ()) for each in EDITS],
)
def test_after_an_edit_of_a_guard_the_same_is_found_as_from_nothing(name: str, edit: str, tmp_path: Path) -> None:
    """Tried on stations that people have, as their sets of states are what random stations do not have: large."""
    station = BOLT_TIGHTENING.with_name(name)
    edited = copytree(station, tmp_path / name)
    before, after = EDITS[name, edit]
    text = (edited / ROBOT).read_text(encoding="utf-8")
    assert before in text
    (edited / ROBOT).write_text(text.replace(before, after), encoding="utf-8")
    again, anew = found(edited, known(station)), found(edited)
    assert bool(again.findings) == (edit == "tightened" or name == "truck_engine_station")
    assert [(each.subject.name, each.kind, each.message) for each in again.findings] == [
        (each.subject.name, each.kind, each.message) for each in anew.findings
    ]
    automaton = load_model(edited).automaton
    for each in again.findings:
        # Of what never happens there is no run.
        assert (each.trace is None) == (each.kind == "never-starts")
        if each.trace is not None:
            replay(automaton, each.trace)
