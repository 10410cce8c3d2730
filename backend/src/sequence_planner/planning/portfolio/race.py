"""Engine portfolio: parallel, killable lane processes with engines that keep their data between tasks."""

from __future__ import annotations

import contextlib
import logging
import os
import resource
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from types import TracebackType

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.planner import PlanningAttempt
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.portfolio.engines import FACTORIES, LANES, EngineReport, Engines, Factory, Lane
from sequence_planner.process.budget import Budget
from sequence_planner.process.worker import (
    Companion,
    Ended,
    Word,
    WorkerAnswered,
    WorkerFinished,
    WorkerQuestion,
    WorkerReady,
    stand_by,
)

# The process of a lane: some engines that take turns, warm from task to task.


class LaneModel(Immutable):
    """The things that the process of a lane works with: `memory` is the most it may use for data, in bytes."""

    automaton: Automaton
    supervisor: Supervisor
    lane: Lane
    factories: Mapping[str, Factory]
    memory: int


def work(connection: Connection) -> None:
    """The life of the process."""
    stand_by(connection, _prepared)


def _prepared(model: LaneModel) -> Callable[[PlanningTask, Budget], Iterator[EngineReport]]:
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

LOG = logging.getLogger(__name__)

PATIENCE = 2.0  # seconds a lane may take to come back from a task that was called off
STARTING = 60.0  # seconds it may take for that while it is still starting
LAST_WORDS = 0.02  # seconds before the end in which lanes say how far they have come
LONGEST_PAUSE = 30.0  # seconds before a lane that has ended again and again is started once more
MEMORY = 2 * 2**30  # bytes of data a lane may have


class _Heard(Immutable):
    """A report on the task of this number from a lane, or, without one, that nothing more comes from it."""

    lane: str
    number: int
    report: EngineReport | None = None


class _Runner:
    """One lane and its process, which is replaced when it ends or does not come back.

    A thread of the process's companion hears for it, and a timer replaces; everything is kept under a lock.
    """

    def __init__(self, model: LaneModel, tell: Callable[[_Heard], None]) -> None:
        self.name = model.lane.name
        self._model = model
        self._tell = tell
        self._lock = threading.RLock()
        self._companion: Companion[LaneModel, PlanningTask] | None = None
        self._before: Companion[LaneModel, PlanningTask] | None = None  # one that is replaced and still to be ended
        self._generation = 0  # of the process; what earlier ones say counts no more
        self._ready = False  # to work on tasks
        self.started = threading.Event()  # it has been ready once
        self._deaths = 0  # since it last came back from a task
        self._asked = self._off = self._back = (
            0  # the last task it was given, that was called off, that it is done with
        )
        self._timer: threading.Timer | None = None
        self._closed = False
        self._start()

    def ask(self, number: int, seconds: float, task: PlanningTask) -> bool:
        """Give it a task, unless it has no process to work on it."""
        with self._lock:
            if self._companion is None:
                return False
            self._asked = number
            self._companion.ask(WorkerQuestion(number, seconds, task))
            return True

    def call_off(self) -> None:
        """Have it give up its task; when it does not come back, its process is replaced."""
        with self._lock:
            if self._companion is None or self._back == self._asked:
                return
            self._off = self._asked
            self._companion.call_off(self._off)
            if self._timer is None:
                self._later(PATIENCE if self._ready else STARTING, self._look, self._off)

    def close(self) -> None:
        """End its process."""
        with self._lock:
            self._closed = True
            self._generation += 1
            timer = self._timer
        if timer is not None:
            timer.cancel()
            timer.join()
        for companion in (self._companion, self._before):
            if companion is not None:
                companion.close()
        self._companion = self._before = None

    def _start(self) -> None:
        with self._lock:
            if self._closed:
                return
            generation = self._generation
            try:
                self._companion = Companion(
                    work, self._model, lambda word: self._hear(generation, word), f"planner {self.name}"
                )
            except OSError as error:
                self._replace(f"cannot be started ({error})")

    def _hear(self, generation: int, word: Word) -> None:
        with self._lock:
            if generation != self._generation:
                return
            match word:
                case WorkerReady():
                    self._ready = True
                    self.started.set()
                    if self._timer is not None:  # a task was called off meanwhile
                        self._timer.cancel()
                        self._later(PATIENCE, self._look, self._off)
                case WorkerAnswered(number, report):
                    self._tell(_Heard(self.name, number, report))
                case WorkerFinished(number):
                    self._back, self._deaths = number, 0
                    self._tell(_Heard(self.name, number))
                case Ended():
                    self._replace("has ended")

    def _look(self, number: int) -> None:
        """Check whether it has come back from the task of that number."""
        with self._lock:
            self._timer = None
            if self._back < number:
                self._deaths = 0  # which it could not help
                self._replace("does not come back from a task that was called off")
            elif self._back < self._off:
                self._later(PATIENCE, self._look, self._off)

    def _replace(self, why: str) -> None:
        """Have another process take over, later each time one ends without having come back from a task."""
        LOG.warning("the planner's process for %s %s and is started again; others plan meanwhile", self.name, why)
        if self._back < self._asked:
            self._tell(_Heard(self.name, self._asked, EngineReport(f"process for {self.name}", Finding(), why)))
            self._tell(_Heard(self.name, self._asked))
        self._generation += 1
        self._ready = False
        self._back = self._off = self._asked
        self._before, self._companion = self._companion, None
        if self._timer is not None:
            self._timer.cancel()
        pause = min(2.0**self._deaths, LONGEST_PAUSE) if self._deaths else 0.0
        self._deaths += 1
        self._later(pause, self._renew)

    def _renew(self) -> None:
        if self._before is not None:
            self._before.close()  # not under the lock, which its thread may be waiting for
        with self._lock:
            self._before = self._timer = None
            self._start()

    def _later(self, seconds: float, act: Callable[..., None], *arguments: object) -> None:
        if self._closed:
            return
        self._timer = threading.Timer(seconds, act, arguments)
        self._timer.daemon = True
        self._timer.start()


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
        self._heard: SimpleQueue[_Heard | None] = SimpleQueue()
        self._number = 0
        self._runners = [
            _Runner(LaneModel(automaton, supervisor, lane, factories, memory), self._heard.put) for lane in lanes
        ]

    def wait(self, budget: Budget) -> None:
        """Until every lane has been ready once, or the budget is spent: a task that comes earlier has less time."""
        for runner in self._runners:
            runner.started.wait(budget.remaining)

    def solve(self, attempt: PlanningAttempt, budget: Budget) -> None:
        """Have the lanes report until that answers, or is not worth waiting for any more, or the budget is spent."""
        self._number += 1
        seconds = max(budget.remaining - LAST_WORDS, 0.9 * budget.remaining)
        busy = {runner.name for runner in self._runners if runner.ask(self._number, seconds, attempt.task)}
        if not busy:
            attempt.troubles.append("no lane has a process: they are being started again")
        with budget.interrupting(lambda: self._heard.put(None)):
            while busy and (patience := min(attempt.patience, budget.remaining)) > 0:
                with contextlib.suppress(Empty):
                    heard = self._heard.get(timeout=patience)
                    if heard is None or heard.number != self._number:
                        continue  # only to look whether it was called off, or left over from an earlier task
                    if heard.report is None:
                        busy.discard(heard.lane)
                    else:
                        attempt.take(heard.report)
        for runner in self._runners:
            runner.call_off()

    def close(self) -> None:
        """End all processes."""
        for runner in self._runners:
            runner.close()

    def __enter__(self) -> Portfolio:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
