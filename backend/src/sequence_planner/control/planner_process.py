"""The planner's process: it plans for the station, looks for ways back into the safe states, and says why not."""

from __future__ import annotations

import asyncio

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.answering_process import AnsweringProcess, Work
from sequence_planner.control.answering_process import Listener as AnyListener
from sequence_planner.planning.plan import PlanRequest
from sequence_planner.planning.questions import Answer, Request
from sequence_planner.planning.reasons.diagnoser import Model
from sequence_planner.planning.worker import Planning, work
from sequence_planner.synthesis.fewer import FewerSpecifications

Listener = AnyListener[Request, Answer]


class PlannerProcess(AnsweringProcess[Planning, Request, Answer]):
    """Asks a planner in another process. Used from one event loop."""

    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, loop: asyncio.AbstractEventLoop, listener: Listener
    ) -> None:
        model = Model(automaton, supervisor, FewerSpecifications(automaton, supervisor))
        serving = Work("planner", work, Planning(model), _again, Planning(model, cautious=True))
        super().__init__(serving, loop, listener)


def _again(request: Request) -> bool:
    """Others are only told; a station whose planner it kills again and again would have no plans."""
    return isinstance(request, PlanRequest)
