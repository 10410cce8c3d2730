"""A station that has worked for a while in simulated time, and the journal of it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.execution.state import InitialState
from sequence_planner.history.simulated_station import SimulatedStation
from sequence_planner.journal.writer import RunWriter
from support.databases import journal
from support.places import BOLT_TIGHTENING
from support.simulated import ready

NOW = Timestamp(1_800_000_000.0, 500.0)


@contextmanager
def worked(seconds: float, snapshot_every: int = 50) -> Iterator[tuple[Database, Executor]]:
    """The bolt tightening station, at work for so many seconds, and the execution as it is at the end."""
    with journal() as database:
        yield database, asyncio.run(life(database, BOLT_TIGHTENING, seconds, snapshot_every))


async def life(
    database: Database,
    folder: Path,
    seconds: float,
    snapshot_every: int = 50,
    known: InitialState | None = None,
    then: Callable[[Executor], None] = lambda execution: None,
) -> Executor:
    """One life of a station: from `known` on, or from the beginning; `then` comes last."""
    station, supervisor, planner = ready(folder)
    execution = Executor(station.automaton, supervisor, known)
    writer = RunWriter(database, lambda: None)
    writer.start()
    simulated = SimulatedStation(station, execution, planner, NOW)
    digest = model_digest(station.automaton)
    RunRecorder(execution, writer.write, digest, known, lambda: simulated.now.epoch, snapshot_every)
    execution.start_production()
    simulated.run(seconds)
    then(execution)
    await writer.close()
    return execution
