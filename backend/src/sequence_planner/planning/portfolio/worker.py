"""The planner's worker process: its request types, and its main loop."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning.diagnoser import Diagnoser, DiagnosisModel
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.portfolio.engines import ALONE, Engines
from sequence_planner.planning.portfolio.escalation import Escalation
from sequence_planner.planning.portfolio.race import MEMORY, Portfolio, stand_back
from sequence_planner.planning.problem import PlanAnswer, PlanRequest, WayBackAnswer, WayBackRequest
from sequence_planner.planning.recovery_path import WaysBack
from sequence_planner.process.budget import Budget
from sequence_planner.process.worker import Worker
from sequence_planner.synthesis.supervisor import FewerSpecifications

# All that the planner's process can be asked, and what it answers.

Request = PlanRequest | WayBackRequest | DiagnosisRequest
Answer = PlanAnswer | WayBackAnswer | Diagnosis


# The planner in a process of its own: requests in, answers out. It, and lanes with it, can be killed any time.


class Planning(Immutable):
    """The things the process works with; `cautious` where one before it has ended over a question, as an engine may
    do.
    """

    model: DiagnosisModel
    cautious: bool = False


def planner_process(automaton: Automaton, supervisor: Supervisor) -> Worker[Request, Answer]:
    """Return the process, which may raise `PlannerError`."""
    model = DiagnosisModel(automaton, supervisor, FewerSpecifications(automaton, supervisor))
    return Worker(work, Planning(model), "planner", cautious=Planning(model, cautious=True), errors=(PlannerError,))


def work(planning: Planning) -> Callable[[Request, Budget], Answer]:
    """Return what answers each request, which raises `PlannerError`."""
    stand_back(ALONE.niceness, MEMORY)
    model = planning.model
    engines = None if planning.cautious else Engines(model.automaton, model.supervisor, ALONE)
    solvers = Escalation(engines, partial(Portfolio, model.automaton, model.supervisor))
    planner = Planner(model.automaton, model.supervisor, solvers)
    diagnoser = Diagnoser(model)
    ways = WaysBack(model.automaton, model.supervisor.safe)

    def answer(request: Request, budget: Budget) -> Answer:
        match request:
            case PlanRequest():
                return planner.answer(request, budget)
            case WayBackRequest():
                return ways.answer(request, budget)
            case DiagnosisRequest(task=task):
                return diagnoser.diagnose(task, budget)

    return answer
