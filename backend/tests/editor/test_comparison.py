"""How two models differ in what they do, and whether a running station can take another one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from editor.models import SPECIFICATIONS, bolts
from sequence_planner.analysis import kept
from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.finding import guards_of
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.editor.checks import checked, fitted
from sequence_planner.editor.comparing import behaviour
from sequence_planner.editor.comparing.comparison import compared
from sequence_planner.editor.schemas import what_if
from sequence_planner.editor.schemas.diff import ComparisonView, Difference, TransferView
from sequence_planner.language.types import Value
from sequence_planner.model.launch_requirements import StartNeeds
from support.places import BOLT_TIGHTENING
from support.told import as_message

RUN_NUT = "nutrunner.run_nut"
NUTRUNNER = "resources/nutrunner.yaml"
AT_PAIR_1: dict[str, Value | None] = {"robot.pose": "bolt_pair_1", "robot.target_pose": "bolt_pair_1"}


def compare(tmp_path: Path, old: dict[str, str], new: dict[str, str]) -> ComparisonView:
    with pytest.MonkeyPatch.context() as patched:
        for name in ("RUNS", "PLANS"):
            patched.setattr(behaviour, name, 60.0)  # seconds: a busy machine plans slowly
        *_, found = compared(old, new, BOLT_TIGHTENING, tmp_path)
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


def test_how_long_an_ability_may_take_and_usually_takes_is_told(tmp_path: Path) -> None:
    old = bolts()
    nutrunner = (
        old[NUTRUNNER].replace("{react: 5, finish: 30}", "{react: 5, finish: 12}").replace("[2, 4]", "[4.9, 5.8]")
    )
    view = compare(tmp_path, old, {**old, NUTRUNNER: nutrunner})
    assert parts(view, "ability") == {
        RUN_NUT: (
            Difference.CHANGED,
            {"must finish within": ("30 s", "12 s"), "usually takes": ("2 to 4 s", "4.9 to 5.8 s")},
        )
    }
    assert (view.behaviour, view.plans, view.undecided, view.unplanned) == ([], [], [], [])
    assert view.guards is not None
    assert view.guards[0] == view.guards[1] > 0
    assert view.parts is not None
    (part,) = view.parts
    assert part.titles == ["Run the nutrunner"]
    for each in part.parts:
        for said, told in ((each.before, each.before_message), (each.after, each.after_message)):
            assert told is not None
            assert as_message(told) == said


def test_a_condition_is_told_with_what_is_new_in_it_and_what_is_gone(tmp_path: Path) -> None:
    guard = "not tool_is_running_forward and tool_is_idle"
    old = bolts()
    assert guard in old[NUTRUNNER]
    other = old[NUTRUNNER].replace(guard, "not tool_is_running_forward and not robot.tool_is_attached")
    view = compare(tmp_path, old, {**old, NUTRUNNER: other})
    assert view.parts is not None
    (enabled,) = [each for part in view.parts if part.name == RUN_NUT for each in part.parts if each.part == "enabled"]
    assert [each.text for each in enabled.added] == ["not robot.tool_is_attached"]
    assert [each.text for each in enabled.dropped] == ["nutrunner.tool_is_idle"]
    assert all(each.sentence for each in (*enabled.added, *enabled.dropped))


def test_what_the_supervisor_adds_is_found_once_for_models_that_are_alike(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = tmp_path / "cache"
    cache.mkdir(mode=0o700)
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    found: list[str] = []

    def counted(automaton: Automaton, names: frozenset[str], known: Supervisor | None = None) -> Iterator[Analysis]:
        found.append(automaton.name)
        return guards_of(automaton, names, known)

    monkeypatch.setattr(kept, "guards_of", counted)
    folders = [tmp_path / name for name in ("first", "second", "third")]
    for folder in folders:
        folder.mkdir()
    later = {**bolts(), NUTRUNNER: bolts()[NUTRUNNER].replace("{react: 5, finish: 30}", "{react: 5, finish: 12}")}
    compare(folders[0], bolts(), later)
    assert len(found) == 1
    other = bolts(operations=("goal: robot.tool_is_attached", "goal: not robot.tool_is_attached"))
    *_, done = checked(1, other, BOLT_TIGHTENING, StartNeeds(), folders[1])
    assert done.analysis is not None
    view = compare(folders[2], later, other)
    assert len(found) == 1, "the check has found those of the other one"
    assert view.parts is not None
    assert not any(each.part.startswith("added") for part in view.parts for each in part.parts)


def test_what_may_start_is_answered_over_all_states_that_are_reached(tmp_path: Path) -> None:
    """A condition that never fails where the others hold changes nothing, and that is proven."""
    old = bolts()
    guard = "not tool_is_running_forward and tool_is_idle"
    more = old[NUTRUNNER].replace(guard, f"{guard} and (robot.pose == home or robot.pose != home)")
    view = compare(tmp_path, old, {**old, NUTRUNNER: more})
    assert (view.behaviour, view.undecided) == ([], [])
    assert view.states is not None
    assert view.states > 0


def test_plans_that_are_not_known_to_be_the_shortest_are_said_to_be_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(behaviour, "PLANS", 0.0)
    new = bolts(operations=("goal: bolts[pair] == tightened", "goal: bolts[pair] == placed"))
    *_, view = compared(bolts(), new, BOLT_TIGHTENING, tmp_path)
    assert view.plans == []
    assert view.unplanned == [f"tighten_bolt_pair(bolt_pair_{pair})" for pair in (1, 2, 3)]


def test_what_is_to_be_reached_is_planned_anew_also_in_a_station_that_moves_as_before(tmp_path: Path) -> None:
    tightened = bolts(operations=("goal: bolts[pair] == tightened", "goal: bolts[pair] == placed"))
    view = compare(tmp_path, bolts(), tightened)
    assert view.plans is not None
    assert [each.operation for each in view.plans] == [f"tighten_bolt_pair(bolt_pair_{pair})" for pair in (1, 2, 3)]
    assert all(len(each.after or ()) < len(each.before or ()) for each in view.plans)


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
    assert view.obstacle_message is not None
    assert as_message(view.obstacle_message) == view.obstacle


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
    assert view.violated == ["The nutrunner must turn before it meets placed bolts"]
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
    assert view.obstacle_message is not None
    assert as_message(view.obstacle_message) == view.obstacle
