"""How long operations take and what they use is told by the run journal, from wherever the server begins to read."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from journal.happened import happened
from sequence_planner.db.database import Database
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.mes.scheduling import problem
from sequence_planner.mes.scheduling.problem import UNKNOWN_SECONDS, KnownTimes

RESOURCES = {"robot.fetch": "robot", "robot.place": "robot", "press.close": "press"}
GOAL = frozenset({"table"})


def ticks(*told: tuple[float, dict[str, list[str]]]) -> list[RunRecord]:
    return [RunRecord(number, time, "ticked", json.dumps(what), "") for number, (time, what) in enumerate(told, 1)]


def known() -> KnownTimes:
    return KnownTimes(RESOURCES)


def test_before_the_first_run_it_is_what_is_planned_and_what_the_goal_depends_on() -> None:
    times = known()
    assert times.seconds("assemble") == UNKNOWN_SECONDS
    assert times.seconds("assemble", 12.0) == 12.0
    assert times.resources("assemble", GOAL) == GOAL


def test_it_is_the_median_of_the_last_runs_and_all_that_they_used() -> None:
    times = known()
    begin = 100.0
    for number, seconds in enumerate([500.0, 500.0, 1.0, 2.0, 3.0, 4.0, 5.0]):
        ability = "press.close" if number == 3 else "robot.fetch"
        ends: dict[str, list[str]] = {"completed": ["assemble"]}
        times.add_records(ticks((begin, {"activated": ["assemble"], "started": [ability]}), (begin + seconds, ends)))
        begin += 1000
    assert times.seconds("assemble", 12.0) == 3.0
    assert times.resources("assemble", GOAL) == {"robot", "press"}


def test_one_that_is_completed_and_active_again_in_one_tick_is_two_runs() -> None:
    times = known()
    again = {"completed": ["assemble"], "activated": ["assemble"], "started": ["press.close"]}
    times.add_records(ticks((1.0, {"activated": ["assemble"]}), (5.0, again), (7.0, {"completed": ["assemble"]})))
    assert times.seconds("assemble") == 3.0
    assert times.resources("assemble", GOAL) == {"press"}, "a run in which nothing started says nothing"


def test_a_run_during_which_the_controller_was_started_anew_does_not_count() -> None:
    times = known()
    times.add_records(ticks((1.0, {"activated": ["assemble"]})))
    times.add_records([RunRecord(2, 5000.0, "begun", "{}", "")])
    times.add_records(ticks((5001.0, {"completed": ["assemble"]})))
    assert times.seconds("assemble", 12.0) == 12.0


def test_a_clock_that_was_set_back_leaves_no_negative_time() -> None:
    times = known()
    times.add_records(ticks((100.0, {"activated": ["assemble"]}), (50.0, {"completed": ["assemble"]})))
    assert times.seconds("assemble", 12.0) == 12.0


def test_a_clock_that_was_set_forward_leaves_no_time_that_cannot_be_worked_with() -> None:
    times = known()
    times.add_records(ticks((100.0, {"activated": ["assemble"]}), (1.8e9, {"completed": ["assemble"]})))
    assert times.seconds("assemble", 12.0) == 12.0


def test_of_what_happened_while_nobody_asked_only_the_last_is_read(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(problem, "_LOOK_BACK", 4)
    times, heard = known(), list[int]()
    monkeypatch.setattr(times, "add_records", lambda page: heard.extend(each.number for each in page))
    for numbers in (range(1, 3), range(3, 20)):
        happened(database, numbers)
        with database.reading() as connection:
            times.read_on(connection)
    assert heard == [1, 2, 16, 17, 18, 19]


def test_what_is_started_beside_counts_for_all_that_are_active() -> None:
    times = known()
    both: Callable[[str], dict[str, list[str]]] = lambda kind: {kind: ["one", "two"]}  # noqa: E731
    times.add_records(ticks((1.0, both("activated")), (2.0, {"started": ["robot.place"]}), (3.0, both("completed"))))
    assert times.resources("one", GOAL) == times.resources("two", GOAL) == {"robot"}
