"""Finishes that write different values to one variable."""

from __future__ import annotations

from pathlib import Path

import pytest

from checks.small import STATION, found, station
from core.replaying import replay
from sequence_planner.analysis.checks import guards
from sequence_planner.analysis.checks.rules import check_automaton
from sequence_planner.automaton.tick import finish

# Two devices that each say what they did to the one part.
DEVICE = """
measured: {on: {type: bool}}
output: {command: {type: bool}}
abilities:
  go:
    enabled: not command and not on %(enabled)s
    start: {do: [command := true]}
    executing: command and not on
    finish: {when: command and on %(finish)s, do: ["part := %(value)s"]}
    effects: {goes: {kind: executing, when: command and not on, do: [on := true]}}
  back:
    enabled: command and on and (part or not part and count == 0)
    start: {do: [command := false]}
    effects: {comes: {kind: executing, when: not command and on, do: [on := false]}}
"""


def two(value: str = "false", enabled: str = "", finish: str = "") -> dict[str, str]:
    return {
        "one": DEVICE % {"value": "true", "enabled": enabled, "finish": finish},
        "two": DEVICE % {"value": value, "enabled": enabled, "finish": finish},
    }


REACHED = (
    "two.yaml:9:20: the finishes of `one.go` and `two.go` would write different values to `part`, and then neither is "
    "applied. They meet in a reachable state: one.command == true and one.on == true and two.command == true and "
    "two.on == true. Let their finish guards exclude each other [write-conflict]"
)


def test_a_conflict_is_reported_with_a_reachable_state(tmp_path: Path) -> None:
    assert REACHED in found(station(tmp_path, two()))


def test_a_trace_leads_to_the_tick_in_which_both_finish(tmp_path: Path) -> None:
    automaton = station(tmp_path, two())
    (warning,) = [each for each in check_automaton(automaton) if each.kind == "write-conflict"]
    assert warning.trace is not None
    assert warning.trace.lines() == [
        "start 1: two.go: two.command := true",
        "start 2: one.go: one.command := true",
        "tick 3: one.on := true, two.on := true (one.go.goes, two.go.goes)",
    ]
    before, sensed = replay(automaton, warning.trace)[-2:]
    seen = {**before, "one.on": True, "two.on": True}
    assert finish(automaton, seen).conflicts == (("one.go", "two.go", "part"),)
    assert sensed["part"] == before["part"]


def test_the_same_value_is_no_conflict(tmp_path: Path) -> None:
    assert "write-conflict" not in "".join(found(station(tmp_path, two("true"))))


def test_finish_guards_that_exclude_each_other(tmp_path: Path) -> None:
    resources = two()
    resources["two"] = resources["two"].replace("when: command and on ", "when: command and on and not one.command")
    assert "write-conflict" not in "".join(found(station(tmp_path, resources)))


def test_starts_that_exclude_each_other(tmp_path: Path) -> None:
    """No values of the finish guards say so: it takes the states that can be reached."""
    free = "and not one.command and not two.command and not one.on and not two.on"
    assert "write-conflict" not in "".join(found(station(tmp_path, two(enabled=free))))


def test_a_specification_keeps_them_apart(tmp_path: Path) -> None:
    apart = "one_at_a_time: {exclusive: [one.go, two.go]}"
    executing = two(finish="and executing")
    assert "write-conflict" in "".join(found(station(tmp_path, executing)))
    (tmp_path / "second").mkdir()
    assert "write-conflict" not in "".join(found(station(tmp_path / "second", executing, specifications=apart)))


def test_too_many_states_are_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guards, "MOST_EFFORT", 10)
    said = "".join(found(station(tmp_path, two())))
    assert "They might meet (there are too many states to say whether such a one can be reached): " in said


def test_conditions_and_values_of_actions_count(tmp_path: Path) -> None:
    same = {"two": two()["two"].replace('"part := false"', '"part := one.command"'), "one": two()["one"]}
    assert "write-conflict" not in "".join(found(station(tmp_path, same)))
    (tmp_path / "second").mkdir()
    never = {"two": two()["two"].replace("part := false", "part := false if not one.on"), "one": two()["one"]}
    assert "write-conflict" not in "".join(found(station(tmp_path / "second", never, station=STATION)))
