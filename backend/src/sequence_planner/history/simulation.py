"""A branch of a run: how the station would have gone on from a past record, with emulated devices.

The execution and the planner are the real ones. Devices stand where they were measured, and do what the model expects
of them; people do each task that they are given. Nothing of it reaches the station or its journal.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.history.simulated_station import SimulatedStation
from sequence_planner.history.state_at import looking_back
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.language.types import Value, contains
from sequence_planner.planning.planner import Planner
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import message

_SLICE: Final = 1.0  # seconds simulated between two looks at the time that is left


@dataclass(frozen=True)
class Branch:
    """The records that there would have been, from number 1 on, and the execution at the end.

    `seconds` is the time that was simulated, less than was asked for if that would have taken too long.
    """

    records: tuple[RunRecord, ...]
    execution: Executor
    seconds: float


def branch(
    run: WholeRun,
    station: ReadyStation,
    supervisor: Supervisor,
    number: int,
    seconds: float,
    corrections: Mapping[str, Value],
    deadline: float,
) -> Branch:
    """Simulate so many seconds from a record on, after corrections of estimates. It works until about `deadline`
    seconds have passed. Raises `HistoryError`.
    """
    until = time.monotonic() + deadline
    _check(station.automaton, corrections)
    past = looking_back(run, station.automaton, supervisor, number)
    execution, records = past.execution, list[RunRecord]()

    def write(kind: str, epoch: float, content: str) -> int:
        records.append(RunRecord(len(records) + 1, epoch, kind, content, ""))
        return len(records)

    planner = Planner(station.automaton, supervisor)
    simulated = SimulatedStation(station, execution, planner, past.now)
    RunRecorder(execution, write, model_digest(station.automaton), clock=lambda: simulated.now.epoch)
    if corrections:
        execution.correct(corrections, "branch", "what would have been", past.now)
    done = 0.0
    while done < seconds and time.monotonic() < until:
        step = min(_SLICE, seconds - done)
        simulated.run(step)
        done += step
    return Branch(tuple(records), execution, done)


def _check(automaton: Automaton, corrections: Mapping[str, Value]) -> None:
    """Raises `HistoryError` for what is no correction of an estimate."""
    for name, value in corrections.items():
        variable = automaton.variables.get(name)
        if variable is None or variable.kind is not Kind.ESTIMATED:
            raise HistoryError("not-estimated", message("refused.not-estimated.name", name=name))
        if not contains(variable.type, value):
            raise HistoryError(
                "not-in-domain",
                message("refused.not-in-domain.of", value=str(value), name=name, range=str(variable.type)),
            )
