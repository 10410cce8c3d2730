"""Effects under one condition that contradict each other, and those that do not."""

from __future__ import annotations

from pathlib import Path

from checking.small import device, found

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
