"""Samples of `campaigns/kills.py`: controllers that are killed at moments drawn by seed, and devices with faults."""

from __future__ import annotations

import pytest

from running import forked, killing


def test_a_controller_that_is_killed_again_and_again_loses_nothing_and_does_nothing_twice() -> None:
    seen = forked.apart("sample", 6)
    assert seen["controllers killed after work"] > 1
    assert seen["commands heard by devices"] > 0
    assert seen["starts"] >= 2


@pytest.mark.parametrize("seed", ["sample"])
def test_so_does_one_of_real_processes_and_its_work_goes_on(seed: str) -> None:
    seen = killing.lives(seed, 2)
    assert seen[f"controllers killed {killing.AT_WORK}"] + seen[f"controllers killed {killing.AT_ONCE}"] == 2
    assert seen["commands heard by devices"] > 0
