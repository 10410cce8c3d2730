"""The planner in a process of its own: requests in, answers out. It, and its lanes with it, can be killed any time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection

from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import PlanRequest, WayBackRequest
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.questions import Answer, Request
from sequence_planner.planning.racing.companion import stand_by
from sequence_planner.planning.racing.race import Race
from sequence_planner.planning.reasons.diagnoser import Diagnoser, Model
from sequence_planner.planning.reasons.diagnosis import DiagnosisRequest
from sequence_planner.planning.way_back import WaysBack

STARTING = 30.0  # seconds the lanes may take to start before questions are answered by those that have


def work(connection: Connection) -> None:
    """The life of the process. Each request has one answer, or the text of an error that says why there is none."""
    stand_by(connection, _prepared)


def _prepared(model: Model) -> Callable[[Request, Budget], Iterator[Answer | str]]:
    race = Race(model.automaton, model.supervisor)
    race.wait(Budget.seconds(STARTING))
    planner = Planner(model.automaton, model.supervisor, race)
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
