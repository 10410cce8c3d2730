"""How a station would go on with a model that is not deployed."""

from __future__ import annotations

from pathlib import Path

from editor.models import bolts
from sequence_planner.editor.checks import simulated
from sequence_planner.editor.schemas.what_if import WhatIfView
from sequence_planner.language.types import Value
from support.places import BOLT_TIGHTENING

PLACED: dict[str, Value | None] = {f"bolts[bolt_pair_{number}]": "placed" for number in (1, 2, 3)}


def simulate(
    folder: Path, files: dict[str, str], present: dict[str, Value | None], seconds: float = 30.0
) -> WhatIfView:
    (found,) = simulated(files, BOLT_TIGHTENING, present, seconds, 60.0, folder)
    return found


def test_the_work_goes_on_from_the_state_that_is_given(tmp_path: Path) -> None:
    found = simulate(tmp_path, bolts(), PLACED)
    assert (found.seconds, found.safe, found.obstacle) == (30.0, True, None)
    assert found.before["bolts[bolt_pair_1]"] == "placed"
    tightened = [each.operation for each in found.completed if each.operation.startswith("tighten")]
    assert "tighten_bolt_pair(bolt_pair_1)" in tightened
    run = next(each for each in found.runs if each.ability == "nutrunner.run_nut")
    assert run.ended is not None
    assert 0 < run.started < run.ended <= 30.0
    assert run.title == "Run the nutrunner"
    assert [each.started for each in found.runs] == sorted(each.started for each in found.runs)


def test_a_model_without_its_operation_does_something_else(tmp_path: Path) -> None:
    text = bolts()["operations.yaml"]
    begin, end = text.index("tighten_bolt_pair:"), text.index("new_engine:")
    other = {**bolts(), "operations.yaml": text[:begin] + text[end:], "work_masters.yaml": ""}
    found = simulate(tmp_path, other, PLACED, 10.0)
    assert found.obstacle is None
    assert "nutrunner.run_nut" not in {each.ability for each in found.runs}


def test_from_outside_the_safe_states_nothing_is_started(tmp_path: Path) -> None:
    at_pair: dict[str, Value | None] = {"robot.pose": "bolt_pair_1", "robot.target_pose": "bolt_pair_1"}
    found = simulate(tmp_path, bolts(), {**at_pair, "bolts[bolt_pair_1]": "placed"}, 5.0)
    assert (found.safe, found.runs) == (False, [])


def test_what_cannot_be_used_says_so(tmp_path: Path) -> None:
    found = simulate(tmp_path, bolts(operations=("priority: 1", "priority: one")), {})
    assert (found.seconds, found.runs) == (0.0, [])
    assert "operations.yaml" in str(found.obstacle)
