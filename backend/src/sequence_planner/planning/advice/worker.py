"""The advisor in a process of its own: requests in, answers out. It can be killed at any time, and loses nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection

from sequence_planner.planning.advice.advisor import Advisor
from sequence_planner.planning.advice.questions import Answer, Request
from sequence_planner.planning.advice.request import AdviceRequest, ErrandRequest
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import PlanRequest
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.racing.companion import stand_by
from sequence_planner.planning.reasons.diagnoser import Diagnoser, Model
from sequence_planner.planning.reasons.diagnosis import DiagnosisRequest


def work(connection: Connection) -> None:
    """The life of the process. Each request has one answer, or the text of an error that says why there is none.

    It is no daemon: why there is no plan is found out by a process of its own.
    """
    stand_by(connection, _prepared)


def _prepared(model: Model) -> Callable[[Request, Budget], Iterator[Answer | str]]:
    diagnoser = Diagnoser(model)
    advisor = Advisor(model.automaton, model.supervisor, diagnoser.diagnose)
    advisor.prepare()
    planner = Planner(model.automaton, model.supervisor)

    def answer(request: Request, budget: Budget) -> Iterator[Answer | str]:
        try:
            match request:
                case AdviceRequest():
                    yield advisor.advise(request, budget)
                case ErrandRequest():
                    yield advisor.errand(request, budget)
                case PlanRequest():
                    yield planner.answer(request, budget)
                case DiagnosisRequest(task=task):
                    yield diagnoser.diagnose(task, budget)
        except PlannerError as error:
            yield str(error)

    return answer
