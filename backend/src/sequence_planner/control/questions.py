"""What a running station asks its planner, in which turn, and where the answers go."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable

import structlog

from sequence_planner.control.execution import Execution
from sequence_planner.control.figures import Answers
from sequence_planner.control.outside import Outside
from sequence_planner.control.planner_process import Listener, PlannerProcess
from sequence_planner.planning.plan import PlanAnswer, PlanRequest, WayBackAnswer, WayBackRequest
from sequence_planner.planning.questions import Answer, Request
from sequence_planner.planning.reasons.diagnosis import Diagnosis, DiagnosisRequest

LOG = structlog.get_logger(__name__)

PLAN_DEADLINE = 5.0  # seconds a plan may take
BETTER_DEADLINE = 3.0  # seconds a better plan than the one that is followed may take
BETTER_EVERY = 1.0  # seconds between two questions for one
WAY_BACK_DEADLINE = 2.0  # seconds a way back into the safe states may take
DIAGNOSIS_DEADLINE = 20.0  # seconds it may take to say why there is no plan at all


class Questions:
    """Asks about `execution` and `outside`. Used from one event loop.

    What comes of an answer is handed to `take`, to be done by whoever runs the station; how long it took is noted in
    `answers`.
    """

    def __init__(
        self, execution: Execution, outside: Outside, take: Callable[[Callable[[], None]], None], answers: Answers
    ) -> None:
        self._execution = execution
        self._outside = outside
        self._take = take
        self._answers = answers
        self._asked = 0.0  # when, on the clock
        self._needed: deque[Callable[[], Request | None]] = deque(
            (lambda: execution.request(PLAN_DEADLINE), lambda: outside.request(WAY_BACK_DEADLINE))
        )
        self._spare = False  # what the planner works on is not needed, and can be called off
        self._next_better = 0.0
        listener = Listener(self._answered, self._failed)
        loop = asyncio.get_running_loop()
        self._planner = PlannerProcess(execution.automaton, execution.supervisor, loop, listener)

    @property
    def trouble(self) -> str | None:
        """What is wrong with the planner, in words."""
        return self._planner.trouble

    @property
    def replaced(self) -> int:
        """How often the planner's process was replaced."""
        return self._planner.replaced

    def close(self) -> None:
        """End the planner."""
        self._planner.close()

    def ask(self, monotonic: float) -> None:
        """Ask for a plan or for a way back, in turn: neither waits for more than one of the other.

        A planner that has nothing else to do is asked for a better plan, or why there is none, and called off when
        something is needed.
        """
        if self._planner.busy and not self._spare:
            return
        for question in tuple(self._needed):
            self._needed.rotate(-1)
            if (request := question()) is not None:
                self._planner.call_off()
                self._spare = False
                self._ask(request)
                return
        if self._planner.busy:
            return
        if (request := self._execution.plan.unexplained(DIAGNOSIS_DEADLINE)) is None and monotonic >= self._next_better:
            request = self._execution.better(BETTER_DEADLINE)
            self._next_better = monotonic + BETTER_EVERY if request else self._next_better
        if request is not None:
            self._spare = True
            self._ask(request)

    def _ask(self, request: Request) -> None:
        self._asked = time.monotonic()
        self._planner.ask(request)

    def _answered(self, request: Request, answer: Answer) -> None:
        self._spare = False
        self._answers.note(request, answer, time.monotonic() - self._asked)
        match request, answer:
            case PlanRequest(), PlanAnswer():
                self._take(lambda: self._adopt(request, answer))
            case WayBackRequest(), WayBackAnswer():
                self._take(lambda: self._outside.take(request, answer))
                LOG.info("way back", found=answer.way is not None, searched=answer.searched)
            case DiagnosisRequest(), Diagnosis():
                self._take(lambda: self._execution.explained(answer))

    def _adopt(self, request: PlanRequest, answer: PlanAnswer) -> None:
        self._execution.adopt(request, answer)
        if self._execution.plan.answer is answer:
            starts = [name for _, name in answer.plan.starts] if answer.plan else []
            LOG.info("plan", verdict=str(answer.verdict), engine=answer.engine, starts=starts)

    def _failed(self, request: Request, why: str, again: bool) -> None:
        self._spare = False
        self._answers.note(request, None, time.monotonic() - self._asked)
        match request:
            case PlanRequest():
                self._take(lambda: self._execution.unanswered(why, again))
            case WayBackRequest():
                self._take(lambda: self._outside.unanswered(request, why, again))
            case DiagnosisRequest():
                self._take(lambda: self._execution.explained(Diagnosis(None, ())))
