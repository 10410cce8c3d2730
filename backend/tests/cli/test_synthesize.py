"""`synthesize`: counts, guards and findings of a model."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from sequence_planner.cli.loading import usable_automaton
from support.commands import as_json, command, plain
from support.places import BOLT_TIGHTENING, WORKED_EXAMPLE

UNMEETABLE: dict[str, Any] = {
    "name": "heater",
    "variables": {"on": "bool", "hot": "bool"},
    "initial": "on and not hot",
    "transitions": [
        {"event": "heats", "controllable": False, "guard": "on", "set": {"hot": True}},
        {"event": "off", "controllable": True, "guard": "on", "set": {"on": False}},
    ],
    "forbidden": ["hot"],
}


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def test_the_worked_example() -> None:
    code, out, err = command("synthesize", WORKED_EXAMPLE)
    assert (code, err) == (0, "")
    assert out.splitlines() == [
        "Worked example: 180 states can be reached, 148 of them with the supervisor",
        "  operator.place_bolt",
        "    robot.pose != bolt_pair and robot.target_pose != bolt_pair",
        "    because of no_standing_tool_on_placed_bolts",
        "  robot.move(bolt_pair)",
        "    not operator.task and (bolts != placed or nutrunner.run_nut.executing)",
        "    because of no_standing_tool_on_placed_bolts",
    ]


def test_what_differs_in_a_parameter_only_is_told_once() -> None:
    _, out, _ = command("synthesize", BOLT_TIGHTENING)
    assert out.splitlines()[1:] == [
        "  operator.place_bolt_pair(pair), for all pair in bolt_pair",
        "    robot.pose != pair and robot.target_pose != pair",
        "    because of no_standing_tool_on_placed_bolts(pair)",
        "  robot.move_to_position(position), for all position in bolt_pair",
        "    operator.requested_pair != position and (bolts[position] != placed or nutrunner.run_nut.executing)",
        "    because of no_standing_tool_on_placed_bolts(position)",
    ]
    _, document = as_json("synthesize", BOLT_TIGHTENING)
    first, second = document["lifted"]
    assert first == {
        "name": "operator.place_bolt_pair(pair)",
        "index": "all pair in bolt_pair",
        "starts": [f"operator.place_bolt_pair(bolt_pair_{number})" for number in (1, 2, 3)],
        "guard": "robot.pose != pair and robot.target_pose != pair",
        "blocked": [],
        "specifications": ["no_standing_tool_on_placed_bolts(pair)"],
        "rest": False,
    }
    assert second["index"] == "all position in bolt_pair"


def test_expanded_each_is_told_by_itself() -> None:
    _, out, _ = command("synthesize", BOLT_TIGHTENING, "--expanded")
    lines = out.splitlines()
    for number in (1, 2, 3):
        at = lines.index(f"  operator.place_bolt_pair(bolt_pair_{number})")
        assert lines[at + 1] == f"    robot.pose != bolt_pair_{number} and robot.target_pose != bolt_pair_{number}"
        assert lines[at + 2] == f"    because of no_standing_tool_on_placed_bolts(bolt_pair_{number})"
    assert len(lines) == 1 + 3 * 6


def parity(folder: Path) -> Path:
    """An even number of seven buttons has to be pressed when it is done."""
    buttons = [f"b{number}" for number in range(7)]
    odd = buttons[0]
    for button in buttons[1:]:
        odd = f"({odd}) != {button}"
    press = [
        {"event": f"press_{each}", "controllable": True, "guard": "not done", "set": {each: f"not {each}"}}
        for each in buttons
    ]
    document = {
        "name": "even",
        "variables": dict.fromkeys([*buttons, "done"], "bool"),
        "initial": " and ".join(f"not {each}" for each in [*buttons, "done"]),
        "transitions": [*press, {"event": "end", "controllable": True, "guard": "not done", "set": {"done": True}}],
        "forbidden": [f"done and ({odd})"],
    }
    file = folder / "even.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    return file


def test_where_no_short_condition_says_when_it_is_said_where_not(tmp_path: Path) -> None:
    model = parity(tmp_path)
    code, out, _ = command("synthesize", model)
    first, guard, no, *cases, why = out.splitlines()
    assert (code, guard, why) == (0, "  end", "    because of forbidden_1")
    assert first == "even: 256 states can be reached, 192 of them with the supervisor"
    assert no == "    no short condition says when; not, among others, where"
    assert len(cases) == 3
    assert all(each.startswith("      ") and each.count("not ") == 6 for each in cases)
    _, document = as_json("synthesize", model)
    assert document["guards"]["end"] is None
    assert document["origins"]["end"]["blocked"] == [each.strip() for each in cases]
    _, out, _ = command("show", model, "end")
    shown = [line.strip() for line in out.splitlines()]
    at = shown.index(f"supervisor  {no.strip()}")
    assert shown[at + 1 : at + 4] == [each.strip() for each in cases]


def test_for_programs() -> None:
    """Every ability has a guard; what is kept from the first time says the same."""
    first = as_json("synthesize", WORKED_EXAMPLE)
    assert first == as_json("synthesize", WORKED_EXAMPLE)
    code, document = first
    assert code == 0
    assert (document["reachable_states"], document["supervised_states"]) == (180, 148)
    assert document["guards"] == {
        "engine.next_engine": "true",
        "nutrunner.run_nut": "true",
        "operator.place_bolt": "robot.pose != bolt_pair and robot.target_pose != bolt_pair",
        "robot.move(home)": "true",
        "robot.move(above)": "true",
        "robot.move(bolt_pair)": "not operator.task and (bolts != placed or nutrunner.run_nut.executing)",
    }
    assert document["origins"]["robot.move(bolt_pair)"] == {
        "guard": "not operator.task and (bolts != placed or nutrunner.run_nut.executing)",
        "literals": 3,
        "starts": ["robot.move(bolt_pair)"],
        "specifications": ["no_standing_tool_on_placed_bolts"],
        "rest": False,
        "blocked": [],
    }
    assert (document["findings"], document["unfinished"]) == ([], None)


def test_the_bolt_tightening_station() -> None:
    _, document = as_json("synthesize", BOLT_TIGHTENING)
    restricted = {name: guard for name, guard in document["guards"].items() if guard != "true"}
    expected = {}
    for pair in ("bolt_pair_1", "bolt_pair_2", "bolt_pair_3"):
        expected[f"operator.place_bolt_pair({pair})"] = f"robot.pose != {pair} and robot.target_pose != {pair}"
        expected[f"robot.move_to_position({pair})"] = (
            f"operator.requested_pair != {pair} and (bolts[{pair}] != placed or nutrunner.run_nut.executing)"
        )
    assert restricted == expected


def test_a_plain_automaton(tmp_path: Path) -> None:
    code, document = as_json("synthesize", plain(tmp_path))
    assert (code, document["reachable_states"], document["supervised_states"]) == (0, 3, 3)
    assert document["guards"] == {"grab": "true", "drop": "true"}


def test_what_cannot_be_met_is_told_with_a_run(tmp_path: Path) -> None:
    file = tmp_path / "heater.efa.json"
    file.write_text(json.dumps(UNMEETABLE), encoding="utf-8")
    code, document = as_json("synthesize", file)
    assert (code, document["reachable_states"], document["supervised_states"], document["guards"]) == (1, 4, None, None)
    [finding] = document["findings"]
    assert finding["kind"] == "specification-cannot-be-met"
    assert "forbidden_1" in finding["message"]
    assert "`heats`" in finding["message"]
    assert [step["names"] for step in finding["trace"]["steps"]] == [["heats"]]
    assert finding["trace"]["steps"][0]["changes"] == {"hot": True}
    assert finding["trace"]["steps"][0]["forbidden_by"] == ["forbidden_1"]
    code, out, _ = command("synthesize", file)
    assert code == 1
    assert out.splitlines()[0] == "heater: there is no supervisor"
    assert "step 1: heats: hot := true, which forbidden_1 forbids" in out


def test_what_takes_too_long_is_said() -> None:
    whole = BOLT_TIGHTENING.with_name("truck_engine_station")  # its safe states alone take seconds
    usable_automaton(whole)  # which is kept: to read it anew takes longer than they may
    late = "the safe states could not be computed within 0.6 s: allow more with --deadline"
    code, document = as_json("synthesize", whole, "--deadline", "0.6")
    assert (code, document["reachable_states"], document["guards"]) == (1, None, None)
    assert document["unfinished"] == late
    code, out, _ = command("synthesize", whole, "--deadline", "0.6")
    assert (code, out.splitlines()[-1]) == (1, late)
    assert as_json("synthesize", whole, "--deadline", "0.7")[0] == 1  # nothing unfinished was kept


def test_a_model_that_is_none(tmp_path: Path) -> None:
    code, out, err = command("synthesize", tmp_path / "missing.efa.json")
    assert (code, out) == (2, "")
    assert "missing.efa.json" in err


def test_transitions_of_one_event_that_differ_have_guards_of_their_own(tmp_path: Path) -> None:
    """One that changes nothing, too: to forbid the event would be to forbid it."""
    file = tmp_path / "overlap.efa.json"
    transitions = [
        {"event": "go", "controllable": True, "guard": "x < 3", "set": {"x": "x + 1"}},
        {"event": "go", "controllable": True, "set": {}},
        {"event": "go", "controllable": True, "guard": "x == 2", "set": {"x": 0}},
        {"event": "stay", "controllable": True, "set": {}},
    ]
    document = {"name": "overlap", "variables": {"x": {"min": 0, "max": 3}}, "initial": "x == 0"}
    file.write_text(json.dumps({**document, "transitions": transitions, "forbidden": ["x == 3"]}), encoding="utf-8")
    _, found = as_json("synthesize", file)
    assert found["guards"] == {"go#1": "x != 2", "go#2": "true", "go#3": "true", "stay": "true"}
    assert found["origins"]["go#1"]["starts"] == ["go"]


def test_copying_many_values_at_once_is_no_matter_of_their_combinations(tmp_path: Path) -> None:
    """A table of twelve slots that is turned: 4¹² combinations of values."""
    slots = [f"slot{number}" for number in range(12)]
    turned = {slot: before for before, slot in zip(slots, [*slots[1:], slots[0]], strict=True)}
    document = {
        "name": "table",
        "variables": {slot: ["empty", "raw", "done", "bad"] for slot in slots},
        "initial": " and ".join(f"{slot} == {'raw' if slot == 'slot0' else 'empty'}" for slot in slots),
        "transitions": [
            {"event": "turn", "controllable": True, "set": turned},
            {"event": "works", "controllable": False, "guard": "slot6 == raw", "set": {"slot6": "done"}},
        ],
        "forbidden": ["slot0 == raw and slot6 == done"],
    }
    file = tmp_path / "table.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    code, found = as_json("synthesize", file)
    assert (code, found["reachable_states"], found["supervised_states"]) == (0, 24, 24)


def test_a_model_that_is_too_much_does_not_hold_up_other_commands(tmp_path: Path) -> None:
    counters = [f"n{number}" for number in range(6)]
    document = {
        "name": "sum",
        "variables": {name: {"min": 0, "max": 99} for name in counters},
        "initial": " and ".join(f"{name} == 0" for name in counters),
        "transitions": [{"event": f"up_{n}", "controllable": True, "set": {n: f"{n} + 1"}} for n in counters],
        "forbidden": [f"{' + '.join(counters)} > 200"],
        "goal": ["F (n0 == 1)"],
    }
    file = tmp_path / "sum.efa.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    code, _, err = command("plan", file, "--deadline", "1")
    assert code == 1
    late = "the safe states could not be computed within 1 s"
    assert err == f"{late}: allow more with --deadline, or let fewer variables bear on them\n"
    code, out, err = command("show", file, "up_n0", "--deadline", "1")
    assert (code, "controllable up_n0" in out) == (1, True)
    assert "could not be computed within 1 s: allow more with --deadline" in err
