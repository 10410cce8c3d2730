"""A second planner, for what people ask, so that neither they nor the station ever wait for the other's plan.

It answers one question at a time. Whoever asks says how long it waits; what is found later is dropped.
"""

from __future__ import annotations

import asyncio
from typing import overload

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.answering_process import AnsweringProcess, Listener, Work
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.planning.advice.offer import Advice
from sequence_planner.planning.advice.questions import Answer, Request
from sequence_planner.planning.advice.request import AdviceRequest, ErrandRequest
from sequence_planner.planning.advice.worker import work
from sequence_planner.planning.plan import PlanAnswer, PlanRequest
from sequence_planner.planning.reasons.diagnoser import Model
from sequence_planner.planning.reasons.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.synthesis.fewer import FewerSpecifications


class Adviser:
    """Asks an adviser in another process. Used from one event loop."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        model = Model(automaton, supervisor, FewerSpecifications(automaton, supervisor))
        serving = Work[Model, Request]("adviser", work, model, lambda request: False)
        self._loop = asyncio.get_running_loop()
        self._process = AnsweringProcess(serving, self._loop, Listener[Request, Answer](self._answered, self._failed))
        self._turn = asyncio.Lock()
        self._awaited: asyncio.Future[Answer] | None = None

    @property
    def replaced(self) -> int:
        """How often the process was replaced."""
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

    async def answer(self, request: Request, deadline: float) -> Answer:
        """What the adviser answers within `deadline` seconds, of which it may have to wait for its turn.

        Raises `CommandRefused`: `adviser-late` (504), `adviser-away` (503).
        """
        try:
            async with asyncio.timeout(deadline), self._turn:
                return await self._asked(request)
        except TimeoutError:
            detail = "No answer was found in time; nothing was changed by asking. Try again."
            raise CommandRefused("adviser-late", "The adviser was too slow", detail, 504) from None

    async def _asked(self, request: Request) -> Answer:
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

    def _answered(self, request: Request, answer: Answer) -> None:
        if self._awaited is not None and not self._awaited.done():
            self._awaited.set_result(answer)

    def _failed(self, request: Request, why: str, again: bool) -> None:
        if self._awaited is not None and not self._awaited.done():
            self._awaited.set_exception(_away(why))


def _away(why: str) -> CommandRefused:
    detail = f"{why[:1].upper()}{why[1:]}. Nothing was changed by asking; try again in a moment."
    return CommandRefused("adviser-away", "The adviser cannot answer", detail, 503)
