"""Effects under one condition that contradict each other, and those that do not."""

from __future__ import annotations

from pathlib import Path

import pytest

from checks.small import DEVICE, device, found, station

GOES = "goes: {kind: executing, when: command and not on, do: [on := true]}"
STAYS = "stays: {kind: executing, when: not on and command, do: [on := false]}"


def test_two_outcomes_of_one_condition(tmp_path: Path) -> None:
    (said,) = found(device(tmp_path, (GOES, f"{GOES}, {STAYS}")))
    assert said.startswith(
        "device.yaml:10:84: `device.go.goes` and `device.go.stays` happen under the same condition and write different "
        "values to `device.on`: a plan counts on whichever suits it."
    )
    assert said.endswith("[contradictory-effects]")


def test_a_fault_is_not_counted_on(tmp_path: Path) -> None:
    fault = STAYS.replace("kind: executing", "kind: executing, fault: true")
    assert found(device(tmp_path, (GOES, f"{GOES}, {fault}"))) == []


def test_conditions_that_exclude_each_other_and_values_that_agree(tmp_path: Path) -> None:
    also = "also: {kind: executing, when: command and not on, do: [on := true]}"
    assert found(device(tmp_path, (GOES, f"{GOES}, {also}"))) == []


@pytest.mark.parametrize(
    "condition", ["not (on or not command)", "command == true and on == false", "on != command and command"]
)
def test_one_condition_in_other_words(tmp_path: Path, condition: str) -> None:
    stays = STAYS.replace("not on and command", f"{condition}")
    (said,) = found(device(tmp_path, (GOES, f"{GOES}, {stays}")))
    assert "`device.go.goes` and `device.go.stays` happen under the same condition" in said


def test_other_conditions_on_the_same_variables(tmp_path: Path) -> None:
    falls = STAYS.replace("not on and command", "on and command")
    assert not [each for each in found(device(tmp_path, (GOES, f"{GOES}, {falls}"))) if "contradictory" in each]


def test_it_does_not_matter_in_whose_file_they_stand(tmp_path: Path) -> None:
    other = """
abilities:
  push:
    enabled: not device.command
    start: {do: [part := true]}
    effects: {pushes: {kind: executing, when: not device.on and device.command, do: [device.on := false]}}
"""
    said = found(station(tmp_path, {"device": DEVICE, "other": other}))
    assert [each for each in said if "`device.go.goes` and `other.push.pushes` happen under the same condition" in each]
