"""Examples in the model: carried out by `check` and in pytest, with what was expected and what came."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.testing import examples
from support.commands import command

from .station_writing import write_station

FIELDS = {"State": "float64[2] joints\nbool touched\n", "Command": "float64 speed 0.5\nstring mode\n"}

RESOURCE = """
topics:
  /state:
    type: tank_msgs/msg/State
    direction: in
    deadline: 1.0
    pipeline:
      - discretise:
          field: joints
          variable: pose
          values: {home: [0, 0], out: [1, 0.5]}
          tolerance: 0.1
          otherwise: between
      - debounce: {fields: [touched], seconds: 0.05}
    examples:
      - name: at home
        given: {joints: [0.05, 0]}
        gives: {pose: home, touched: false}
      - name: a short touch does not count
        steps:
          - {at: 0.0, given: {touched: false}, gives: {touched: false}}
          - {at: 0.02, given: {touched: true}, gives: {touched: false}}
          - {at: 0.04, given: {touched: false}, gives: {touched: false}}
          - {at: 0.10, gives: {touched: false}}
          - {at: 0.2, given: {touched: true}, gives: {touched: false}}
          - {at: 0.25, gives: {touched: true}}
      - name: silence
        steps:
          - {at: 0, given: {joints: [0, 0]}, gives: {pose: home}}
          - {at: 0.9, gives: {pose: home}}
          - {at: 1.1, gives: {pose: null}}
      - name: no numbers
        given: {joints: [.nan, 0]}
        gives: {pose: null}
  /command:
    type: tank_msgs/msg/Command
    direction: out
    pipeline: [rename: {mode: wanted}]
    examples:
      - name: what is wanted
        given: {wanted: out}
        gives: {mode: out, speed: 0.5}
flows:
  still:
    from: {state: /state}
    pipeline: [expression: {settled: state.pose == home and not state.touched}]
    examples:
      - name: at home and not touched
        given: {state: {pose: home, touched: false}}
        gives: {settled: true}
      - name: touched or not, what is not known
        given: {state: {pose: home}}
        gives: {settled: null}
measured:
  pose: {type: pose_of_tank}
  touched: {type: bool}
  settled: {type: bool}
output:
  wanted: {type: pose_of_tank}
"""
AT_HOME = "gives: {pose: home, touched: false}"
ENUMERATION = "pose_of_tank: [between, home, out]"


def test_examples_that_hold(tmp_path: Path) -> None:
    station = write_station(tmp_path, RESOURCE, FIELDS, ENUMERATION)
    made = examples(station)
    assert [str(each) for each in made] == [
        "/state: at home",
        "/state: a short touch does not count",
        "/state: silence",
        "/state: no numbers",
        "/command: what is wanted",
        "tank.still: at home and not touched",
        "tank.still: touched or not, what is not known",
    ]
    for each in made:
        each.check()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (AT_HOME, "gives: {‹pose: out}", "expected `pose` to be out, and it is home"),
        (AT_HOME, "gives: {‹pose: null}", "expected `pose` to be unknown, and it is home"),
        (AT_HOME, "gives: {‹poses: out}", "nothing named `poses` comes of it; did you mean `pose`?"),
        ("gives: {pose: null}\n  /command", "gives: {‹pose: home}\n  /command",
         "expected `pose` to be home, and it is unknown (joints is no position: [nan, 0.0])"),
        ("- {at: 0.25, gives: {touched: true}}", "- {at: 0.24, gives: {‹touched: true}}",
         " at 0.24 s: expected `touched` to be true, and it is false"),
        ("- name: at home\n        given: {joints: [0.05, 0]}", "- name: ‹at home\n        given: {joints: [0.05]}",
         "what is given does not fit: tank_msgs/msg/State joints: expected exactly 2 items, found [0.05] (list)"),
        ("- name: what is wanted\n        given: {wanted: out}",
         "- name: ‹what is wanted\n        given: {wanted: off}",
         "what is given does not fit: `wanted` ranges over {between, home, out}, and 'off' is none of it"),
        ("gives: {mode: out, speed: 0.5}", "gives: {mode: out, ‹speed: 0.25}",
         "expected `speed` to be 0.25, and it is 0.5"),
        ("gives: {settled: true}", "gives: {‹settled: false}", "expected `settled` to be false, and it is true"),
    ],
)  # fmt: skip
def test_an_example_that_fails_is_an_error_of_check_at_its_place(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in RESOURCE
    written = RESOURCE.replace(old, new)
    before = written[: written.index("‹")]
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    station = write_station(tmp_path, written.replace("‹", ""), FIELDS, ENUMERATION)
    [finding] = [finding for each in examples(station) for finding in each.of.failures()]
    assert (finding.place.line, finding.place.column) == (line, column)
    assert said in finding.message
    status, _, said_of_it = command("check", station)
    assert status == 2
    assert str(finding) in said_of_it


def test_an_example_in_pytest_says_what_came(tmp_path: Path) -> None:
    written = RESOURCE.replace("gives: {pose: home, touched: false}", "gives: {pose: out}")
    station = write_station(tmp_path, written, FIELDS, ENUMERATION)
    with pytest.raises(AssertionError, match=r"example `/state: at home`: expected `pose` to be out, and it is home"):
        examples(station)[0].check()


def test_a_function_that_cannot_be_loaded_is_an_error_of_check_at_its_stage(tmp_path: Path) -> None:
    resource = """
topics:
  /state:
    type: tank_msgs/msg/State
    direction: in
    pipeline:
      - python: {file: stages/judge.py, function: judge, reads: {touched: bool}, gives: {hot: bool}}
    examples:
      - {name: touched, given: {touched: true}, gives: {hot: false}}
measured: {hot: {type: bool}}
"""
    station = write_station(tmp_path, resource, FIELDS)
    (station / "stages").mkdir()
    program = "import surely_no_such_module\n\ndef judge(touched: bool) -> dict[str, object]:\n"
    program += "    return {'hot': not touched}\n"
    (station / "stages" / "judge.py").write_text(program, encoding="utf-8")
    status, _, said = command("check", station)
    assert status == 2
    assert said.count("\n") == 1
    assert "tank.yaml:7:9: stages/judge.py judge" in said
    assert "surely_no_such_module" in said
    (station / "stages" / "judge.py").write_text(program.partition("\n\n")[2], encoding="utf-8")
    for example in examples(station):
        example.check()
