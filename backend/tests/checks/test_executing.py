"""Finishes that a device can be too fast for."""

from __future__ import annotations

from pathlib import Path

from checks.small import device, found
from sequence_planner.analysis.checks.rules import check_executing
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.model.loader import load_station
from support.places import WORKED_EXAMPLE


def test_the_worked_example_warns_about_run_nut_and_about_nothing_else() -> None:
    (warning,) = check_executing(ground(load_station(WORKED_EXAMPLE)))
    assert warning.place.file.endswith("nutrunner.yaml")
    assert (warning.place.line, warning.place.column, warning.kind) == (19, 13, "relies-on-executing")
    assert warning.message == (
        "`nutrunner.run_nut` finishes only after it was seen executing, and right after its start "
        "`nutrunner.tool_is_running_forward` may not hold yet: a device that is done before a message says that it is "
        "at work is never seen to finish. Let the finish guard read the command and the result instead of `executing`"
    )


SLOW = ("executing: command and not on", "executing: command and on and not part")


def test_executing_that_only_the_device_brings_about(tmp_path: Path) -> None:
    automaton = device(tmp_path, SLOW, ("when: command and on, do", "when: executing and on, do"))
    assert [line.rpartition("[")[2] for line in found(automaton)] == ["relies-on-executing]"]


def test_executing_that_follows_from_the_start(tmp_path: Path) -> None:
    assert not any(check_executing(device(tmp_path, ("when: command and on, do", "when: executing and on, do"))))


def test_a_finish_that_has_another_way(tmp_path: Path) -> None:
    either = ("when: command and on, do", "when: on and (executing or command), do")
    assert not any(check_executing(device(tmp_path, SLOW, either)))


def test_executing_of_another_ability_is_no_matter(tmp_path: Path) -> None:
    other = ("when: command and on, do", "when: command and on and not back.executing, do")
    assert not any(check_executing(device(tmp_path, SLOW, other)))
