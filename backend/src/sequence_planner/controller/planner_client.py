"""Planner client of a running station: the planner process, its query queue, and the restart advisor."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import overload

import structlog

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.metrics import PlannerTimes
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.execution.executor import Executor
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.planning.planner import PlannerError
from sequence_planner.planning.portfolio.worker import Answer, Request, planner_process
from sequence_planner.planning.problem import Goal, PlanAnswer, PlanRequest, WayBackAnswer, WayBackRequest
from sequence_planner.planning.recovery.consultation import Answer as AdvisorAnswer
from sequence_planner.planning.recovery.consultation import Request as AdvisorRequest
from sequence_planner.planning.recovery.proposals import Advice, RecoveryProposal
from sequence_planner.planning.recovery.request import AdviceRequest, GoalPlanRequest
from sequence_planner.planning.recovery.worker import advisor_process
from sequence_planner.process.task import WorkerError
from sequence_planner.texts.message import message

# A second planner, for what people ask, so that neither they nor the station ever wait for the other's plan.
#
# It answers one question at a time. Whoever asks says how long it waits; what is found later is dropped.


class AdvisorClient:
    """Asks an advisor in another process. Used from one event loop."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._process = advisor_process(automaton, supervisor)

    @property
    def replaced(self) -> int:
        """The number of times that the process was replaced."""
        return self._process.replaced

    def expect(self) -> None:
        """Get ready: something has happened about which people will ask soon."""
        self._process.begin()

    def close(self) -> None:
        """End the process."""
        self._process.close()

    @overload
    async def answer(self, request: AdviceRequest | GoalPlanRequest, deadline: float) -> Advice: ...

    @overload
    async def answer(self, request: PlanRequest, deadline: float) -> PlanAnswer: ...

    @overload
    async def answer(self, request: DiagnosisRequest, deadline: float) -> Diagnosis: ...

    async def answer(self, request: AdvisorRequest, deadline: float) -> AdvisorAnswer:
        """Return what the advisor answers within `deadline` seconds, of which it may have to wait for its turn.

        Raises `CommandRefused`: `advisor-timeout` (504), `advisor-unavailable` (503).
        """
        try:
            async with asyncio.timeout(deadline):
                return await self._process.ask(request, request.deadline)
        except TimeoutError:
            raise CommandRefused("advisor-timeout", message("refused.advisor-timeout.again"), 504) from None
        except (PlannerError, WorkerError) as error:
            why = error.why if isinstance(error, WorkerError) else str(error)
            raise CommandRefused(
                "advisor-unavailable", message("refused.advisor-unavailable.again", why=why), 503
            ) from None


# Plans to something that a person wants to hold, as the advisor finds them, and why there is none.

WAITING = 3.0  # seconds beyond a request's deadline: the advisor may be at something else
GOAL = "asked for"  # its name in reasons
AIMED_WITHIN = 5.0  # seconds a plan may take
EXPLAINED_WITHIN = 5.0  # seconds, where nothing was found


@dataclass(frozen=True)
class GoalPlan:
    """An offer, if there is any; or that there is nothing, which may be `proven`, and why, as far as that was found."""

    offer: RecoveryProposal | None
    proven: bool = False
    why_not: Diagnosis | None = None


async def aim(advisor: AdvisorClient, request: GoalPlanRequest) -> GoalPlan:
    """Ask for a plan, and where there is none for the reasons. Raises `CommandRefused`."""
    advice = await advisor.answer(request, request.deadline + WAITING)
    if advice.offers:
        return GoalPlan(advice.offers[0])
    goal = Goal(GOAL, request.target)
    reasons = DiagnosisRequest(request.state, (goal,), request.circumstances, EXPLAINED_WITHIN)
    try:
        diagnosis = await advisor.answer(reasons, EXPLAINED_WITHIN + WAITING)
    except CommandRefused:
        return GoalPlan(None, advice.complete)
    if diagnosis.reason is None:
        return GoalPlan(None, advice.complete)
    return GoalPlan(None, proven=True, why_not=diagnosis)


