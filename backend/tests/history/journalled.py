"""A station that has worked for a while in simulated time, and the journal of it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from control.journalling import journal
from control.rig import TRUCK_ENGINE, ready
from sequence_planner.control.conduct import Beginning
from sequence_planner.control.execution import Execution
from sequence_planner.control.moment import Moment
from sequence_planner.history.model_digest import model_digest
from sequence_planner.history.recorder import RunRecorder
from sequence_planner.history.simulated import SimulatedStation
from sequence_planner.journal.run_writer import RunWriter
from sequence_planner.storage.database import Database

NOW = Moment(1_800_000_000.0, 500.0)


@contextmanager
def worked(seconds: float, snapshot_every: int = 50) -> Iterator[tuple[Database, Execution]]:
    """The bolt tightening station, at work for so many seconds, and the execution as it is at the end."""
    with journal() as database:
        yield database, asyncio.run(life(database, TRUCK_ENGINE, seconds, snapshot_every))


async def life(
    database: Database,
    folder: Path,
    seconds: float,
    snapshot_every: int = 50,
    known: Beginning | None = None,
    then: Callable[[Execution], None] = lambda execution: None,
) -> Execution:
    """One life of a station: from `known` on, or from the beginning; `then` comes last."""
    station, supervisor, planner = ready(folder)
    execution = Execution(station.automaton, supervisor, known)
    writer = RunWriter(database, lambda: None)
    writer.begin()
    simulated = SimulatedStation(station, execution, planner, NOW)
    digest = model_digest(station.automaton)
    RunRecorder(execution, writer.write, digest, known, lambda: simulated.now.epoch, snapshot_every)
    execution.start_production()
    simulated.run(seconds)
    then(execution)
    await writer.close()
    return execution
