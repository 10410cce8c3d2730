"""Conditions that never hold, always hold, or are never brought about."""

from __future__ import annotations

from pathlib import Path

import pytest

from checks.small import device, found, station


def test_nothing_is_said_of_a_station_that_is_as_it_should_be(tmp_path: Path) -> None:
    assert found(device(tmp_path)) == []


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "enabled: not command and not on",
            "enabled: not command and command == on and on",
            "6:14: `not device.command and device.command == device.on and device.on` never holds, so the ability "
            "never starts: write what was meant [never-holds]",
        ),
        (
            "when: command and on, do",
            "when: command and on and not command, do",
            "9:20: `device.command` and `not device.command` exclude each other, so the ability never finishes: "
            "write what was meant [never-holds]",
        ),
        (
            "when: command and not on, do",
            "when: command and not on and on, do",
            "10:15: `not device.on` and `device.on` exclude each other, so the effect never happens: "
            "write what was meant [never-holds]",
        ),
        (
            "executing: command and not on",
            "executing: on or not on",
            "8:16: `device.on or not device.on` always holds, whatever the values of its variables: leave it out, "
            "or write what was meant [always-holds]",
        ),
        (
            "enabled: not command and not on",
            "enabled: not command and not on and count > 1",
            "6:14: nothing ever makes `count > 1` true, neither an action nor a message, so the ability never starts: "
            "write what was meant, or the action that is missing [unreachable]",
        ),
        (
            "{kind: executing, when: command and not on, do: [on := true]}",
            "{kind: executing, when: command and on, do: [on := true]}",
            "10:15: nothing ever makes `device.on` true, so this effect never happens: no output and no other effect "
            "leads to it [effect-never-happens]",
        ),
        (
            "effects: {goes: {kind: executing, when: command and not on, do: [on := true]}}",
            "",
            "9:20: no effect brings about `device.on`, so the ability never finishes in any plan: write the effect "
            "with which the device does it [nothing-brings-about]",
        ),
    ],
    ids=range(7),
)
def test_a_condition_that_is_none(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert f"device.yaml:{said}" in found(device(tmp_path, (old, new)))


def test_what_only_follows_from_another_finding_is_not_said(tmp_path: Path) -> None:
    """Nobody can go, so nobody can come back; only the first is said."""
    said = found(device(tmp_path, ("enabled: not command and not on", "enabled: not on and count > 1")))
    assert [line.rpartition("[")[2] for line in said] == ["unreachable]"]


def test_what_an_ability_that_is_switched_off_would_bring_about_is_not_said(tmp_path: Path) -> None:
    assert found(device(tmp_path, ("enabled: not command and not on", "enabled: false"))) == []


def test_abilities_that_wait_for_each_other(tmp_path: Path) -> None:
    text = """
estimated: {a: {type: bool}, b: {type: bool}}
abilities:
  one: {enabled: b, start: {do: [a := true]}}
  two: {enabled: a, start: {do: [b := true]}}
"""
    said = found(station(tmp_path, {"r": text}))
    assert [line[:29] for line in said] == ["r.yaml:4:18: nothing ever mak", "r.yaml:5:18: nothing ever mak"]


def test_a_finish_guard_sees_flags_of_the_tick_before(tmp_path: Path) -> None:
    """`executing` excludes `on`, but not in the tick in which the device reports it."""
    assert found(device(tmp_path, ("when: command and on, do", "when: executing and on, do"))) == []


def test_operations(tmp_path: Path) -> None:
    operations = """
do_it: {precondition: not part, goal: part and count == 3}
never: {precondition: part and not part, goal: part}
"""
    assert found(device(tmp_path, operations=operations)) == [
        "operations.yaml:2:1: nothing ever makes `count == 3` true, neither an action nor a message, so the operation "
        "is never completed: write what was meant, or the action that is missing [unreachable]",
        "operations.yaml:3:1: `part` and `not part` exclude each other, so the operation never becomes active: "
        "write what was meant [never-holds]",
    ]


MOVES = """
measured: {at: {type: place, initial: left}}
output: {target: {type: side, initial: left}}
abilities:
  move:
    parameters: {source: side, to: side}
    enabled: at == source and at != to and target == at %s
    start: {do: [target := to]}
    executing: target == to and at != to
    effects: {moves: {kind: executing, when: target != at, do: [at := target]}}
"""


def test_an_instance_with_one_argument_twice_may_be_impossible(tmp_path: Path) -> None:
    """From left to left: that two of four never start is no news."""
    assert found(station(tmp_path, {"arm": MOVES % ""})) == []


def test_all_instances_are_reported_under_one_name(tmp_path: Path) -> None:
    assert found(station(tmp_path, {"arm": MOVES % "and at == between"})) == [
        "arm.yaml:7:14: for all source in side, to in side where source != to: `arm.at == source` and "
        "`arm.at == between` exclude each other, so the ability never starts: write what was meant [never-holds]"
    ]


NAMED = """
name: s
enumerations: {stage: [one, two, three, four]}
estimated: {done: {type: stage}, seen: {for: {at: stage}, type: bool}}
predicates:
  is_over: done == two or done == three
  is_known: seen[one] and done == one
  all_seen: "all at in stage: seen[at]"
  is_hidden: {parameters: {at: stage}, when: "not seen[at] and done != at"}
"""


def test_what_is_wrong_is_told_by_the_names_of_the_model(tmp_path: Path) -> None:
    """Of all instances once, of each of which that is so; and of a name for several only what lacks."""
    text = """
abilities:
  mark:
    parameters: {which: stage}
    enabled: is_hidden(which) and seen[which]
    start: {do: [done := which]}
  end:
    enabled: is_over and done == one
    start: {do: [done := one]}
"""
    operations = """
finish: {precondition: done == one, goal: all_seen}
look: {precondition: done == one, goal: is_known}
"""
    automaton = station(tmp_path, {"a": text}, station=NAMED, operations=operations)
    nothing = (
        "neither an action nor a message, so the operation is never completed: write what was meant, or the action"
    )
    assert found(automaton) == [
        f"operations.yaml:2:1: nothing ever makes `all_seen` true, {nothing} that is missing [unreachable]",
        f"operations.yaml:3:1: nothing ever makes `seen[one]` true, {nothing} that is missing [unreachable]",
        "a.yaml:5:14: for all which in stage: `not seen[which]` and `seen[which]` exclude each other, so the ability "
        "never starts: write what was meant [never-holds]",
        "a.yaml:8:14: `is_over` and `done == one` exclude each other, so the ability never starts: write what was "
        "meant [never-holds]",
    ]


def test_instances_of_which_not_the_same_is_said_are_not_told_as_if(tmp_path: Path) -> None:
    """Each contradicts something else: of the first is told what is so of it."""
    text = """
measured: {at: {type: place, initial: left}}
abilities:
  mark:
    parameters: {which: side}
    enabled: at == which and (which == left implies at == right) and (which == right implies at == between)
    start: {do: [part := true]}
"""
    assert found(station(tmp_path, {"a": text})) == [
        "a.yaml:6:14: `a.at == left` and `a.at == right` exclude each other, so the ability never starts: write what "
        "was meant [never-holds]"
    ]


def test_one_instance_among_many_is_named(tmp_path: Path) -> None:
    text = """
measured: {seen: {type: bool}}
estimated: {done: {type: stage}}
abilities:
  mark:
    parameters: {which: stage}
    enabled: seen and done == which and done in {one, two}
    start: {do: [done := which]}
    effects: {sees: {kind: starting, when: not seen, do: [seen := true]}}
"""
    automaton = station(tmp_path, {"a": text}, station="name: s\nenumerations: {stage: [one, two, three]}")
    assert found(automaton) == [
        "a.yaml:7:14: of `a.mark(three).enabled`: `a.done == three` and `a.done in {one, two}` exclude each other, so "
        "the ability never starts: write what was meant [never-holds]",
        "a.yaml:7:14: of `a.mark(two).enabled`: nothing ever makes `a.done == two` true, neither an action nor a "
        "message, so the ability never starts: write what was meant, or the action that is missing [unreachable]",
    ]
