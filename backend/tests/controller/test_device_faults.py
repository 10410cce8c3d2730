"""A sample of the faults of `campaigns/kills.py`: devices fall silent, stand still, lie, go away and start again."""

from __future__ import annotations

import random

import pytest

from controller.faulty import KINDS, after
from sequence_planner.simulation.faults import FaultKind


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_with_a_fault_that_passes_leaves_a_station_that_works(kind: FaultKind) -> None:
    [(what, number)] = after(random.Random(f"sample.{kind}"), kind, "robot", 4, passes=True).items()
    assert what.startswith(kind)
    assert number == 1
