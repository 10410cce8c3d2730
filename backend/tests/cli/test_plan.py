"""`plan`: how goals would be reached."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from pytest import MonkeyPatch

from sequence_planner.export.unified import installed
from support.commands import as_json, command, plain
from support.places import MODELS, TRUCK_ENGINE_STATION, WORKED_EXAMPLE

PLACED = json.dumps({"state": {"bolts": "placed"}})


def test_the_plan_of_the_worked_example() -> None:
    """Six ticks and three starts, as the semantics says."""
    code, document = as_json("plan", WORKED_EXAMPLE, "--state", "-", given=PLACED)
    assert (code, document["status"], document["contract"]) == (0, "plan", "minimal")
    assert (document["goals"], document["left_out"], document["ticks"]) == (["tighten_bolt_pair"], [], 6)
    assert [sorted(tick["starts"]) for tick in document["schedule"]] == [
        ["nutrunner.run_nut", "robot.move(above)"],
        [],
        ["robot.move(bolt_pair)"],
        [],
        [],
        [],
    ]
    assert sorted(document["starts"]) == ["nutrunner.run_nut", "robot.move(above)", "robot.move(bolt_pair)"]
    assert document["engine"]


def test_a_fast_plan_says_so_or_is_minimal() -> None:
    code, document = as_json("plan", WORKED_EXAMPLE, "--state", "-", "--contract", "fast", given=PLACED)
    assert (code, document["status"]) == (0, "plan")
    assert document["contract"] in ("fast", "minimal")
    assert document["ticks"] >= 6
    assert document["searched"] <= 6


def test_a_plan_for_people() -> None:
    """A lane for each resource that does something."""
    code, out, err = command("plan", WORKED_EXAMPLE, "tighten_bolt_pair", "--state", "-", given=PLACED)
    assert (code, err) == (0, "")
    *lanes, said = [line.split() for line in out.splitlines()]
    assert lanes[0] == ["tick", "nutrunner", "robot"]
    assert lanes[1] == ["1", "run_nut", "move(above)"]
    assert lanes[-1] == ["6", "└", "done"]
    text = "tighten_bolt_pair: 6 ticks and 3 starts, the fewest ticks, then the fewest starts ("
    assert " ".join(said).startswith(text)


def test_what_is_expected_is_shown_when_asked_for() -> None:
    _, out, _ = command("plan", WORKED_EXAMPLE, "tighten_bolt_pair", "--state", "-", "--expected", given=PLACED)
    assert out.splitlines()[-3].split() == ["6", "~", "run_nut.torque_is_reached"]


def test_lanes_that_do_not_fit_become_one(monkeypatch: MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    _, out, _ = command("plan", WORKED_EXAMPLE, "tighten_bolt_pair", "--state", "-", given=PLACED)
    assert out.splitlines()[1] in ("      robot.move(above)", "      nutrunner.run_nut")


def test_what_holds_already_needs_no_plan() -> None:
    code, out, _ = command("plan", WORKED_EXAMPLE, "--goal", "robot.pose == home")
    assert (code, out) == (0, "robot.pose == home: nothing to do, all of it holds already\n")
    assert as_json("plan", WORKED_EXAMPLE, "--goal", "robot.pose == home")[1]["contract"] == "minimal"


def test_goals_by_expression() -> None:
    code, document = as_json("plan", WORKED_EXAMPLE, "--goal", "robot.pose == above", "--goal", "bolts == placed")
    assert (code, set(document["goals"])) == (0, {"robot.pose == above", "bolts == placed"})
    assert sorted(document["starts"]) == ["operator.place_bolt", "robot.move(above)"]
    code, _, err = command("plan", WORKED_EXAMPLE, "--goal", "robot.pose = above")
    assert (code, err.startswith("--goal 'robot.pose = above': ")) == (2, True)


def test_circumstances() -> None:
    goal = ("plan", WORKED_EXAMPLE, "--goal", "robot.pose == above")
    assert as_json(*goal)[1]["status"] == "plan"
    code, document = as_json(*goal, "--offline", "robot")
    assert (code, document["status"]) == (1, "none")
    assert document["proof"]["invariant"]
    assert as_json(*goal, "--avoid", "robot.target_pose == above")[1]["status"] == "none"
    assert as_json(*goal, "--without", "robot.move(home)")[1]["status"] == "plan"
    code, document = as_json(*goal, "--without", "robot.move(above)")
    assert (code, document["status"]) == (1, "none")
    assert command("plan", WORKED_EXAMPLE, "--offline", "robo")[0::2] == (
        2,
        "there is no resource `robo`; did you mean `robot`?\n",
    )
    assert command("plan", WORKED_EXAMPLE, "--without", "robot.move(abov)")[0::2] == (
        2,
        "there is no ability `robot.move(abov)`; did you mean `robot.move(above)`?\n",
    )


def test_it_says_why_there_is_no_plan_at_all() -> None:
    goal = ("plan", WORKED_EXAMPLE, "--goal", "robot.pose == above", "--offline", "robot", "--offline", "operator")
    code, out, _ = command(*goal)
    first, *rest = out.splitlines()
    assert (code, first.startswith("no plan at all, proven: robot.pose == above (")) == (1, True)
    assert rest == [
        "as long as all of these stay as they are",
        "      robot.pose is home",
        "      robot is offline",
        "      the goal robot.pose == above",
        "there would be a plan again with",
        "      robot online",
    ]
    _, document = as_json(*goal)
    assert document["why"]["minimal"]
    assert {"part": "offline", "name": "robot", "value": None} in document["why"]["members"]
    assert document["why"]["corrections"] == [[{"name": "robot", "value": None}]]


def test_it_says_which_ability_out_of_service_is_in_the_way() -> None:
    goal = ("plan", WORKED_EXAMPLE, "--goal", "robot.pose == above", "--without", "robot.move(above)")
    code, out, _ = command(*goal)
    assert (code, out.splitlines()[1:]) == (
        1,
        [
            "as long as all of these stay as they are",
            "      robot.pose is home",
            "      robot.target_pose is home",
            "      robot.move(above) is out of service",
            "      the goal robot.pose == above",
            "there would be a plan again with",
            "      robot.move(above) in service",
        ],
    )
    _, document = as_json(*goal)
    assert {"part": "barred", "name": "robot.move(above)", "value": None} in document["why"]["members"]


@pytest.mark.skipif(installed(), reason="the planners are installed")
def test_another_planner_needs_the_extra() -> None:
    code, _, err = command("plan", WORKED_EXAMPLE, "--goal", "robot.pose == above", "--with", "fast-downward")
    needs = "fast-downward needs the libraries of the extra `pddl`: run `pip install .[pddl]` in `backend`\n"
    assert (code, err) == (2, needs)


@pytest.mark.skipif(not installed(), reason="needs the libraries of the extra `pddl`")
def test_another_planner_finds_a_fast_plan() -> None:
    goal = ("plan", WORKED_EXAMPLE, "--goal", "robot.pose == above", "--with", "fast-downward")
    code, document = as_json(*goal)
    assert (code, document["status"], document["starts"]) == (0, "plan", ["robot.move(above)"])
    code, _, err = command(*goal[:-1], "fast-upward")
    assert (code, err.startswith("there is no planner `fast-upward`; did you mean `fast-downward`?")) == (2, True)


def test_nothing_to_plan_for() -> None:
    code, _, err = command("plan", WORKED_EXAMPLE)
    assert (code, err) == (2, "no operation is active in this state: name one whose goal to plan, or give a --goal\n")


def test_no_plan() -> None:
    """With the acknowledgement unknown nobody can place a bolt."""
    given = json.dumps({"state": {"operator.acknowledged": None}})
    code, out, _ = command("plan", WORKED_EXAMPLE, "tighten_bolt_pair", "--state", "-", given=given)
    assert code == 1
    assert out.startswith("no plan at all, proven: tighten_bolt_pair (")


def test_an_operation_that_is_none() -> None:
    code, _, err = command("plan", WORKED_EXAMPLE, "tighten")
    assert (code, err) == (2, "there is no operation `tighten`; did you mean `tighten_bolt_pair`?\n")


def test_of_a_sequence_and_of_a_work_master_the_operations_are_named(tmp_path: Path) -> None:
    model = Path(shutil.copytree(MODELS / "docking_agv", tmp_path / "model"))
    with (model / "operations.yaml").open("a", encoding="utf-8") as operations:
        operations.write(
            "all_of_it:\n  sequence: [supply, assemble]\nsupply:\n  parallel: [hand_over_kit, fetch_kit]\n"
        )
    plans = "and a plan is for operations that are active together: name some (its operations are"
    for name, what, within in (
        ("all_of_it", "a sequence", "`fetch_kit`, `hand_over_kit`, `assemble`"),
        ("supply", "a sequence", "`fetch_kit`, `hand_over_kit`"),
        ("supply_and_assemble", "a work master", "`fetch_kit`, `hand_over_kit`, `assemble`"),
    ):
        assert command("plan", model, name) == (2, "", f"`{name}` is {what}, {plans} {within})\n")
    code, _, err = command("plan", TRUCK_ENGINE_STATION, "tighten_bolts")
    assert (code, err.partition("(")[0]) == (2, f"`tighten_bolts` is a sequence, {plans.partition('(')[0]}")
    assert err.endswith(" and 2 more)\n")


def test_a_plain_automaton(tmp_path: Path) -> None:
    file = plain(tmp_path)
    assert command("plan", file)[0::2] == (2, "no goal of it has the form `F p`: give a --goal\n")
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace('"marked"', '"goal": ["F (user == has)"], "marked"'), encoding="utf-8")
    code, document = as_json("plan", file)
    assert (code, document["status"], document["goals"], document["contract"]) == (0, "plan", ["goal_1"], "minimal")
    assert document["starts"] == document["transitions"] == ["ask", "grab"]
    code, document = as_json("plan", file, "--goal", "user == has and free")
    assert (code, document["status"]) == (1, "none")
    assert {"part": "goal", "name": "user == has and free", "value": None} in document["why"]["members"]
    assert command("plan", file, "--restart")[0] == 2


def test_of_several_initial_states_it_says_why_from_which_there_is_no_plan(tmp_path: Path) -> None:
    document = {
        "name": "doors",
        "variables": {"key": ["lost", "broken", "here"], "door": "bool", "inside": "bool"},
        "initial": "(key == lost or key == broken) and not inside",
        "transitions": [
            {"event": "open", "controllable": True, "guard": "key == here", "set": {"door": True}},
            {"event": "enter", "controllable": True, "guard": "door", "set": {"inside": True}},
            {"event": "mend", "controllable": True, "guard": "key == broken and inside", "set": {"key": "here"}},
        ],
    }
    file = tmp_path / "doors.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    code, found = as_json("plan", file, "--goal", "key == here and not inside")
    assert (code, found["status"], found["why"]) == (1, "none", found["initially"][0]["why"])
    explained = [state for reason in found["initially"] for state in reason["states"]]
    assert sorted((state["key"], state["door"]) for state in explained) == [
        ("broken", False), ("broken", True), ("lost", False), ("lost", True),
    ]  # fmt: skip
    for reason in found["initially"]:
        values = {each["name"]: each["value"] for each in reason["why"]["members"] if each["part"] == "value"}
        assert values
        assert all(values.items() <= state.items() for state in reason["states"])
    code, out, _ = command("plan", file, "--goal", "door and key == here")
    assert code == 0
    code, out, _ = command("plan", file, "--goal", "door and key == here", "--state", "-",
                           given='{"state": {"key": "lost", "door": true, "inside": false}}')  # fmt: skip
    assert (code, "      key is lost\n" in out) == (1, True)


def test_a_reason_is_given_for_each_initial_state_that_others_do_not_hold_for(tmp_path: Path) -> None:
    document = {
        "name": "apart",
        "variables": {"place": ["left", "middle", "right"], "gate": "bool"},
        "initial": "place == left and gate or place == middle and not gate",
        "transitions": [
            {"event": "go", "controllable": True, "guard": "place == left and not gate", "set": {"place": "right"}},
            {"event": "turn", "controllable": True, "guard": "place == middle and gate", "set": {"place": "right"}},
        ],
    }
    file = tmp_path / "apart.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    code, out, _ = command("plan", file, "--goal", "place == right")
    lines = out.splitlines()
    assert code == 1
    assert sum(line.startswith("of the 2 initial states, from that with place == ") for line in lines) == 2
    assert lines.count("      gate is true") == lines.count("      gate is false") == 1


def test_that_no_plan_has_fewer_than_one_transition_is_not_said(tmp_path: Path) -> None:
    file = plain(tmp_path)
    code, out, _ = command("plan", file, "--goal", "user == has", "--contract", "fast")
    assert code == 0
    assert "fewer than 1" not in out


def asking(folder: Path, condition: str) -> Path:
    """The worked example, in which a bolt is placed only on a condition about operations."""
    copy = Path(shutil.copytree(WORKED_EXAMPLE, folder / "example"))
    (copy / "operations.yaml").write_text("place: {precondition: bolts == empty, goal: bolts == placed}\n")
    file = copy / "resources" / "operator.yaml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("enabled: bolts == empty", f"enabled: {condition} and bolts == empty"))
    return copy


def test_what_is_planned_for_is_active(tmp_path: Path) -> None:
    code, document = as_json("plan", asking(tmp_path, "operation.place.active"))
    assert (code, document["status"]) == (0, "plan")


def test_what_is_active_stays_so_while_planning(tmp_path: Path) -> None:
    code, document = as_json("plan", asking(tmp_path, "not operation.place.active"))
    assert (code, document["status"]) == (1, "none")


def test_plans_keep_to_formulas(tmp_path: Path) -> None:
    """The bolt is placed only once the robot has been above."""
    copy = asking(tmp_path, "true")
    operation = "place: {{precondition: true, goal: bolts == placed, local: {}}}\n"
    file = copy / "operations.yaml"
    file.write_text(operation.format("'bolts == empty and F (robot.pose == above and X (F robot.pose == home))'"))
    code, document = as_json("plan", copy)
    assert (code, document["status"]) == (0, "plan")
    moves = [name for name in document["starts"] if name.startswith("robot.")]
    assert moves == ["robot.move(above)", "robot.move(home)"]
    file.write_text(operation.format("G bolts == empty"))
    assert as_json("plan", copy)[1]["status"] == "none"
    file.write_text(operation.format("X false"))
    code, document = as_json("plan", copy)
    assert (code, document["status"]) == (1, "none")
    assert [each["part"] for each in document["why"]["members"]] == ["local", "goal"]
