"""Starts on a live station: judged by what they bring about, formulas of operations included."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pytest

from controller.test_ticks import EVERYTHING_IS_SAFE, NOW
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.execution.executor import Executor
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.planning.planner import Planner
from support.automata import Does, automaton

# What `a` needs is seen only at the position after a start, and so is what it forbids.
EXCLUSIVE = automaton(
    {
        "a": Does(
            start=("x := true",),
            enabled="not x and not done_a",
            finish="x and ready",
            finally_=("x := false", "done_a := true"),
        ),
        "b": Does(start=("y := true",), enabled="not y"),
    },
    measured={"ready": (BOOLEAN, False)},
    output={"x": (BOOLEAN, False), "y": (BOOLEAN, False)},
    estimated={"done_a": (BOOLEAN, False)},
    effects={"gets_ready": ("x and not ready", ("ready := true",))},
    goals={"g": "done_a and y"},
    local={"g": "G not (x and y)"},
)
TOGETHER = automaton(
    {
        "a": Does(start=("x := true",), enabled="not x and not y"),
        "b": Does(start=("y := true",), enabled="x and not y", finish="y and x", finally_=("x := false",)),
    },
    output={"x": (BOOLEAN, False), "y": (BOOLEAN, False)},
    measured={"ready": (BOOLEAN, False)},
    goals={"g": "y and not x"},
    local={"g": "F (x and y)"},
)
FIRST_OPEN = automaton(
    {
        "c": Does(start=("z := true",), enabled="ready and not z"),
        "b": Does(start=("y := true",), enabled="not y"),
    },
    measured={"ready": (BOOLEAN, False), "warm": (BOOLEAN, False)},
    output={"y": (BOOLEAN, False), "z": (BOOLEAN, False)},
    effects={"gets_ready": ("not ready and warm", ("ready := true",)), "warms_up": ("not warm", ("warm := true",))},
    goals={"g": "y"},
    local={"g": "F z"},
)
Measured = Mapping[str, bool]


def lived(station: Automaton, measured: Sequence[Measured]) -> tuple[list[tuple[str, ...]], Executor]:
    """What starts in each tick of a station that follows its plan, and the station afterwards."""
    execution, planner = Executor(station, EVERYTHING_IS_SAFE), Planner(station, EVERYTHING_IS_SAFE)
    execution.start_production()
    execution.tick(measured[0], NOW)
    started: list[tuple[str, ...]] = []
    for each in measured:
        if (request := execution.request(20)) is not None:
            execution.adopt(request, planner.answer(request))
        started.append(execution.tick(each, NOW).started)
    return started, execution


@pytest.mark.parametrize(
    ("station", "measured"),
    [
        (EXCLUSIVE, [{"ready": False}, {"ready": True}, {"ready": True}, {"ready": True}]),
        (TOGETHER, [{"ready": False}] * 4),
        (
            FIRST_OPEN,
            [
                {"ready": False, "warm": False},
                {"ready": False, "warm": True},
                *([{"ready": True, "warm": True}] * 3),
            ],
        ),
    ],
)
def test_no_start_violates_the_formula_that_its_plan_keeps_to(station: Automaton, measured: Sequence[Measured]) -> None:
    """Nor does the station stand still for fear of it."""
    started, execution = lived(station, measured)
    assert not execution.pursued.violated
    assert not execution.active, f"the goal is reached: {started}"


def test_an_ability_starts_once_in_a_tick() -> None:
    """Else the first of its commands would never be published."""
    station = automaton(
        {"step": Does(start=("n := n + 1",), enabled="n < 3")},
        output={"n": (IntegerRange(0, 3), 0)},
        goals={"g": "n == 2"},
    )
    started, execution = lived(station, [{}] * 4)
    assert [each for each in started if each] == [("step",), ("step",)]
    assert not execution.active
