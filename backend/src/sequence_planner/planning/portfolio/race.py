"""Engine portfolio: parallel, killable lane processes with engines that keep their data between tasks."""

from __future__ import annotations

import contextlib
import os
import resource
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import Enum
from math import inf
from queue import Empty, SimpleQueue
from types import TracebackType

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.planner import PlanningAttempt
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.portfolio.engines import FACTORIES, LANES, EngineReport, Engines, Factory, Lane
from sequence_planner.process.budget import Budget
from sequence_planner.process.task import WorkerError
from sequence_planner.process.worker import Worker, WorkerLoop

# The process of a lane: some engines that take turns, warm from task to task.


class LaneModel(Immutable):
    """The things that the process of a lane works with: `memory` is the most it may use for data, in bytes."""

    automaton: Automaton
    supervisor: Supervisor
    lane: Lane
    factories: Mapping[str, Factory]
    memory: int


def work(model: LaneModel) -> Callable[[PlanningTask, Budget], Iterator[EngineReport]]:
    """Return what reports on each task; a process's life."""
    stand_back(model.lane.niceness, model.memory)
    engines = Engines(model.automaton, model.supervisor, model.lane, model.factories)
    engines.prepare()
    return engines.work


def stand_back(niceness: int, memory: int) -> None:
    """Have this process be as nice as that to others, and have no more than so many bytes of data."""
    os.nice(niceness)
    with contextlib.suppress(ValueError, OSError):  # where the system knows no such limit, or has a lower one
        resource.setrlimit(resource.RLIMIT_DATA, (memory, memory))


# Engines that race: each lane is a process that lives on from task to task and can be killed at any time.
#
# The first report that answers ends a race, and the other lanes are called off. One that does not come back from that
# in time is replaced meanwhile: solvers in C cannot always be interrupted. No lane is ever waited for longer than the
# budget allows, and one that ends takes no other with it.

PATIENCE = 2.0  # seconds a lane may take to come back from a task that was called off
STARTING = 60.0  # seconds it may take for that while it is still starting
LAST_WORDS = 0.02  # seconds before the end in which lanes say how far they have come
MEMORY = 2 * 2**30  # bytes of data a lane may have


class _Word(Enum):
    """What is heard beside reports."""

    BACK = "a lane is done with the task"
    LOOK = "whether it was called off"


class Portfolio:
    """Lanes for one automaton under one supervisor, started at once. One task at a time; to be closed."""

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        lanes: Iterable[Lane] = LANES,
        factories: Mapping[str, Factory] = FACTORIES,
        memory: int = MEMORY,
    ) -> None:
        self._loop = WorkerLoop()
        self._lanes: dict[str, Worker[PlanningTask, EngineReport]] = {
            lane.name: Worker(
                work,
                LaneModel(automaton, supervisor, lane, factories, memory),
                f"planner {lane.name}",
                late=PATIENCE,
                starting=STARTING,
                rests_after=inf,
            )
            for lane in lanes
        }
        for each in self._lanes.values():
            self._loop.begin(each)

    def solve(self, attempt: PlanningAttempt, budget: Budget) -> None:
        """Have the lanes report until that answers, or is not worth waiting for any more, or the budget is spent."""
        attempt.race()
        heard: SimpleQueue[EngineReport | _Word] = SimpleQueue()
        seconds = max(budget.remaining - LAST_WORDS, 0.9 * budget.remaining)
        asked = [self._loop.submit(self._ask(lane, attempt.task, seconds, heard.put)) for lane in self._lanes]
        busy = len(asked)
        with budget.interrupting(lambda: heard.put(_Word.LOOK)):
            while busy and (patience := min(attempt.patience, budget.remaining)) > 0:
                with contextlib.suppress(Empty):
                    match heard.get(timeout=patience):
                        case EngineReport() as report:
                            attempt.take(report)
                        case _Word.BACK:
                            busy -= 1
        for each in asked:
            each.cancel()

    async def _ask(
        self, lane: str, task: PlanningTask, seconds: float, tell: Callable[[EngineReport | _Word], None]
    ) -> None:
        try:
            await self._lanes[lane].ask(task, seconds, tell)
        except WorkerError as error:
            tell(EngineReport(f"process for {lane}", Finding(), str(error)))
        tell(_Word.BACK)

    def close(self) -> None:
        """End all processes."""
        self._loop.close(*self._lanes.values())

    def __enter__(self) -> Portfolio:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
