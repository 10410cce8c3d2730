"""A station in simulated time: the real execution, planner, pipelines and emulated devices, without a network.

Messages are handed over as records. Nothing here decides anything that the product decides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.tasks import AcknowledgeTask, WaitingTask
from sequence_planner.controller.features.tasks import TaskHandler
from sequence_planner.controller.planner_client import BETTER_EVERY
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.language.evaluator import holds
from sequence_planner.language.types import Value
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import PlanRequest
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.places import BOLT_TIGHTENING

PAIRS = ("bolt_pair_1", "bolt_pair_2", "bolt_pair_3")


@cache
def ready(folder: Path) -> tuple[ReadyStation, Supervisor, Planner]:
    """The station in `folder` with its supervisor and a warm planner."""
    station = prepare_station(folder)
    supervisor = synthesise(station.automaton)
    return station, supervisor, Planner(station.automaton, supervisor)


def truck_engine() -> tuple[ReadyStation, Supervisor, Planner]:
    """The truck engine station."""
    return ready(BOLT_TIGHTENING)


Acknowledging = Callable[[WaitingTask, float], bool]


def at_once(task: WaitingTask, now: float) -> bool:
    """An operator who needs a second for everything."""
    return now - task.created > 1.0


def never(task: WaitingTask, now: float) -> bool:
    """An operator who is not there."""
    return False


@dataclass
class Rig:
    """The station, its devices and an operator; `now` is in seconds."""

    acknowledges: Acknowledging = at_once
    seed: int = 0
    step: float = 0.1
    now: float = 1000.0
    thinking: int = 0  # ticks that pass until the planner answers
    patience: float = 20.0  # seconds within which it has to
    improves: bool = True  # whether better plans are asked for
    folder: Path = BOLT_TIGHTENING
    silent: set[str] = field(default_factory=set)  # topics from which nothing comes
    started: list[str] = field(default_factory=list)
    completed: list[str] = field(default_factory=list)
    ticks: list[TickOutcome] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._asked: tuple[PlanRequest, int] | None = None
        self._next_better = self.now
        self.station, supervisor, self.planner = ready(self.folder)
        self.execution = Executor(self.station.automaton, supervisor)
        self.desk = TaskHandler(self.station.automaton)
        self.devices = EmulatedDevices(self.station.automaton, self.station.pipelines, seed=self.seed)
        self.pipelines = RunningPipelines(self.station.pipelines)

    def start_production(self) -> None:
        self.execution.start_production()
        self._publish(self.station.automaton.outputs)

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass; whether `until` came true."""
        end = self.now + seconds
        while self.now < end:
            self.now += self.step
            self.devices.advance(self.now)
            self.tick()
            while self.ticks[-1].changed:
                self.tick()
            if until():
                return True
        return False

    def tick(self) -> None:
        for id_, task in list(self.desk.open.items()):
            if self.acknowledges(task, self.now):
                try:
                    done = AcknowledgeTask(actor=SYSTEM, task=id_, revision=task.revision)
                    self.desk.acknowledge(done, Timestamp(self.now, self.now))
                except CommandRefused:
                    continue
        measured, now = self.measured() | self.desk.measured(), Timestamp(self.now, self.now)
        outcome = self.execution.tick(measured, now, (), self.offline)
        self.ticks.append(outcome)
        self.started += outcome.started
        self.completed += sorted(outcome.completed)
        if outcome.outputs:
            self._publish(outcome.outputs)
        self.desk.update(self.execution.state, outcome.finished, outcome.ended, self.now)
        self.check_law(outcome)
        self.plan()

    def plan(self) -> None:
        """Ask for a plan, and adopt the answer `thinking` ticks later."""
        if self._asked is None and (request := self._question()) is not None:
            self._asked = (request, len(self.ticks) + self.thinking)
        if self._asked is not None and len(self.ticks) >= self._asked[1]:
            request, self._asked = self._asked[0], None
            self.execution.adopt(request, self.planner.answer(request))

    def _question(self) -> PlanRequest | None:
        """As the controller asks: for a plan that is needed, and now and then for a better one."""
        request = self.execution.request(deadline=self.patience)
        if request is None and self.improves and self.now >= self._next_better:
            self._next_better = self.now + BETTER_EVERY
            request = self.execution.better(deadline=self.patience)
        return request

    def check_law(self, outcome: TickOutcome) -> None:
        """What must hold after every tick: no start leads out of the safe set, so nothing forbidden comes of one."""
        if outcome.started:
            assert self.execution.safe, outcome
            for specification in self.station.automaton.specifications.values():
                assert not holds(specification.forbidden, self.execution.state), (specification.name, outcome)

    def measured(self) -> dict[str, Value | None]:
        speaking = {name: name not in self.silent for name in self.station.pipelines.incoming}
        for name, speaks in speaking.items():
            if speaks:
                self.pipelines.take(name, self.devices.report(name), self.now)
        return self.pipelines.values(speaking)

    @property
    def offline(self) -> frozenset[str]:
        """The resources that are not heard."""
        return frozenset()

    def value(self, name: str) -> Value | None:
        return self.execution.state[name]

    def _publish(self, outputs: frozenset[str]) -> None:
        if self.execution.production != "started":
            return
        for name, pipeline in self.station.pipelines.outgoing.items():
            if outputs & set(pipeline.variables):
                message = first_message(pipeline, self.execution.state)
                assert message is not None
                assert not self.devices.command(name, message)
