"""Diagnoses in a process of their own: synthesis cannot be interrupted, so it ends with its process."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError
from math import inf

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.diagnosis import Diagnosis, SupervisorFor, diagnose
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.process.budget import Budget
from sequence_planner.process.task import WorkerError
from sequence_planner.process.worker import Worker, WorkerLoop

_NICENESS = 5  # what to do comes before why nothing can be done by itself
_PROCESS_SHARE = 0.9  # of the time, for the process: it says what it has found before nobody listens any more


class DiagnosisModel(Immutable):
    """The model that is planned for; `supervisor_for` is asked which specifications matter."""

    automaton: Automaton
    supervisor: Supervisor
    supervisor_for: SupervisorFor


def work(model: DiagnosisModel) -> Callable[[PlanningTask, Budget], Diagnosis]:
    """Return what answers; a process's life."""

    def answer(task: PlanningTask, budget: Budget) -> Diagnosis:
        return diagnose(model.automaton, model.supervisor, model.supervisor_for, task, budget.part(_PROCESS_SHARE))

    return answer


class Diagnoser:
    """Asks a process that is started for the first question, and ended when its answer is not wanted any more."""

    def __init__(self, model: DiagnosisModel) -> None:
        self._model = model
        self._asking: tuple[WorkerLoop, Worker[PlanningTask, Diagnosis]] | None = None

    def diagnose(self, task: PlanningTask, budget: Budget) -> Diagnosis:
        """Return what is found before the budget is spent; as soon as it is called off, nothing."""
        if self._asking is None:
            worker: Worker[PlanningTask, Diagnosis] = Worker(
                work, self._model, "diagnosis", niceness=_NICENESS, late=0.0, starting=None, rests_after=inf, kept=False
            )
            self._asking = WorkerLoop(), worker
        loop, worker = self._asking
        asked = loop.submit(worker.ask(task, budget.remaining))
        with budget.interrupting(asked.cancel):
            try:
                return asked.result()
            except (CancelledError, WorkerError):
                self.close()
                return Diagnosis(None, ())

    def close(self) -> None:
        """End the process."""
        if self._asking is not None:
            loop, worker = self._asking
            loop.close(worker)
        self._asking = None
