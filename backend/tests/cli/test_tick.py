"""`tick`: the reference interpreter, step by step, from one command to the next."""

from __future__ import annotations

import json
from pathlib import Path

from support.commands import as_json, command, plain
from support.places import WORKED_EXAMPLE

ABOVE = "robot.move(above)"


def test_what_each_step_did() -> None:
    code, out, err = command("tick", WORKED_EXAMPLE, "--set", "operator.acknowledged := true", "--start", ABOVE)
    assert (code, err) == (0, "")
    assert out.splitlines() == [
        "1 sense        operator.acknowledged := true",
        "2 finish       none",
        "3 synchronise  operator.place_bolt.enabled := false",
        "4 operations   no change",
        "5 start",
        f"               {ABOVE}: robot.target_pose := above, {ABOVE}.enabled := false, {ABOVE}.executing := true",
        "6 act          robot.target_pose := above",
    ]


def test_a_start_that_waits_says_for_what() -> None:
    code, out, _ = command("tick", WORKED_EXAMPLE, "--start", "engine.next_engine")
    assert code == 1
    assert "engine.next_engine: waits, as `bolts == tightened` is false" in out


def test_a_start_that_the_supervisor_forbids() -> None:
    state = {"bolts": "placed", "robot.pose": "above", "robot.target_pose": "above"}
    given = json.dumps({"state": state})  # flags follow
    code, document = as_json("tick", WORKED_EXAMPLE, "--state", "-", "--start", "robot.move(bolt_pair)", given=given)
    assert code == 1
    assert document["starts"][0]["waits_for"] == [
        "specification no_standing_tool_on_placed_bolts forbids the state after it"
    ]


def test_ticks_are_piped_into_each_other() -> None:
    """A bolt is placed, and with it the operation becomes active."""
    place, said = "operator.place_bolt", "operator.place_bolt.operator_acknowledges"
    _, first = as_json("tick", WORKED_EXAMPLE, "--start", place)
    assert first["published"] == {"operator.task": True}
    code, second = as_json("tick", WORKED_EXAMPLE, "--state", "-", "--effect", said, given=json.dumps(first))
    assert code == 0
    assert second["finished"] == {
        "abilities": [place],
        "conflicts": [],
        "changes": {"operator.task": False, "bolts": "placed"},
    }
    assert second["operations"]["activated"] == ["tighten_bolt_pair"]
    assert second["active"] == ["tighten_bolt_pair"]
    third = as_json(
        "tick", WORKED_EXAMPLE, "--state", "-", given=json.dumps({**second, "state": {"bolts": "tightened"}})
    )[1]
    assert third["operations"]["completed"] == ["tighten_bolt_pair"]


def test_a_variable_that_is_unknown() -> None:
    code, document = as_json("tick", WORKED_EXAMPLE, "--unknown", "robot.pose", "--start", ABOVE)
    assert code == 1
    assert document["state"]["robot.pose"] is None
    assert document["starts"][0]["waits_for"][0] == "`robot.target_pose == robot.pose` is unknown"


def test_what_cannot_be() -> None:
    for arguments, said in (
        (("--set", "robot.target_pose := home"), "messages set measured variables, and `robot.target_pose` is output"),
        (("--set", "robot.pose := hom"), "unknown variable or value `hom`; did you mean `home`?"),
        (("--start", "robot.move(abov)"), "there is no ability `robot.move(abov)`; did you mean `robot.move(above)`?"),
        (("--effect", "robot.leaves"), "there is no effect `robot.leaves`"),
        (("--effect", "robot.move(home).robot_arrives"), "is not enabled: `robot.target_pose != robot.pose` is false"),
        (("--state", "missing.json"), "missing.json holds no state"),
    ):
        code, out, err = command("tick", WORKED_EXAMPLE, *arguments)
        assert (code, out) == (2, "")
        assert said in err
    for given, said in (
        ("[]", '- holds no state: expected {"state": {variable: value}, "active": [operation]}'),
        ('{"state": {"bolt": "empty"}}', "there is no variable `bolt`; did you mean `bolts`?"),
        ('{"state": {"bolts": 1}}', "`1` is no value of `bolts`, which ranges over {empty, placed, tightened}"),
    ):
        code, out, err = command("tick", WORKED_EXAMPLE, "--state", "-", given=given)
        assert (code, out) == (2, "")
        assert said in err


def test_a_transition_of_a_plain_automaton(tmp_path: Path) -> None:
    file = plain(tmp_path)
    assert command("tick", file, "--start", "ask") == (0, "ask: user := waits\n", "")
    code, document = as_json("tick", file, "--start", "grab")
    assert (code, document["transition"]) == (1, None)
    assert document["waits_for"] == ["`user == waits` is false"]
    asked = as_json("tick", file, "--start", "ask")[1]
    code, document = as_json("tick", file, "--state", "-", "--start", "grab", given=json.dumps(asked))
    assert (code, document["changes"]) == (0, {"user": "has", "free": False})
    assert command("tick", file, "--start", "grb")[2] == "there is no event `grb`; did you mean `grab`?\n"


def test_the_supervisor_holds_back_events_of_plain_automata(tmp_path: Path) -> None:
    file = tmp_path / "step.efa.json"
    file.write_text(
        '{"name": "step", "variables": {"x": {"min": 0, "max": 2}}, "initial": "x == 1", "forbidden": ["x == 2"],'
        ' "transitions": [{"event": "go", "controllable": true, "set": {"x": "x + 1"}}]}',
        encoding="utf-8",
    )
    code, out, _ = command("tick", file, "--start", "go")
    assert code == 1
    assert out == (
        "go waits: it leads out of the safe states, and the supervisor forbids that (--unsupervised takes it)\n"
    )
    assert command("tick", file, "--start", "go", "--unsupervised")[:2] == (0, "go: x := 2\n")