# What a running station asks its planner, in which turn, and where the answers go.

LOG = structlog.get_logger(__name__)

PLAN_DEADLINE = 5.0  # seconds a plan may take
BETTER_DEADLINE = 3.0  # seconds a better plan than the one that is followed may take
BETTER_EVERY = 1.0  # seconds between two questions for one
WAY_BACK_DEADLINE = 2.0  # seconds a way back into the safe states may take
DIAGNOSIS_DEADLINE = 20.0  # seconds it may take to say why there is no plan at all


class PlannerQuestions:
    """Asks about `execution` and `outside`. Used from one event loop.

    What comes of an answer is handed to `take`, to be done by whoever runs the station; `answers` has how long each
    took.
    """

    def __init__(
        self,
        execution: Executor,
        outside: SafeStateMonitor,
        take: Callable[[Callable[[], None]], None],
    ) -> None:
        self._execution = execution
        self._outside = outside
        self._take = take
        self.answers = PlannerTimes()
        self._needed: deque[Callable[[], Request | None]] = deque(
            (lambda: execution.request(PLAN_DEADLINE), lambda: outside.request(WAY_BACK_DEADLINE))
        )
        self._spare = False  # what the planner works on is not needed, and can be called off
        self._next_better = 0.0
        self._planner = planner_process(execution.automaton, execution.supervisor)
        self._asking: asyncio.Task[None] | None = None

    @property
    def trouble(self) -> str | None:
        """The trouble with the planner, in words."""
        return self._planner.trouble

    @property
    def replaced(self) -> int:
        """The number of times that the planner's process was replaced."""
        return self._planner.replaced

    def close(self) -> None:
        """End the planner."""
        if self._asking is not None:
            self._asking.cancel()
        self._planner.close()

    def ask(self, monotonic: float) -> None:
        """Ask for a plan or for a way back, in turn: neither waits for more than one of the other.

        A planner that has nothing else to do is asked for a better plan, or why there is none, and called off when
        something is needed.
        """
        if self._planner.away or (self._asking is not None and not self._spare):
            return
        for question in tuple(self._needed):
            self._needed.rotate(-1)
            if (request := question()) is not None:
                if self._asking is not None:
                    self._asking.cancel()
                self._spare = False
                self._asking = asyncio.create_task(self._ask(request))
                return
        if self._asking is not None:
            return
        if (request := self._execution.plan.unexplained(DIAGNOSIS_DEADLINE)) is None and monotonic >= self._next_better:
            request = self._execution.better(BETTER_DEADLINE)
            self._next_better = monotonic + BETTER_EVERY if request else self._next_better
        if request is not None:
            self._spare = True
            self._asking = asyncio.create_task(self._ask(request))

    async def _ask(self, request: Request) -> None:
        began = time.monotonic()
        answer: Answer | PlannerError | WorkerError
        try:
            answer = await self._planner.ask(request, request.deadline)
        except (PlannerError, WorkerError) as error:
            answer = error
        took, self._asking, self._spare = time.monotonic() - began, None, False
        if isinstance(answer, Exception):
            self.answers.note(request, None, took)
            # Others are only told; a station whose planner it kills again and again would have no plans.
            again = isinstance(answer, WorkerError) and answer.again and isinstance(request, PlanRequest)
            self._failed(request, str(answer), again)
        else:
            self.answers.note(request, answer, took)
            self._answered(request, answer)

    def _answered(self, request: Request, answer: Answer) -> None:
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
        match request:
            case PlanRequest():
                self._take(lambda: self._execution.unanswered(why, again))
            case WayBackRequest():
                self._take(lambda: self._outside.unanswered(request, why, again))
            case DiagnosisRequest():
                self._take(lambda: self._execution.explained(Diagnosis(None, ())))
