"""The order of work, answered in time: by a process of its own that can be killed, or else by rule."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Final, TypeAlias

import structlog

from sequence_planner.control.answering_process import AnsweringProcess, Listener
from sequence_planner.control.answering_process import Work as ProcessWork
from sequence_planner.mes.sequencing.sequencing import by_rule, sequence
from sequence_planner.mes.sequencing.work import Schedule, Work
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.racing.companion import stand_by

LOG = structlog.get_logger(__name__)
Nothing: TypeAlias = tuple[()]
"""What the process begins with: each question says all."""

_NICENESS = 5  # ticks come first
_ANSWERING: Final = 0.2  # of the time, for what is around the search
LATE: Final = 8.0  # seconds; on a busy machine the best that was found comes later than it was asked for


@dataclass(frozen=True)
class Question:
    """What is to be put into an order, as `sequence` is asked."""

    works: tuple[Work, ...]
    exclusive: tuple[frozenset[str], ...]
    now: float
    deadline: float


class Sequencer:
    """Has works put into an order. Used from one event loop; one question at a time, the others wait for their turn."""

    def __init__(self, loop: asyncio.AbstractEventLoop, late: float = LATE) -> None:
        self._late = late
        work = ProcessWork[Nothing, Question]("order of work", serve, (), lambda question: False)
        listener: Listener[Question, Schedule] = Listener(self._answered, self._failed)
        self._waiting: asyncio.Future[Schedule | str] | None = None
        self._turn = asyncio.Lock()
        self._process: AnsweringProcess[Nothing, Question, Schedule] = AnsweringProcess(work, loop, listener)

    async def sequence(
        self, works: Sequence[Work], exclusive: Collection[frozenset[str]], now: float, limit: float
    ) -> Schedule:
        """The order that is the best to be found within `limit` seconds after its turn has come. It is waited for some
        seconds longer, as it is better than none; when there is none by then, the order by rule, which says why in
        `fallback`. Raises `ValueError` for works that cannot be worked.
        """
        async with self._turn:
            answer = await self._ask(Question(tuple(works), tuple(exclusive), now, limit))
        if isinstance(answer, Schedule):
            return answer
        LOG.warning("the order of work is by rule", why=answer, jobs=len(works))
        return await asyncio.to_thread(by_rule, works, exclusive, now, answer)

    def close(self) -> None:
        """End the process. Whoever waits has the order by rule."""
        self._process.close()
        self._settle("the order of work is not looked for any more")

    async def _ask(self, question: Question) -> Schedule | str:
        if self._process.busy:
            return self._process.trouble or "the process that looks for the order of work has not started yet"
        self._waiting = asyncio.get_running_loop().create_future()
        self._process.ask(question)
        try:
            return await asyncio.wait_for(self._waiting, question.deadline + self._late)
        except TimeoutError:
            return f"no order was found within {question.deadline + self._late:g} s"
        finally:
            self._waiting = None
            self._process.call_off()

    def _answered(self, question: Question, schedule: Schedule) -> None:
        self._settle(schedule)

    def _failed(self, question: Question, why: str, again: bool) -> None:
        self._settle(why)

    def _settle(self, answer: Schedule | str) -> None:
        if self._waiting is not None and not self._waiting.done():
            self._waiting.set_result(answer)


def serve(connection: Connection) -> None:
    """The life of the process. Each question has one answer, or the text of an error that says why there is none."""
    os.nice(_NICENESS)
    stand_by(connection, _prepared)


def _prepared(model: Nothing) -> Callable[[Question, Budget], Iterator[Schedule | str]]:
    from sequence_planner.mes.sequencing import windows  # noqa: F401, PLC0415 - imported before the first question

    def answer(question: Question, budget: Budget) -> Iterator[Schedule | str]:
        try:
            late = _ANSWERING * question.deadline
            remaining = lambda: budget.remaining - late  # noqa: E731
            yield sequence(question.works, question.exclusive, question.now, question.deadline, remaining)
        except ValueError as error:
            yield str(error)

    return answer
