"""A station in simulated time: the real execution and planner, emulated devices, and people who do what they are asked.

There is no network here: devices hear each command at once and are heard at once, unless they have a fault.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator, Mapping
from typing import Final

from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.commands.tasks import AcknowledgeTask, WaitingTask
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.types import Value
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.faults import FaultyDevices
from sequence_planner.station import ReadyStation

STEP: Final = 0.1  # seconds between two looks at the devices
TASK: Final = 1.0  # seconds that a person needs for a task of which the model does not say how long it takes
BETTER_EVERY: Final = 1.0  # seconds between two questions for a better plan
MOST_TICKS: Final = 100  # in a row without anything new; then the station is restless
_NEEDED, _BETTER = 5.0, 0.5  # seconds of work that a plan may take, one that is needed and a better one


class SimulatedStation:
    """Lets time pass for `execution`, from `now` on. Devices are where their measured variables say they are.

    People do their tasks by themselves, or where they are `people_wait` only those that somebody acknowledges.
    """

    def __init__(
        self, station: ReadyStation, execution: Executor, planner: Planner, now: Timestamp, seed: int = 0
    ) -> None:
        self.execution = execution
        self.now = now
        self.unplanned = ""  # why the planner could not answer, last
        self.people_wait = False
        self.restless = False  # abilities finish again and again, with nothing new
        self._station = station
        self._planner = planner
        self.tasks = TaskHandler(station.automaton, station.pipelines.feeds)
        emulated = EmulatedDevices(station.automaton, station.pipelines, seed=seed)
        self.devices = FaultyDevices(emulated, station.pipelines, seed)
        for name in self._fed:
            value = execution.state[name]
            if value is not None:
                self.devices.devices.set_value(name, value)
        self._command()
        self.tasks.update(execution.state, (), (), now.epoch)
        self._next_better = now.monotonic
        self._heard = {name: self.devices.heard(name) for name in self._fed}
        self._heard_at = dict.fromkeys(self._fed, now.monotonic)  # when a variable was heard of last
        self._measured: dict[str, Value | None] = {}
        self._due = True
        self._goes_on, self._in_a_row = False, 0  # the ticks of this moment

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in self.ticks(seconds):
            pass

    def ticks(self, seconds: float) -> Iterator[TickOutcome]:
        """Let time pass, and yield what each tick has done. Where nobody asks for the next, time stands still."""
        yield from self._rest_of_step()
        for _ in range(round(seconds / STEP)):
            self.now = Timestamp(round(self.now.epoch + STEP, 6), round(self.now.monotonic + STEP, 6))
            self.devices.advance(self.now.monotonic)
            self._work_on_tasks()
            self._goes_on, self._in_a_row = True, 0
            yield from self._rest_of_step()

    def _rest_of_step(self) -> Iterator[TickOutcome]:
        """Tick without time passing as long as there is something new: from where nobody asked for the next one on."""
        while self._goes_on and self._in_a_row < MOST_TICKS:
            self._in_a_row += 1
            outcome, self._goes_on = self._tick()
            if outcome is not None:
                yield outcome
        self.restless = self._goes_on
        self._goes_on = False

    def copy(self) -> SimulatedStation:
        """Return one that stands as this one does, from which time passes in the same way, or otherwise. Who listens to
        this one does not hear of it.
        """
        listening, self.execution.listeners = self.execution.listeners, []
        try:
            return copy.deepcopy(
                self, {id(each): each for each in (self._station, self._station.pipelines, self._planner)}
            )
        finally:
            self.execution.listeners = listening

    @property
    def _fed(self) -> Mapping[str, object]:
        """The variables of which devices tell."""
        return self.devices.devices.topics

    def _tick(self) -> tuple[TickOutcome | None, bool]:
        """One tick if there is something new, and whether the next may follow at once."""
        measured = self._hear() | self.tasks.measured()
        if not self._due and measured == self._measured and not self.execution.is_due(self.now):
            self._due = self._plan()
            return None, self._due
        self._measured = measured
        outcome = self.execution.tick(measured, self.now)
        self._command()
        self.tasks.update(self.execution.state, outcome.finished, outcome.ended, self.now.epoch)
        self._due = self._plan() or outcome.changed
        return outcome, self._due

    def _hear(self) -> dict[str, Value | None]:
        """What is known of what devices tell: of a silent one what it said last, until its deadline is over."""
        for name in self._fed:
            value = self.devices.heard(name)
            if value is not None:
                self._heard_at[name] = self.now.monotonic
            elif self.now.monotonic - self._heard_at[name] < self._patience(name):
                continue
            self._heard[name] = value
        return dict(self._heard)

    def _patience(self, name: str) -> float:
        """Seconds for which a variable is known without a message."""
        pipelines = self._station.pipelines
        deadlines = (pipelines.sources[topic].deadline for topic in self.devices.devices.topics[name])
        return min((each for each in deadlines if each is not None), default=math.inf)

    def _command(self) -> None:
        """Tell the devices the outputs, but for those that are away."""
        if self.execution.production is Production.STARTED:
            published, variables = self.execution.published, self._station.automaton.variables
            away = self.devices.offline_resources
            names = (
                name for name in self._station.automaton.names(Kind.OUTPUT) if variables[name].resource not in away
            )
            self.devices.devices.state |= {name: published[name] for name in names}

    def _work_on_tasks(self) -> None:
        if self.people_wait:
            return
        for task in list(self.tasks.open.values()):
            if self.now.epoch - task.created >= self._needed(task):
                self.finish_task(task)

    def finish_task(self, task: WaitingTask) -> None:
        """A person has done a task."""
        self.tasks.acknowledge(AcknowledgeTask(actor=SYSTEM, task=task.id, revision=task.revision), self.now)

    def _needed(self, task: WaitingTask) -> float:
        duration = self._station.automaton.abilities[task.ability].duration
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
