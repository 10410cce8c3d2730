"""Simulation from a past record: a branch of the run with the real planner and emulated devices."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.commands.tasks import AcknowledgeTask, WaitingTask
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.execution.vocabulary import Production
from sequence_planner.history.state_at import looking_back
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.language.types import Value, contains
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.station import ReadyStation

# A station in simulated time: the real execution and planner, emulated devices, and people who do what they are asked.
#
# Devices hear each command at once and are heard at once: there is no network here, and no topic falls silent.

STEP: Final = 0.1  # seconds between two looks at the devices
TASK: Final = 1.0  # seconds that a person needs for a task of which the model does not say how long it takes
BETTER_EVERY: Final = 1.0  # seconds between two questions for a better plan
MOST_TICKS: Final = 100  # in a row without anything new; then the station is restless
_NEEDED, _BETTER = 5.0, 0.5  # seconds of work that a plan may take, one that is needed and a better one


class SimulatedStation:
    """Lets time pass for `execution`, from `now` on. Devices are where their measured variables say they are."""

    def __init__(
        self, station: ReadyStation, execution: Executor, planner: Planner, now: Timestamp, seed: int = 0
    ) -> None:
        self.execution = execution
        self.now = now
        self.unplanned = ""  # why the planner could not answer, last
        self._automaton = station.automaton
        self._planner = planner
        self._desk = TaskHandler(station.automaton, station.pipelines.feeds)
        self._devices = EmulatedDevices(station.automaton, station.pipelines, seed=seed)
        for name in self._devices.topics:
            value = execution.state[name]
            if value is not None:
                self._devices.set_value(name, value)
        self._command()
        self._desk.update(execution.state, (), (), now.epoch)
        self._next_better = now.monotonic
        self._measured: dict[str, Value | None] = {}
        self._due = True

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / STEP)):
            self.now = Timestamp(self.now.epoch + STEP, self.now.monotonic + STEP)
            self._devices.advance(self.now.monotonic)
            self._work_on_tasks()
            for _ in range(MOST_TICKS):
                if not self._tick():
                    break

    def _tick(self) -> bool:
        """One tick if there is something new; whether the next may follow at once."""
        measured = {name: self._devices.state[name] for name in self._devices.topics} | self._desk.measured()
        if not self._due and measured == self._measured and not self.execution.is_due(self.now):
            self._due = self._plan()
            return self._due
        self._measured = measured
        outcome = self.execution.tick(measured, self.now)
        self._command()
        self._desk.update(self.execution.state, outcome.finished, outcome.ended, self.now.epoch)
        self._due = self._plan() or outcome.changed
        return self._due

    def _command(self) -> None:
        if self.execution.production is Production.STARTED:
            published = self.execution.published
            self._devices.state |= {name: published[name] for name in self._automaton.names(Kind.OUTPUT)}

    def _work_on_tasks(self) -> None:
        for task in list(self._desk.open.values()):
            if self.now.epoch - task.created >= self._needed(task):
                done = AcknowledgeTask(actor=SYSTEM, task=task.id, revision=task.revision)
                self._desk.acknowledge(done, self.now)

    def _needed(self, task: WaitingTask) -> float:
        duration = self._automaton.abilities[task.ability].duration
        return TASK if duration is None else duration[1]

    def _plan(self) -> bool:
        """Ask for a plan if one is needed, and now and then for a better one; whether there was an answer."""
        request = self.execution.request(_NEEDED)
        if request is None and self.now.monotonic >= self._next_better:
            self._next_better = self.now.monotonic + BETTER_EVERY
            request = self.execution.better(_BETTER)
        if request is None:
            return False
        try:
            self.execution.adopt(request, self._planner.answer(request))
        except PlannerError as error:
            self.unplanned = str(error)
            self.execution.unanswered(self.unplanned, again=False)
        return True


# A branch from the past: how the station would have gone on from a record, with emulated devices.
#
# The execution and the planner are the real ones. Devices stand where they were measured, and do what the model expects
# of them; people do each task that they are given. Nothing of it reaches the station or its journal.

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
            raise HistoryError("not-estimated", f"there is no estimated variable {name}: only these can be corrected")
        if not contains(variable.type, value):
            raise HistoryError(
                "not-in-domain", f"the value {value!r} is none of {name}, which ranges over {variable.type}"
            )
