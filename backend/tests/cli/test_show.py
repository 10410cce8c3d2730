"""`show`: the ground automaton."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree

import pytest

from editor.shorthand import SHORTHAND
from sequence_planner.analysis.store import key, read
from sequence_planner.cli.analysing import Found
from sequence_planner.cli.loading import load_model
from support.commands import as_json, command, plain
from support.places import BOLT_TIGHTENING, CELL, MODELS, WORKED_EXAMPLE


def test_one_ability_and_its_effects() -> None:
    code, out, _ = command("show", WORKED_EXAMPLE, "operator.place_bolt", "bolts")
    assert code == 0
    assert (
        out
        == """\
Operator with watch (operator)

  ability operator.place_bolt: place bolt
    enabled     bolts == empty and not operator.task and not operator.acknowledged
    supervisor  robot.pose != bolt_pair and robot.target_pose != bolt_pair
                (because of no_standing_tool_on_placed_bolts)
    start       operator.task := true
    executing   operator.task and not operator.acknowledged
    finish      operator.place_bolt.executing and operator.acknowledged
    finish      operator.task := false
    finish      bolts := placed
    effect operator.place_bolt.operator_acknowledges (executing, 0.5 s)
      when        operator.task and not operator.acknowledged
      do          operator.acknowledged := true
    effect operator.place_bolt.operator_is_free (finishing, 0.5 s)
      when        not operator.task and operator.acknowledged
      do          operator.acknowledged := false

The station
  estimated  bolts: {empty, placed, tightened}, initially empty
"""
    )


def test_all_of_it() -> None:
    code, out, _ = command("show", BOLT_TIGHTENING)
    assert code == 0
    for part in (
        "Bolt tightening station (bolt_tightening)",
        "  ability robot.move_to_previous: Move to the previous pose, for restart mode only",
        "operation tighten_bolt_pair(bolt_pair_2): Tighten bolt pair 2, priority 1",
        "specification no_standing_tool_on_placed_bolts(bolt_pair_1): "
        "The nutrunner must turn before it meets placed bolts",
        "    finish within 30 s",
    ):
        assert part in out.splitlines()


def test_all_instances_of_a_name() -> None:
    _, document = as_json("show", BOLT_TIGHTENING, "robot.move_to_position")
    assert len(document["abilities"]) == 5
    assert document["variables"] == {}


def test_an_effect_that_several_abilities_share_is_shown_once_with_any_of_them() -> None:
    shared = "robot.move_to_position(home).robot_arrives"
    for names, count in (
        (["robot.move_to_position(bolt_pair_1)"], 1),
        (["robot.move_to_position(bolt_pair_1)", "robot.move_to_position(bolt_pair_2)"], 1),
        (["robot.move_to_position"], 1),
        ([shared], 1),
        ([], 1),
        (["robot.move_to_previous"], 0),
    ):
        code, out, _ = command("show", BOLT_TIGHTENING, *names)
        assert code == 0
        assert sum(line.startswith(f"    effect {shared} (") for line in out.splitlines()) == count, names
    _, document = as_json("show", BOLT_TIGHTENING, "robot.move_to_position(bolt_pair_1)")
    assert shared in document["effects"]


def test_phases_with_what_they_read_and_write() -> None:
    _, document = as_json("show", WORKED_EXAMPLE)
    assert set(document["phases"]) == {"sense", "finish", "start"}
    (start,) = [each for each in document["phases"]["start"] if each["name"] == "engine.next_engine.start"]
    assert start == {"name": "engine.next_engine.start", "reads": ["bolts"], "writes": ["bolts"]}
    assert document["variables"]["robot.pose"]["domain"] == ["home", "above", "bolt_pair", "unknown"]


def test_a_name_that_nothing_has() -> None:
    said = f"{WORKED_EXAMPLE}: there is nothing called `robot.mov`; did you mean `robot.pose`?\n"
    assert command("show", WORKED_EXAMPLE, "robot.mov")[:2] == (2, "")
    assert command("show", WORKED_EXAMPLE, "robot.pos") == (2, "", said.replace("robot.mov", "robot.pos"))


def test_a_plain_automaton(tmp_path: Path) -> None:
    code, out, _ = command("show", plain(tmp_path), "ask", "grab")
    assert code == 0
    assert (
        out
        == """\
controllable grab
    guard       user == waits and free
    set         user := has
    set         free := false

uncontrollable ask
    guard       user == idle
    set         user := waits
