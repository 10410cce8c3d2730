"""How two models differ in what they do, and whether a running station can take another one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from editor.models import SPECIFICATIONS, bolts
from sequence_planner.editor.checks import compared, fitted
from sequence_planner.editor.schemas import what_if
from sequence_planner.editor.schemas.diff import ComparisonView, Difference, TransferView
from sequence_planner.language.types import Value
from support.places import BOLT_TIGHTENING

RUN_NUT = "nutrunner.run_nut"
AT_PAIR_1: dict[str, Value | None] = {"robot.pose": "bolt_pair_1", "robot.target_pose": "bolt_pair_1"}


def compare(tmp_path: Path, old: dict[str, str], new: dict[str, str]) -> ComparisonView:
    (found,) = compared(old, new, BOLT_TIGHTENING, tmp_path)
    return found


def fit(
    tmp_path: Path,
    new: dict[str, str],
    present: dict[str, Value | None],
    running: tuple[str, ...] = (),
    *,
    reset: bool = False,
) -> TransferView:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(what_if, "ADVISING", 60.0)  # seconds: a busy machine finds ways late
        (found,) = fitted(bolts(), new, BOLT_TIGHTENING, present, running, reset, tmp_path)
    return found


def parts(view: ComparisonView, kind: str) -> dict[str, tuple[Difference, dict[str, tuple[Any, Any]]]]:
    assert view.parts is not None
    return {
        each.name: (each.state, {part.part: (part.before, part.after) for part in each.parts})
        for each in view.parts
        if each.kind == kind
    }


def test_the_same_model_in_other_words_does_the_same(tmp_path: Path) -> None:
    view = compare(tmp_path, bolts(), bolts(operations=("goal: bolts[pair] == placed", "goal: placed == bolts[pair]")))
    assert list(view.text) == ["operations.yaml"]
    assert "-  goal: bolts[pair] == placed\n+  goal: placed == bolts[pair]" in view.text["operations.yaml"]
    assert (view.behaviour, view.plans, view.obstacle) == ([], [], None)
    assert view.parts is not None
    (placing,) = view.parts
    assert (placing.kind, placing.name, placing.over) == ("operation", "place_bolt_pair(pair)", "all pair in bolt_pair")
    assert placing.members == [f"place_bolt_pair(bolt_pair_{number})" for number in (1, 2, 3)]
    assert [(each.before, each.after) for each in placing.parts] == [("bolts[pair] == placed", "placed == bolts[pair]")]


def test_a_predicate_is_told_by_its_name_with_what_it_means_beside(tmp_path: Path) -> None:
    tight, loose = "all pair in bolt_pair: bolts[pair] == tightened", "any pair in bolt_pair: bolts[pair] != tightened"
    written = bolts()
    written["station.yaml"] += f'\npredicates:\n  done: "{tight}"\n'
    old, new = dict(written), dict(written)
    for files, condition in ((old, "done"), (new, "not done")):
        files["operations.yaml"] += f"\nfinish:\n  precondition: true\n  goal: {condition}\n"
    view = compare(tmp_path, old, new)
    assert view.parts is not None
    (finish,) = view.parts
    (changed,) = finish.parts
    assert (changed.before, changed.after) == ("done", "not done")
    meaning = " and ".join(f"bolts[bolt_pair_{number}] == tightened" for number in (1, 2, 3))
    assert (changed.before_expanded, changed.after_expanded) == (meaning, f"not ({meaning})")
    new = dict(old)
    new["station.yaml"] = old["station.yaml"].replace(tight, loose)
    (tmp_path / "again").mkdir()
    view = compare(tmp_path / "again", old, new)
    assert view.parts is not None
    ((changed,),) = [each.parts for each in view.parts]
    assert changed.before == meaning, "of one name with two meanings these are told"
    assert (changed.before_expanded, changed.after_expanded) == (None, None)


def test_a_specification_that_is_gone_sets_starts_free(tmp_path: Path) -> None:
    old, new = bolts(), {path: text for path, text in bolts().items() if path != SPECIFICATIONS}
    view = compare(tmp_path, old, new)
    placing = parts(view, "ability")["operator.place_bolt_pair(pair)"]
    assert placing == (
        Difference.CHANGED,
        {"added by the supervisor": ("robot.pose != pair and robot.target_pose != pair", None)},
    )
    assert parts(view, "specification")["no_standing_tool_on_placed_bolts(pair)"][0] is Difference.GONE
    assert view.behaviour is not None
    gained = {each.ability: each for each in view.behaviour}["robot.move_to_position(bolt_pair_1)"]
    assert gained.lost is None
    assert gained.gained is not None
    assert set(gained.gained) == {"operator.place_bolt_pair(bolt_pair_1)", "robot.move_to_position(above_engine)"}


def test_an_ability_that_is_gone_costs_the_plans_that_need_it(tmp_path: Path) -> None:
    new = bolts()
    new["resources/robot.yaml"], _, _ = new["resources/robot.yaml"].partition("abilities:")
    view = compare(tmp_path, bolts(), new)
    assert {name for name, (state, _) in parts(view, "ability").items() if state is Difference.GONE} >= {
        "robot.move_to_position(home)",
        "robot.attach_in_planning_scene",
    }
    assert view.plans is not None
    plans = {each.operation: each for each in view.plans}
    assert plans["prepare_planning_scene"].before == ["robot.attach_in_planning_scene"]
    assert plans["prepare_planning_scene"].after is None


def test_a_model_that_cannot_be_used_is_compared_as_text(tmp_path: Path) -> None:
    view = compare(tmp_path, bolts(), bolts(operations=("priority: 1", "priority: one")))
    assert list(view.text) == ["operations.yaml"]
    assert (view.parts, view.plans) == (None, None)
    assert view.obstacle is not None
    assert "the newer one cannot be used: operations.yaml:" in view.obstacle


def test_a_state_goes_on_as_far_as_the_model_knows_it(tmp_path: Path) -> None:
    present: dict[str, Value | None] = {
        "robot.pose": "home",
        "robot.previous_pose": "nowhere",
        "robot.target_pose": "above_engine",
        "old.variable": 3,
    }
    view = fit(tmp_path, bolts(), present)
    assert view.legal
    changes = {each.name: (each.before, each.after) for each in view.changes}
    assert changes["old.variable"] == (3, None)
    assert changes["bolts[bolt_pair_1]"] == (None, "empty")
    assert changes["robot.previous_pose"] == ("nowhere", "home")
    assert not {"robot.pose", "robot.target_pose"} & changes.keys()


def test_of_a_station_that_is_reset_it_is_told_how_it_stands_and_how_it_will(tmp_path: Path) -> None:
    present: dict[str, Value | None] = {"robot.pose": "home", "robot.target_pose": "above_engine"}
    other = bolts(nutrunner=("set_tool_idle := true, run_tool_forward := false]", "set_tool_idle := true]"))
    view = fit(tmp_path, other, present, (RUN_NUT,), reset=True)
    assert (view.legal, view.under_way) == (True, [])
    changes = {each.name: (each.before, each.after) for each in view.changes}
    assert changes["robot.target_pose"] == ("above_engine", "home")
    assert "robot.pose" not in changes


def test_a_state_outside_the_safe_ones_is_refused_with_the_way_in(tmp_path: Path) -> None:
    view = fit(tmp_path, bolts(), {**AT_PAIR_1, "bolts[bolt_pair_1]": "placed"})
    assert not view.legal
    assert view.violated == ["The tool must turn before it meets placed bolts"]
    assert view.ways


def test_where_the_way_in_takes_starts_they_are_named(tmp_path: Path) -> None:
    view = fit(tmp_path, bolts(), {**AT_PAIR_1, "robot.target_pose": "bolt_pair_1", "bolts[bolt_pair_1]": "placed"})
    assert any("robot." in start or "nutrunner." in start for way in view.ways for start in way)


def test_what_runs_now_must_be_the_same_there(tmp_path: Path) -> None:
    renamed = bolts(nutrunner=("en: Run the nutrunner", "en: Run it"))
    other = bolts(nutrunner=("set_tool_idle := true, run_tool_forward := false]", "set_tool_idle := true]"))
    for number, (new, under_way) in enumerate(((bolts(), []), (renamed, []), (other, [RUN_NUT]))):
        folder = tmp_path / str(number)
        folder.mkdir()
        view = fit(folder, new, {}, (RUN_NUT,))
        assert (view.under_way, view.legal) == (under_way, not under_way)


def test_a_model_that_cannot_be_used_is_not_taken(tmp_path: Path) -> None:
    view = fit(tmp_path, bolts(operations=("priority: 1", "priority: one")), {})
    assert not view.legal
    assert "cannot be used" in str(view.obstacle)
