"""`plan`: how goals would be reached."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from cli.commands import EXAMPLE, as_json, command, plain

PLACED = json.dumps({"state": {"bolts": "placed"}})


def test_the_plan_of_the_worked_example() -> None:
    """Six ticks and three starts, as the semantics says."""
    code, document = as_json("plan", EXAMPLE, "--state", "-", given=PLACED)
    assert (code, document["verdict"], document["goals"]) == (0, "found", ["tighten_bolt_pair"])
    assert [sorted(tick["starts"]) for tick in document["ticks"]] == [
        ["nutrunner.run_nut", "robot.move(above)"],
        [],
        ["robot.move(bolt_pair)"],
        [],
        [],
        [],
    ]


def test_a_plan_for_people() -> None:
    code, out, err = command("plan", EXAMPLE, "tighten_bolt_pair", "--state", "-", given=PLACED)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert {"  1  start     nutrunner.run_nut", "     start     robot.move(above)"} <= set(lines) or {
        "  1  start     robot.move(above)",
        "     start     nutrunner.run_nut",
    } <= set(lines)
    assert lines[-2] == "  6  expected  nutrunner.run_nut.torque_is_reached"
    assert lines[-1].startswith("planned in ")
    assert lines[-1].endswith(": tighten_bolt_pair")


def test_nothing_to_plan_for() -> None:
    code, _, err = command("plan", EXAMPLE)
    assert (code, err) == (2, "no operation is active in this state: name one whose goal to plan\n")


def test_no_plan() -> None:
    """With the acknowledgement unknown nobody can place a bolt."""
    given = json.dumps({"state": {"operator.acknowledged": None}})
    code, out, _ = command("plan", EXAMPLE, "tighten_bolt_pair", "--state", "-", given=given)
    assert (code, out) == (1, "no plan at all, proven: tighten_bolt_pair\n")


def test_an_operation_that_is_none() -> None:
    code, _, err = command("plan", EXAMPLE, "tighten")
    assert (code, err) == (2, "there is no operation `tighten`; did you mean `tighten_bolt_pair`?\n")


def test_a_plain_automaton(tmp_path: Path) -> None:
    file = plain(tmp_path)
    assert command("plan", file)[0::2] == (2, "no goal of it has the form `F p`\n")
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace('"marked"', '"goal": ["F (user == has)"], "marked"'), encoding="utf-8")
    code, document = as_json("plan", file)
    assert (code, document["verdict"], document["goal"]) == (0, "found", "goal_1")
    assert document["transitions"] == ["ask", "grab"]


def asking(folder: Path, condition: str) -> Path:
    """The worked example, in which a bolt is placed only on a condition about operations."""
    copy = Path(shutil.copytree(EXAMPLE, folder / "example"))
    (copy / "operations.yaml").write_text("place: {precondition: bolts == empty, goal: bolts == placed}\n")
    file = copy / "resources" / "operator.yaml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("enabled: bolts == empty", f"enabled: {condition} and bolts == empty"))
    return copy


def test_what_is_planned_for_is_active(tmp_path: Path) -> None:
    code, document = as_json("plan", asking(tmp_path, "operation.place.active"))
    assert (code, document["verdict"]) == (0, "found")


def test_that_a_run_could_change_what_is_active_is_no_proof(tmp_path: Path) -> None:
    code, document = as_json("plan", asking(tmp_path, "not operation.place.active"), "--deadline", "2")
    assert (code, document["verdict"]) == (1, "none up to")


def test_formulas_that_plans_do_not_keep_to(tmp_path: Path) -> None:
    copy = asking(tmp_path, "true")
    (copy / "operations.yaml").write_text(
        "place: {precondition: true, goal: bolts == placed, local: G bolts == empty}\n"
    )
    code, _, err = command("plan", copy)
    assert code == 2
    assert "plans do not keep to `local` formulas yet" in err
