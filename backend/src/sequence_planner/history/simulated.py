"""A station in simulated time: the real execution and planner, emulated devices, and people who do what they are asked.

Devices hear each command at once and are heard at once: there is no network here, and no topic falls silent.
"""

from __future__ import annotations

from typing import Final

from sequence_planner.automaton.structure import Kind
from sequence_planner.control.execution import Execution
from sequence_planner.control.moment import Moment
from sequence_planner.control.tasks import Task, TaskDesk
from sequence_planner.control.vocabulary import Production
from sequence_planner.emulation.devices import EmulatedDevices
from sequence_planner.expressions.types import Value
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.station import ReadyStation

STEP: Final = 0.1  # seconds between two looks at the devices
TASK: Final = 1.0  # seconds that a person needs for a task of which the model does not say how long it takes
BETTER_EVERY: Final = 1.0  # seconds between two questions for a better plan
MOST_TICKS: Final = 100  # in a row without anything new; then the station is restless
_NEEDED, _BETTER = 5.0, 0.5  # seconds of work that a plan may take, one that is needed and a better one


class SimulatedStation:
    """Lets time pass for `execution`, from `now` on. Devices are where their measured variables say they are."""

    def __init__(
        self, station: ReadyStation, execution: Execution, planner: Planner, now: Moment, seed: int = 0
    ) -> None:
        self.execution = execution
        self.now = now
        self.unplanned = ""  # why the planner could not answer, last
        self._automaton = station.automaton
        self._planner = planner
        self._desk = TaskDesk(station.automaton, station.pipelines.feeds)
        self._devices = EmulatedDevices(station.automaton, station.pipelines, seed=seed)
        for name in self._devices.topics:
            value = execution.state[name]
            if value is not None:
                self._devices.put(name, value)
        self._command()
        self._desk.update(execution.state, (), (), now.epoch)
        self._next_better = now.monotonic
        self._measured: dict[str, Value | None] = {}
        self._due = True

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / STEP)):
            self.now = Moment(self.now.epoch + STEP, self.now.monotonic + STEP)
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
                self._desk.acknowledge(task.id, task.revision)

    def _needed(self, task: Task) -> float:
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
