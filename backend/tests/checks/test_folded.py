"""Conditions that relations, maps, quantifiers and orders make true or false are told, though they are constants."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.analysis.folded_conditions import check_folded
from sequence_planner.station import prepare_station
from support.commands import as_json

STATION = """
name: press
enumerations:
  height: {ordered: true, values: [down, middle, up]}
  side: [left, right]
  piece: [cup, lid]
  die: [die_a, die_b]
estimated: {holds: {for: {where: side}, type: bool}}
relations: {fits: {between: [piece, die], pairs: [[cup, die_a], [lid, die_b]]}}
maps: {code_of: {from: die, to: 0..9, values: {die_a: 3, die_b: 5}}}
"""
PRESS = """
measured: {at: {type: height}, mounted: {type: die}}
output: {wanted: {type: height}}
abilities:
  lower:
    parameters: {what: piece}
    enabled: >-
      at == up and
      ENABLED
    start: {do: [wanted := down]}
    until: at == down
"""


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("fits(cup, die_b)", "never"),
        ("fits(cup, die_a)", "always"),
        ("code_of[die_a] == 4", "never"),
        ("code_of[mounted] == 4", "never"),
        ("code_of[mounted] >= 3", "always"),
        ("any p in piece: fits(p, mounted)", "always"),
        ("all s in side: holds[s] or not holds[s]", "always"),
        ("next(at) == down", "never"),
        ("(count s in side: holds[s]) > 2", "never"),
        ("any s in side where s == left and s == right: holds[s]", "never"),
        ("at least 2 s in side where s != left: holds[s]", "never"),
    ],
)
def test_what_is_decided_by_what_was_declared_is_told(tmp_path: Path, condition: str, holds: str) -> None:
    advice = "leave it out, or write" if holds == "always" else "write"
    assert said(tmp_path, condition) == [
        f"resources/press.yaml:8:7: warning: `{condition}` {holds} holds, whatever the values of its variables: "
        f"{advice} what was meant [{holds}-holds]"
    ]


@pytest.mark.parametrize(
    "condition",
    [
        "fits(what, mounted)",
        "fits(what, die_b)",  # of one piece it is so, of the other it is not
        "code_of[mounted] == 5",
        "code_of[mounted] > 3",
        "previous(at) == middle",
        "exactly 1 s in side: holds[s]",
        "mounted == die_a",
    ],
)
def test_what_depends_on_the_state_or_on_a_parameter_is_not(tmp_path: Path, condition: str) -> None:
    assert said(tmp_path, condition) == []


def test_a_whole_condition_is_told_once_and_as_it_is_written(tmp_path: Path) -> None:
    write(tmp_path, PRESS.replace("at == up and\n", "").replace("ENABLED", "code_of[mounted] >= 3"))
    _, document = as_json("check", tmp_path)
    [message] = [each["message"] for each in document["findings"] if each["kind"] == "always-holds"]
    assert message.startswith("`code_of[mounted] >= 3` always holds, whatever")


def said(folder: Path, condition: str) -> list[str]:
    write(folder, PRESS.replace("ENABLED", condition))
    written = prepare_station(folder).written
    assert written is not None
    return [str(each).removeprefix(f"{folder}/") for each in check_folded(written)]


def write(folder: Path, press: str) -> None:
    (folder / "resources").mkdir()
    (folder / "station.yaml").write_text(STATION, encoding="utf-8")
    (folder / "resources" / "press.yaml").write_text(press.strip(), encoding="utf-8")
