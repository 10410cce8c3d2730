"""Synthesis happens elsewhere, piece by piece, and whoever no longer wants it need not wait."""

from __future__ import annotations

import asyncio
import time
from itertools import pairwise

import pytest

from sequence_planner.analysis.analysis import Analysis
from sequence_planner.analysis.finding import analyses
from sequence_planner.analysis.worker import analysing
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.language.types import BOOLEAN
from sequence_planner.process.task import WorkerError
from support.automata import automaton
from support.cell import cell
from support.simulated import truck_engine
from support.waiting import until_async


def processes() -> list[Child]:
    return [child for child in children() if child.name == "synthesis"]


async def all_of(station: Automaton) -> list[Analysis]:
    async with analysing(station) as finding:
        return [found async for found in finding]


def test_it_is_that_of_the_synthesis_and_grows() -> None:
    station, supervisor = cell()
    found = asyncio.run(all_of(station.automaton))
    assert found == list(analyses(station.automaton))
    assert found[-1].supervisor == supervisor
    assert found[-1].pending is None
    for before, after in pairwise(found):
        assert before.pending is not None
        for name in ("supervisor", "guarded", "guards", "warnings", "reachable_states", "supervised_states"):
            assert getattr(before, name) in (None, getattr(after, name))


def test_that_there_is_no_supervisor_is_said_with_a_run() -> None:
    impossible = automaton({}, measured={"hot": (BOOLEAN, True)}, forbidden={"never_hot": "hot"})
    found = asyncio.run(all_of(impossible))[-1]
    assert (found.supervisor, found.guards, found.reachable_states) == (None, None, 1)
    assert found.warnings is not None
    [warning] = found.warnings
    assert (warning.kind, "never_hot" in warning.message) == ("specification-cannot-be-met", True)
    assert warning.trace is not None
    assert warning.trace.steps == ()


def test_whoever_no_longer_wants_it_does_not_wait() -> None:
    async def scenario() -> float:
        computing = asyncio.create_task(all_of(truck_engine()[0].automaton))
        await asyncio.sleep(0.3)
        began = time.monotonic()
        computing.cancel()
        await asyncio.wait({computing})
        return time.monotonic() - began

    assert asyncio.run(scenario()) < 0.5
    assert not processes()


def test_a_process_that_is_killed_is_not_waited_for() -> None:
    async def scenario() -> None:
        computing = asyncio.create_task(all_of(truck_engine()[0].automaton))
        await until_async(lambda: bool(processes()))
        processes()[0].kill()
        with pytest.raises(WorkerError, match="has ended without an answer"):
            await computing

    asyncio.run(scenario())
