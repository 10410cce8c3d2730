"""Sequences that leave an operation no moment to become active: told where it stands in one, with what it waits for."""

from __future__ import annotations

from pathlib import Path

import pytest

from checks.small import device, found
from sequence_planner.analysis.checks.supervised import check_supervision
from sequence_planner.synthesis.supervisor import supervised

WRITTEN = "write what was meant"
OPERATIONS = """\
make: {precondition: not part, goal: part}
take: {precondition: part, goal: not part}
stop: {precondition: device.on, goal: not device.on}
both: {precondition: part, goal: device.on and count == 2}
look: {precondition: true, goal: device.command}
feel: {precondition: true, goal: count == 1}
"""


@pytest.mark.parametrize(
    ("sequence", "said"),
    [
        ("s: {sequence: [make, stop]}", []),
        (
            "s: {sequence: [take, ‹take_again]}\ntake_again: {precondition: part, goal: device.on}",
            [
                "`part` and `not part` exclude each other, so `take_again` never becomes active in the "
                f"sequence `s`, behind `take`: {WRITTEN} [never-holds]"
            ],
        ),
        (
            "s: {alternative: [look, ‹feel]}",
            [
                "`not (operation.look.active or device.command or not device.command)` never holds, so `feel` "
                f"never becomes active in the sequence `s`, beside `look`: {WRITTEN} [never-holds]"
            ],
        ),
    ],
)
def test_what_contradicts_a_precondition(tmp_path: Path, sequence: str, said: list[str]) -> None:
    text = OPERATIONS + sequence
    place = ""
    if "‹" in text:
        above = text[: text.index("‹")].split("\n")
        place = f"operations.yaml:{len(above)}:{len(above[-1]) + 1}: "
    here = [each for each in found(device(tmp_path, operations=text.replace("‹", ""))) if "sequence" in each]
    assert here == [f"{place}{each}" for each in said]


def test_a_long_condition_is_quoted_with_its_first_words(tmp_path: Path) -> None:
    """Its place has all of it, and a line that nobody reads to the end says nothing."""
    covering = " or ".join(f"count == {number} and device.on and part == device.command" for number in range(4))
    operations = f"""\
make: {{precondition: true, goal: {covering}}}
look: {{precondition: true, goal: device.command}}
s: {{alternative: [make, look]}}
"""
    (said,) = (each for each in found(device(tmp_path, operations=operations)) if "sequence" in each)
    begins = "operations.yaml:3:25: `not (operation.make.active or count == 0 and device.on and part"
    assert said.startswith(begins)
    assert said.endswith(
        f" …` never holds, so `look` never becomes active in the sequence `s`, beside `make`: {WRITTEN} [never-holds]"
    )
    assert len(said) < 320


def test_what_can_never_be_reached_together(tmp_path: Path) -> None:
    """The part is taken before the device goes back: it is never there while the command is withdrawn."""
    operations = """\
hold: {precondition: true, goal: part}
rest: {precondition: not device.command and device.on, goal: not device.on}
s: {sequence: [hold, rest]}
"""
    automaton = device(tmp_path, operations=operations)
    (warning,) = (each for each in check_supervision(automaton, supervised(automaton)) if each.kind == "never-active")
    assert (warning.place.line, warning.place.column) == (3, 22)
    assert warning.message == (
        "`rest` never becomes active in the sequence `s`, behind `hold`: `not device.command and device.on and part` "
        "holds in no state that can be reached, with or without the supervisor. Write what was meant, or the action or "
        "effect that is missing"
    )
