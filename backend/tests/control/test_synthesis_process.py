"""The supervisor is computed elsewhere, and whoever no longer wants it need not wait."""

from __future__ import annotations

import asyncio
import multiprocessing
import time
from multiprocessing.process import BaseProcess

import pytest

from control.bench import cell, until
from control.rig import truck_engine
from core.building import automaton
from sequence_planner.control.synthesis_process import synthesised
from sequence_planner.expressions.types import BOOLEAN
from sequence_planner.synthesis.supervision import SynthesisError


def processes() -> list[BaseProcess]:
    return [child for child in multiprocessing.active_children() if child.name == "synthesis"]


def test_it_is_that_of_the_synthesis() -> None:
    station, supervisor = cell()
    found = asyncio.run(synthesised(station.automaton))
    assert found == supervisor


def test_that_there_is_none_is_said() -> None:
    impossible = automaton({}, measured={"hot": (BOOLEAN, True)}, forbidden={"never_hot": "hot"})
    with pytest.raises(SynthesisError, match="never_hot"):
        asyncio.run(synthesised(impossible))


def test_whoever_no_longer_wants_it_does_not_wait() -> None:
    async def scenario() -> float:
        computing = asyncio.create_task(synthesised(truck_engine()[0].automaton))
        await asyncio.sleep(0.3)
        began = time.monotonic()
        computing.cancel()
        await asyncio.wait({computing})
        return time.monotonic() - began

    assert asyncio.run(scenario()) < 0.5
    assert not processes()


def test_a_process_that_is_killed_is_not_waited_for() -> None:
    async def scenario() -> None:
        computing = asyncio.create_task(synthesised(truck_engine()[0].automaton))
        await until(lambda: bool(processes()))
        processes()[0].kill()
        with pytest.raises(RuntimeError, match="has ended without an answer"):
            await computing

    asyncio.run(scenario())
