"""A budget is spent when its time is over, when its work is done, or when it is called off, and says so in time."""

from __future__ import annotations

import threading
import time

from sequence_planner.process.budget import Budget

LONG = 60.0  # seconds, which no test takes


def work_for(seconds: float) -> None:
    """Keep a processor busy for so long."""
    until = time.process_time() + seconds
    while time.process_time() < until:
        pass


def test_waiting_is_no_work() -> None:
    budget = Budget.seconds(LONG).working(0.05)
    threading.Event().wait(0.1)
    assert not budget.spent
    work_for(0.06)
    assert budget.spent
    assert budget.remaining == 0.0


def test_there_is_no_more_work_than_there_is_time() -> None:
    assert Budget.seconds(0.0).working(LONG).spent
    assert Budget.seconds(0.5).working(LONG).remaining <= 0.5


def test_a_part_has_no_more_work_than_the_whole() -> None:
    budget = Budget.seconds(LONG).working(0.02)
    part = budget.part(0.9)
    assert part.remaining <= 0.02
    assert budget.working(LONG).remaining <= 0.02
    work_for(0.03)
    assert part.spent


def test_a_part_of_work_is_as_much_work_however_little_time_it_is_a_part_of() -> None:
    """So that who is held up by others works as much on a part as who is not."""
    part = Budget.seconds(LONG).working(0.1).part(0.5)
    threading.Event().wait(0.1)
    assert 0.03 < part.remaining <= 0.05
    work_for(0.06)
    assert part.spent


def test_what_must_be_brought_to_an_end_has_the_time_of_the_whole_however_much_it_works() -> None:
    budget = Budget.seconds(LONG)
    part = budget.working(0.01)
    end = part.by_the_clock()
    work_for(0.02)
    assert part.spent
    assert not end.spent
    assert end.until == budget.until
    budget.call_off()
    assert end.spent


def test_calling_off_ends_all_that_is_of_it() -> None:
    whole = Budget.seconds(LONG)
    parts = [whole.part(0.5), whole.working(LONG), whole.working(LONG).part(0.5)]
    interrupted = threading.Event()
    with parts[-1].interrupting(interrupted.set):
        whole.call_off()
        assert interrupted.wait(LONG)
    assert all(part.spent for part in parts)


def test_who_works_is_interrupted_when_the_work_is_done_and_not_before() -> None:
    budget = Budget.seconds(LONG).working(0.05)
    interrupted = threading.Event()
    with budget.interrupting(interrupted.set):
        assert not interrupted.wait(0.1)
        while not interrupted.is_set():
            work_for(0.01)
    assert budget.spent


def test_nobody_is_interrupted_who_is_done_before() -> None:
    interrupted = threading.Event()
    with Budget.seconds(0.05).interrupting(interrupted.set):
        pass
    assert not interrupted.wait(0.1)


def test_a_share_of_the_work_ends_by_the_clock_too_and_never_after_the_whole() -> None:
    budget = Budget.seconds(LONG).part_of_work(0.01)
    before = budget.remaining
    assert before <= 0.01 * LONG
    time.sleep(0.05)
    assert budget.remaining > before - 0.04  # this process has not worked
    assert budget.until < time.monotonic() + 0.1 * LONG
    assert Budget.seconds(LONG).working(0.5).part_of_work(0.5).remaining <= 0.25
    assert Budget.seconds(1.0).part_of_work(0.9).until <= time.monotonic() + 1.0