"""
    )


def test_the_guard_of_one_ability_is_the_same_as_among_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    _, alone, _ = command("show", BOLT_TIGHTENING, "operator.place_bolt_pair(bolt_pair_1)")
    assert read(key(load_model(BOLT_TIGHTENING).automaton), Found) is None  # nothing else was found out for it
    _, everything, _ = command("show", BOLT_TIGHTENING)
    lines = [line for line in alone.splitlines() if "supervisor" in line or "because" in line]
    assert len(lines) == 2
    assert set(lines) <= set(everything.splitlines())


def test_where_time_is_short_it_says_so(tmp_path: Path) -> None:
    station = copytree(BOLT_TIGHTENING.with_name("truck_engine_station"), tmp_path / "truck_engine_station")
    code, out, err = command("show", station, "robot.move_to_position(HomeJOINTPose)", "--deadline", "0.1")
    late = "the safe states could not be computed within 0.1 s: allow more with --deadline\n"
    assert (code, "ability robot.move_to_position" in out) == (1, True)
    assert err == f"the guards of the supervisor are not shown: {late}"


def test_pipelines_are_shown_with_the_types_on_their_edges() -> None:
    code, out, _ = command("show", CELL, "--pipelines", "/arm/state")
    place = CELL / "resources" / "arm.yaml"
    assert code == 0
    assert out.splitlines() == [
        "/arm/state  incoming, arm: cell_msgs/msg/ArmState",
        "  edge  joints: real[2], moving: bool",
        f"  1 discretise  joints → pose  ({place}:8)",
        "  new   pose: {unknown, home, out}",
        f"  2 remember  pose → last  ({place}:16)",
        "  new   last: {home, out}",
        "  writes  arm.pose: {unknown, home, out} from pose",
        "  writes  arm.last: {home, out} from last",
        "  writes  arm.moving: bool from moving",
    ]
    code, found = as_json("show", CELL, "--pipelines", "arm")
    assert (code, set(found["pipelines"])) == (0, {"/arm/state", "/arm/command"})
    assert found["pipelines"]["/arm/command"]["sources"] == {"goto": "arm.goto"}
    code, _, err = command("show", CELL, "--pipelines", "/arm/stat")
    assert (code, "did you mean `/arm/state`?" in err) == (2, True)


NAMES = """\
values free: home, out

values part: p1, p2, p3, in this order

relation fits
  big with placed, tight

map grip_for
  p1 to small
  p2 to big
  p3 to small

predicate all_tight
  when        all p in part: bolts[p] == tight
  that is     bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight

predicate arm.is_at(q)
  for         q: home, left, right, out
  when        at == q and target == q

sequence both: Fasten and go
  sequence
    parallel for p in ends
      fasten(p)
    go
"""


@pytest.fixture
def press(tmp_path: Path) -> Path:
    """A station that says much for short, and has a sequence."""
    operations = """\
fasten: {parameters: {p: part}, precondition: not is_done(p), goal: is_done(p)}
go: {precondition: all_tight, goal: arm.is_at(out)}
both: {title: Fasten and go, sequence: [{for: {p: ends}, parallel: fasten(p)}, go]}
"""
    for file, text in {**SHORTHAND, "operations.yaml": operations}.items():
        (tmp_path / file).parent.mkdir(exist_ok=True)
        (tmp_path / file).write_text(text, encoding="utf-8")
    return tmp_path


def test_names_for_what_is_said_more_than_once(press: Path) -> None:
    code, out, _ = command("show", press, "part", "free", "fits", "grip_for", "all_tight", "arm.is_at", "both")
    assert (code, sorted(out.split("\n\n"))) == (0, sorted(NAMES.split("\n\n")))


def test_conditions_are_told_by_their_names(press: Path) -> None:
    """What the model has a name for, with `--expanded` what it stands for; programs have that."""
    _, out, _ = command("show", press, "go", "arm.move(home)", "--deadline", "60")
    assert "  precondition  all_tight" in out.splitlines()
    assert "  goal          arm.is_at(out)" in out.splitlines()
    (enabled,) = [line for line in out.splitlines() if "enabled" in line]
    assert enabled.split(maxsplit=1)[1] == "arm.at == out and not arm.is_at(home) and not arm.is_at(left)"
    _, out, _ = command("show", press, "go", "--expanded")
    written = "bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight"
    assert f"  precondition  {written}" in out.splitlines()
    assert "  goal          arm.at == out and arm.target == out" in out.splitlines()
    _, shown = as_json("show", press, "go")
    assert shown["operations"]["go"]["precondition"] == written


def test_what_the_supervisor_adds_is_told_by_names_too() -> None:
    """And specifications that are instances of one are named together."""
    truck = MODELS / "truck_engine_station"
    _, out, _ = command("show", truck, "nutrunner.run_nut")
    lines = [line.strip() for line in out.splitlines()]
    at = lines.index("supervisor  not robot.pose in bolt_pair and not robot.target_pose in bolt_pair")
    assert lines[at + 1] == "(because of no_turning_without_loose_bolts(pair) for all pair in bolt_pair)"
    _, out, _ = command("show", truck, "nutrunner.run_nut", "--expanded")
    (line,) = [line for line in out.splitlines() if "(because of" in line]
    assert line.count("no_turning_without_loose_bolts(AtBoltPair") == 6


def test_names_for_programs(press: Path) -> None:
    _, shown = as_json("show", press, "all_tight", "free", "both", "is_heavy")
    assert shown["predicates"] == {
        "all_tight": {
            "parameters": {},
            "when": "all p in part: bolts[p] == tight",
            "means": "bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight",
        }
    }
    assert shown["values"] == {"free": {"values": ["home", "out"], "ordered": False}}
    assert shown["maps"] == {"is_heavy": {"bare": False, "big": True, "small": False}}
    assert shown["sequences"]["both"]["sequence"][0] == {"for": {"p": "ends"}, "parallel": "fasten(p)"}
    assert (shown["relations"], shown["types"]) == ({}, {})


def test_a_type_with_its_instances() -> None:
    _, out, _ = command("show", MODELS / "robots_with_buffer", "robot")
    assert out == (
        "type robot\n  namespace: text\n  stops: enumeration\n  conveyor: value of stops\n"
        "  instances   robot_1, robot_2\n"
    )
