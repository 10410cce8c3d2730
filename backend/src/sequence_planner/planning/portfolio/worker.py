"""The planner's worker process: its request types, and its main loop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from multiprocessing.connection import Connection

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
from sequence_planner.process.worker import stand_by

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


def work(connection: Connection) -> None:
    """The life of the process. Each request has one answer, or the text of an error that says why there is none."""
    stand_by(connection, _prepared)


def _prepared(planning: Planning) -> Callable[[Request, Budget], Iterator[Answer | str]]:
    stand_back(ALONE.niceness, MEMORY)
    model = planning.model
    engines = None if planning.cautious else Engines(model.automaton, model.supervisor, ALONE)
    solvers = Escalation(engines, partial(Portfolio, model.automaton, model.supervisor))
    planner = Planner(model.automaton, model.supervisor, solvers)
    diagnoser = Diagnoser(model)
    ways = WaysBack(model.automaton, model.supervisor.safe)

    def answer(request: Request, budget: Budget) -> Iterator[Answer | str]:
        try:
            match request:
                case PlanRequest():
                    yield planner.answer(request, budget)
                case WayBackRequest():
                    yield ways.answer(request, budget)
                case DiagnosisRequest(task=task):
                    yield diagnoser.diagnose(task, budget)
        except PlannerError as error:
            yield str(error)

    return answer
