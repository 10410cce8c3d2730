"""Diagnoses in a process of their own: synthesis cannot be interrupted, so it ends with its process."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.diagnosis import Diagnosis, SupervisorFor, diagnose
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.process.budget import Budget
from sequence_planner.process.worker import (
    Companion,
    Ended,
    Word,
    WorkerAnswered,
    WorkerFinished,
    WorkerQuestion,
    stand_by,
)

_NICENESS = 5  # what to do comes before why nothing can be done by itself
_PROCESS_SHARE = 0.9  # of the time, for the process: it says what it has found before nobody listens any more


class DiagnosisModel(Immutable):
    """The model that is planned for; `supervisor_for` is asked which specifications matter."""

    automaton: Automaton
    supervisor: Supervisor
    supervisor_for: SupervisorFor


def work(connection: Connection) -> None:
    """The life of the process."""
    stand_by(connection, _prepared)


def _prepared(model: DiagnosisModel) -> Callable[[PlanningTask, Budget], Iterator[Diagnosis]]:
    os.nice(_NICENESS)

    def answer(task: PlanningTask, budget: Budget) -> Iterator[Diagnosis]:
        yield diagnose(model.automaton, model.supervisor, model.supervisor_for, task, budget)

    return answer


class Diagnoser:
    """Asks a process that is started for the first question, and ended when its answer is not wanted any more."""

    def __init__(self, model: DiagnosisModel) -> None:
        self._model = model
        self._companion: Companion[DiagnosisModel, PlanningTask] | None = None
        self._heard: SimpleQueue[Word | None] = SimpleQueue()
        self._number = 0

    def diagnose(self, task: PlanningTask, budget: Budget) -> Diagnosis:
        """Return what is found before the budget is spent; as soon as it is called off, nothing."""
        if self._companion is None:
            self._heard = SimpleQueue()
            self._companion = Companion(work, self._model, self._heard.put, "diagnosis")
        self._number += 1
        self._companion.ask(WorkerQuestion(self._number, _PROCESS_SHARE * budget.remaining, task))
        heard = self._heard
        with budget.interrupting(lambda: heard.put(None)):
            while not budget.spent:
                with contextlib.suppress(Empty):
                    match heard.get(timeout=budget.remaining):
                        case WorkerAnswered(number, diagnosis) if number == self._number:
                            found: Diagnosis = diagnosis
                            return found
                        case Ended():
                            break
                        case WorkerFinished(number, trouble) if trouble and number == self._number:
                            break
        self.close()
        return Diagnosis(None, ())

    def close(self) -> None:
        """End the process."""
        if self._companion is not None:
            self._companion.close()
        self._companion = None
