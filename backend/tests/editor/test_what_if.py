"""How a station would go on with a model that is not deployed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from editor.models import bolts
from sequence_planner.editor.checks import simulated
from sequence_planner.editor.schemas.what_if import WhatIfView
from sequence_planner.language.types import Value
from sequence_planner.model.files import read_files
from support.places import BOLT_TIGHTENING, MODELS
from support.told import as_message

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
    assert found.obstacle_message is not None
    assert as_message(found.obstacle_message) == found.obstacle


def _each_in(folder: Path, *models: dict[str, str]) -> Iterator[tuple[Path, dict[str, str]]]:
    """Each model with an empty folder of its own."""
    for number, files in enumerate(models):
        (folder / str(number)).mkdir()
        yield folder / str(number), files


TYPE = "types/robot.yaml"
NAMES = """
sets:
  at_engine: {of: named_pose, except: [home]}
relations:
  adjacent: {between: [named_pose, named_pose], symmetric: true, pairs: [[above_engine, named_pose]]}
maps:
  pose_of: {from: bolt_pair, to: pose, values: {bolt_pair_1: bolt_pair_1}, otherwise: bolt_pair_2}
predicates:
  all_tight: "all pair in bolt_pair: bolts[pair] == tightened"

# No sensor"""


def test_a_draft_with_names_for_what_is_said_more_than_once_goes_on_like_one_without(tmp_path: Path) -> None:
    tight = " and ".join(f"bolts[bolt_pair_{number}] == tightened" for number in (1, 2, 3))
    written = "pose != position and (pose == above_engine or position == above_engine)"
    short = bolts(
        station=("\n# No sensor", NAMES),
        operations=(f">-\n    {tight}", "all_tight"),
        robot=(written, "pose != position and free(position)"),
    )
    robot = short["resources/robot.yaml"]
    assert "\nabilities:" in robot
    free = "\npredicates:\n  free: {parameters: {to: named_pose}, when: 'adjacent(pose, to)'}\n\nabilities:"
    short["resources/robot.yaml"] = robot.replace("\nabilities:", free, 1)
    found, plain = (simulate(folder, files, PLACED) for folder, files in _each_in(tmp_path, short, bolts()))
    assert found.obstacle is None
    # How many abilities that takes is the planner's choice, which has less time on a busy machine.
    assert {_plain(each.ability) for each in found.runs} == {_plain(each.ability) for each in plain.runs}
    for run in (found, plain):
        assert {each.operation for each in run.completed} >= {f"tighten_bolt_pair(bolt_pair_{n})" for n in (1, 2, 3)}


def _plain(ability: str) -> str:
    return ability.partition("(")[0]


def test_a_draft_with_instances_of_a_type_goes_on(tmp_path: Path) -> None:
    robots = MODELS / "robots_with_buffer"
    files = read_files(robots)
    slow = {**files, TYPE: files[TYPE].replace("takes: [1, 2]", "takes: [8, 9]")}
    found, later = (
        next(iter(simulated(each, robots, {}, 30.0, 60.0, folder))) for folder, each in _each_in(tmp_path, files, slow)
    )
    assert found.obstacle is None
    assert {"robot_1.pick", "robot_1.move_to(buffer)", "robot_2.move_to(buffer)"} <= {
        each.ability for each in found.runs
    }
    assert len(later.completed) < len(found.completed)
