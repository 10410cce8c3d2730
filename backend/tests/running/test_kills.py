"""Samples of `campaigns/kills.py`: controllers that are killed at moments drawn by seed while their devices go on."""

from __future__ import annotations

from running import forked, killing, ordered


def test_a_controller_that_is_killed_again_and_again_loses_nothing_and_does_nothing_twice() -> None:
    seen = forked.apart("sample", 4)
    assert seen["controllers killed after work"] > 1
    assert seen["commands heard by devices"] > 0
    assert seen["starts"] >= 2


def test_a_job_is_worked_to_its_end_through_kills_and_nothing_of_it_is_completed_twice() -> None:
    seen = forked.apart("ordered", 4, "running.ordered")
    assert len(seen) == ordered.JOBS * 7
    assert set(seen.values()) == {1}


def test_so_does_one_of_real_processes_and_its_work_goes_on() -> None:
    seen = killing.lives("sample", 1)
    assert seen[f"controllers killed {killing.AT_WORK}"] + seen[f"controllers killed {killing.AT_ONCE}"] == 1
    assert seen["commands heard by devices"] > 0
