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
from sequence_planner.controller.metrics import Answers
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.execution.executor import Executor
from sequence_planner.planning.diagnoser import DiagnosisModel
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.planning.portfolio.worker import Answer, Planning, Request, work
from sequence_planner.planning.problem import Goal, PlanAnswer, PlanRequest, WayBackAnswer, WayBackRequest
from sequence_planner.planning.recovery.advisor import work as advise
from sequence_planner.planning.recovery.consultation import Answer as AdvisorAnswer
from sequence_planner.planning.recovery.consultation import Request as AdvisorRequest
from sequence_planner.planning.recovery.proposals import Advice, RecoveryProposal
from sequence_planner.planning.recovery.request import AdviceRequest, ErrandRequest
from sequence_planner.process.worker import AnsweringWorker, Listener, WorkerTask
from sequence_planner.process.worker import Listener as AnyListener
from sequence_planner.synthesis.supervisor import FewerSpecifications

# A second planner, for what people ask, so that neither they nor the station ever wait for the other's plan.
#
# It answers one question at a time. Whoever asks says how long it waits; what is found later is dropped.


class AdvisorClient:
    """Asks an adviser in another process. Used from one event loop."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        model = DiagnosisModel(automaton, supervisor, FewerSpecifications(automaton, supervisor))
        serving = WorkerTask[DiagnosisModel, AdvisorRequest]("adviser", advise, model, lambda request: False)
        self._loop = asyncio.get_running_loop()
        self._process = AnsweringWorker(
            serving, self._loop, Listener[AdvisorRequest, AdvisorAnswer](self._answered, self._failed)
        )
        self._turn = asyncio.Lock()
        self._awaited: asyncio.Future[AdvisorAnswer] | None = None

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
    async def answer(self, request: AdviceRequest | ErrandRequest, deadline: float) -> Advice: ...

    @overload
    async def answer(self, request: PlanRequest, deadline: float) -> PlanAnswer: ...

    @overload
    async def answer(self, request: DiagnosisRequest, deadline: float) -> Diagnosis: ...

    async def answer(self, request: AdvisorRequest, deadline: float) -> AdvisorAnswer:
        """Return what the adviser answers within `deadline` seconds, of which it may have to wait for its turn.

        Raises `CommandRefused`: `advisor-timeout` (504), `advisor-unavailable` (503).
        """
        try:
            async with asyncio.timeout(deadline), self._turn:
                return await self._asked(request)
        except TimeoutError:
            detail = "No answer was found in time; nothing was changed by asking. Try again."
            raise CommandRefused("advisor-timeout", "The adviser was too slow", detail, 504) from None

    async def _asked(self, request: AdvisorRequest) -> AdvisorAnswer:
        process = self._process
        if process.busy:
            raise _away(process.trouble or "the adviser is started again")
        self._awaited = self._loop.create_future()
        process.ask(request)
        try:
            return await self._awaited
        finally:
            if self._awaited.cancelled():
                process.call_off()
            self._awaited = None

    def _answered(self, request: AdvisorRequest, answer: AdvisorAnswer) -> None:
        if self._awaited is not None and not self._awaited.done():
            self._awaited.set_result(answer)

    def _failed(self, request: AdvisorRequest, why: str, again: bool) -> None:
        if self._awaited is not None and not self._awaited.done():
            self._awaited.set_exception(_away(why))


def _away(why: str) -> CommandRefused:
    detail = f"{why[:1].upper()}{why[1:]}. Nothing was changed by asking; try again in a moment."
    return CommandRefused("advisor-unavailable", "The adviser cannot answer", detail, 503)


# Plans to something that a person wants to hold, as the adviser finds them, and why there is none.

WAITING = 3.0  # seconds beyond a request's deadline: the adviser may be at something else
GOAL = "asked for"  # its name in reasons
AIMED_WITHIN = 5.0  # seconds a plan may take
EXPLAINED_WITHIN = 5.0  # seconds, where nothing was found


@dataclass(frozen=True)
class GoalPlan:
    """An offer, if there is any; or that there is nothing, which may be `proven`, and why, as far as that was found."""

    offer: RecoveryProposal | None
    proven: bool = False
    why_not: Diagnosis | None = None


async def aim(adviser: AdvisorClient, request: ErrandRequest) -> GoalPlan:
    """Ask for a plan, and where there is none for the reasons. Raises `CommandRefused`."""
    advice = await adviser.answer(request, request.deadline + WAITING)
    if advice.offers:
        return GoalPlan(advice.offers[0])
    goal = Goal(GOAL, request.target)
    reasons = DiagnosisRequest(request.state, (goal,), request.circumstances, EXPLAINED_WITHIN)
    try:
        diagnosis = await adviser.answer(reasons, EXPLAINED_WITHIN + WAITING)
    except CommandRefused:
        return GoalPlan(None, advice.complete)
    if diagnosis.reason is None:
        return GoalPlan(None, advice.complete)
    return GoalPlan(None, proven=True, why_not=diagnosis)


# The planner's process: it plans for the station, looks for ways back into the safe states, and says why not.

PlannerListener = AnyListener[Request, Answer]


class PlannerProcess(AnsweringWorker[Planning, Request, Answer]):
    """Asks a planner in another process. Used from one event loop."""

    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, loop: asyncio.AbstractEventLoop, listener: PlannerListener
    ) -> None:
        model = DiagnosisModel(automaton, supervisor, FewerSpecifications(automaton, supervisor))
        serving = WorkerTask("planner", work, Planning(model), _again, Planning(model, cautious=True))
        super().__init__(serving, loop, listener)


def _again(request: Request) -> bool:
    """Others are only told; a station whose planner it kills again and again would have no plans."""
    return isinstance(request, PlanRequest)


# What a running station asks its planner, in which turn, and where the answers go.

LOG = structlog.get_logger(__name__)

PLAN_DEADLINE = 5.0  # seconds a plan may take
BETTER_DEADLINE = 3.0  # seconds a better plan than the one that is followed may take
BETTER_EVERY = 1.0  # seconds between two questions for one
WAY_BACK_DEADLINE = 2.0  # seconds a way back into the safe states may take
DIAGNOSIS_DEADLINE = 20.0  # seconds it may take to say why there is no plan at all


class PlannerQuestions:
    """Asks about `execution` and `outside`. Used from one event loop.

    What comes of an answer is handed to `take`, to be done by whoever runs the station; how long it took is noted in
    `answers`.
    """

    def __init__(
        self,
        execution: Executor,
        outside: SafeStateMonitor,
        take: Callable[[Callable[[], None]], None],
        answers: Answers,
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
        listener = PlannerListener(self._answered, self._failed)
        loop = asyncio.get_running_loop()
        self._planner = PlannerProcess(execution.automaton, execution.supervisor, loop, listener)

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
