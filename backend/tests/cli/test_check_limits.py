"""`check` keeps to its deadline and its memory, whatever the model is, and says what was left."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from shutil import copytree

import pytest

from checks.large import write_large_station
from sequence_planner.analysis.worker import telling
from sequence_planner.cli.analysing import DeadlinePassed, Limits, checked, within
from sequence_planner.cli.loading import load_model
from sequence_planner.process.memory_limit import MemoryLimitError, memory_limit
from sequence_planner.process.task import WorkerError
from support.commands import as_json, command
from support.places import BOLT_TIGHTENING
from support.waiting import patience

COUNTS = """
  made: {type: 0..200}
  wanted: {type: 0..200, initial: 10}
"""
JOB = """
  job_{number}:
    enabled: pose == out and not run_{number} and made < wanted
    start: {{do: [run_{number} := true]}}
    executing: run_{number} and not done_{number} and made < wanted
    finish: {{when: run_{number} and done_{number} and made < wanted and made < 199, do: [made := made + {number}]}}
    effects:
      does: {{kind: executing, when: run_{number} and not done_{number}, do: [done_{number} := true]}}
"""


def growing() -> Iterator[int]:
    """Take ever more memory."""
    kept = []
    while True:
        kept.append(bytearray(16 << 20))
        yield len(kept)


def test_the_deadline_is_that_of_everything_and_what_is_left_is_said() -> None:
    model = load_model(BOLT_TIGHTENING)
    found = checked(model.automaton, model.connections, Limits(deadline=0.001))
    assert found.unfinished is not None
    assert found.unfinished.startswith(
        "the safe states and finishes that conflict could not be computed within 0.001 s"
    )


@pytest.mark.parametrize("of", ["check", "synthesize", "plan"])
def test_a_model_that_cannot_be_read_in_time_is_one_of_which_nothing_was_found_out(of: str, tmp_path: Path) -> None:
    """It may be usable, for all that is known."""
    station = copytree(BOLT_TIGHTENING.with_name("truck_engine_station"), tmp_path / "truck_engine_station")
    late = f"{station}: it could not be read within 0.1 s: allow more with --deadline\n"
    goal = ["ladder_frame == on_engine"] if of == "plan" else []
    assert command(of, station, *goal, "--deadline", "0.1") == (1, "", late)


def test_the_deadline_is_no_error_of_the_file_that_is_read_when_it_passes() -> None:
    with pytest.raises(DeadlinePassed), within(0.02):
        while True:
            with suppress(Exception):  # as a reader does, which names the file
                time.sleep(0.001)


def test_a_question_that_is_too_hard_ends_with_the_deadline(tmp_path: Path) -> None:
    """Counters over hundreds of values, which several finishes write: a solver would think about them for minutes."""
    station = write_large_station(tmp_path / "large", robots=6)
    for file in (station / "resources").glob("*.yaml"):
        text = file.read_text(encoding="utf-8")
        text = text.replace("  cycles: {type: 0..3}\n", f"  cycles: {{type: 0..3}}{COUNTS.rstrip()}\n")
        text = text.replace("output:\n", "  done_1: {type: bool}\n  done_2: {type: bool}\noutput:\n")
        text = text.replace(
            "  grip: {type: bool}\n", "  grip: {type: bool}\n  run_1: {type: bool}\n  run_2: {type: bool}\n"
        )
        jobs = "".join(JOB.format(number=number) for number in (1, 2)).replace("\n\n", "\n")
        file.write_text(text.rstrip("\n") + jobs, encoding="utf-8")
    model = load_model(station)
    began = time.monotonic()
    found = checked(model.automaton, model.connections, Limits(deadline=5.0))
    assert time.monotonic() - began < patience(30.0)  # killed, whatever it was at
    assert found.suspicious or found.unfinished


def test_a_process_that_takes_too_much_memory_is_ended_and_says_so() -> None:
    async def scenario() -> None:
        async with telling(0.25, growing) as words:
            async for _ in words:
                await asyncio.sleep(0.005)

    with pytest.raises(WorkerError, match=r"more than 0\.25 GB of memory: allow more with --memory"):
        asyncio.run(scenario())


def test_the_limit_is_a_setting() -> None:
    assert memory_limit({}) == 2.0
    assert memory_limit({"SEQUENCE_PLANNER_MEMORY": "0.5"}) == 0.5
    for wrong in ("much", "0", "-1", "nan"):
        with pytest.raises(MemoryLimitError, match=r"write how many GB, 0\.25 to 1024"):
            memory_limit({"SEQUENCE_PLANNER_MEMORY": wrong})
    code, _, err = command("check", BOLT_TIGHTENING, "--memory", "0")
    assert (code, "--memory" in err) == (2, True)


def test_what_is_kept_of_a_model_leaves_the_checks_to_be_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert as_json("check", BOLT_TIGHTENING) == as_json("check", BOLT_TIGHTENING)
