"""The planner in a process of its own: requests in, answers out. It, and its lanes with it, can be killed any time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import Answer, Request, WayBackRequest
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.racing.companion import stand_by
from sequence_planner.planning.racing.race import Race
from sequence_planner.planning.way_back import WaysBack


@dataclass(frozen=True)
class Model:
    """What is planned for."""

    automaton: Automaton
    supervisor: Supervisor


def work(connection: Connection) -> None:
    """The life of the process. Each request has one answer, or the text of an error that says why there is none."""
    stand_by(connection, _prepared)


def _prepared(model: Model) -> Callable[[Request, Budget], Iterator[Answer | str]]:
    race = Race(model.automaton, model.supervisor)
    planner = Planner(model.automaton, model.supervisor, race)
    ways = WaysBack(model.automaton, model.supervisor.safe)

    def answer(request: Request, budget: Budget) -> Iterator[Answer | str]:
        try:
            yield ways.answer(request) if isinstance(request, WayBackRequest) else planner.answer(request, budget)
        except PlannerError as error:
            yield str(error)

    return answer
