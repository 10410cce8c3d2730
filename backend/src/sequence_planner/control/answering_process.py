"""A process that answers, as the controller sees it: one question at a time, a new one when it fails to answer.

It begins with the first question, and ends when nobody has asked for some time: it is forked again in no time.

The event loop never touches the pipe: a write or a read would wait for a process that stands still, and the ticks with
it. The companion's threads do.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection
from typing import Generic, Protocol, TypeVar

import structlog

from sequence_planner.planning.racing.companion import Answered, Companion, Ended, Finished, Question, Ready, Word

LOG = structlog.get_logger(__name__)

GRACE = 10.0  # seconds beyond the deadline of a request, for the answer's way; then the process is replaced
STARTING = 120.0  # seconds a process may take to start
LONGEST_PAUSE = 30.0  # seconds before a process that has died again and again is replaced
RESTS_AFTER = 30.0  # seconds without a question, after which it ends until there is one


class Limited(Protocol):
    """A request that says how many seconds its answer may take."""

    @property
    def deadline(self) -> float:
        """So many seconds."""
        ...


Model = TypeVar("Model")
Request = TypeVar("Request", bound=Limited)
Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Listener(Generic[Request, Answer]):
    """Who hears of it, on the event loop: an answer, or why there is none and whether to ask the same again."""

    answered: Callable[[Request, Answer], None]
    failed: Callable[[Request, str, bool], None]


@dataclass(frozen=True)
class Work(Generic[Model, Request]):
    """What the process does: it is called `name` and lives `serve`, beginning with `model`.

    A request over which it has died is asked `again` where that is said, and the next one begins with `cautious`, if
    that is another model.
    """

    name: str
    serve: Callable[[Connection], None]
    model: Model
    again: Callable[[Request], bool]
    cautious: Model | None = None


class AnsweringProcess(Generic[Model, Request, Answer]):
    """Asks another process. Used from one event loop."""

    def __init__(
        self, work: Work[Model, Request], loop: asyncio.AbstractEventLoop, listener: Listener[Request, Answer]
    ) -> None:
        self._work = work
        self._loop = loop
        self._listener = listener
        self._asked: Request | None = None
        self._number = 0  # of the last question
        self._timer: asyncio.Handle | None = None
        self._companion: Companion[Model, Request] | None = None
        self._generation = 0  # of the process; what earlier ones say counts no more
        self._ready = False
        self._deaths = 0  # since the last answer
        self._owes = False  # it has died over a question since
        self.trouble: str | None = None
        self.replaced = 0  # how often
        self._rests = True
        self._leaving: threading.Thread | None = None  # ends one that rests

    @property
    def busy(self) -> bool:
        """Whether a question is out, or there can be no process to be asked yet."""
        return self._asked is not None or (self._companion is None and not self._rests)

    def ask(self, request: Request) -> None:
        """Ask; the one question before must have been answered, or called off."""
        if self.busy:
            raise RuntimeError(f"the {self._work.name} is asked one thing at a time")
        self._asked = request
        self._number += 1
        if self._rests:
            self._start()
        if self._companion is not None:
            self._companion.ask(Question(self._number, request.deadline, request))
        if self._ready:
            self._limit(request.deadline + GRACE)

    def begin(self) -> None:
        """Begin the process, as it will be asked soon. It rests again where it is not."""
        if self._rests:
            self._start()

    def call_off(self) -> None:
        """Nobody waits for an answer any more: none is heard, and the next question may be asked at once."""
        if self._asked is None:
            return
        self._asked = None
        if self._companion is not None:
            self._companion.call_off(self._number)
        if self._ready:
            self._limit(GRACE)

    def close(self) -> None:
        """End the process."""
        companion = self._given_up()
        if companion is not None:
            companion.close()
        if self._leaving is not None:
            self._leaving.join()
            self._leaving = None

    def _given_up(self) -> Companion[Model, Request] | None:
        """The process, which nobody hears any more."""
        self._limit(None)
        self._generation += 1
        companion, self._companion, self._ready = self._companion, None, False
        return companion

    def _rest(self) -> None:
        """End the process until somebody asks; no tick waits for that."""
        companion, self._rests = self._given_up(), True
        if companion is not None:
            self._leaving = threading.Thread(target=companion.close, daemon=True, name=self._work.name)
            self._leaving.start()

    def _start(self) -> None:
        self._rests = False
        try:
            hear = partial(self._tell, self._generation)
            work = self._work
            model = work.model if work.cautious is None or not self._owes else work.cautious
            self._companion = Companion(work.serve, model, hear, work.name)
        except OSError as error:
            self._timer = self._loop.call_soon(self._replace, f"cannot be started ({error})")
            return
        self._limit(STARTING)

    def _limit(self, seconds: float | None) -> None:
        """The process is replaced unless it speaks within so many seconds; None: it may be silent."""
        if self._timer is not None:
            self._timer.cancel()
        self._timer = None if seconds is None else self._loop.call_later(seconds, self._replace, "was silent too long")

    def _limit_to_rest(self) -> None:
        """It rests unless it is asked in time."""
        self._limit(None)
        self._timer = self._loop.call_later(RESTS_AFTER, self._rest)

    def _tell(self, generation: int, word: Word) -> None:
        """In the thread that reads."""
        with contextlib.suppress(RuntimeError):  # the loop has been closed: nobody listens any more
            self._loop.call_soon_threadsafe(self._hear, generation, word)

    def _hear(self, generation: int, word: Word) -> None:
        if generation != self._generation:
            return
        match word:
            case Ready():
                self._ready = True
                if not self._owes:
                    self.trouble = None
                if self._asked is None:
                    self._limit_to_rest()
                else:
                    self._limit(self._asked.deadline + GRACE)
            case Answered(number, content) if number == self._number:
                self._limit_to_rest()
                self._take(content)
            case Finished(number, trouble) if number == self._number:
                self._limit_to_rest()
                if trouble:
                    self._take(f"the {self._work.name} failed ({trouble})")
            case Ended():
                self._replace("has ended")

    def _take(self, content: Answer | str) -> None:
        """An answer, or why there is none."""
        request, self._asked = self._asked, None
        self._deaths, self._owes = 0, False
        if isinstance(content, str):
            LOG.error("a question was not answered", why=content)
            self.trouble = content
            if request is not None:
                self._listener.failed(request, content, False)
        elif request is not None:
            self.trouble = None
            self._listener.answered(request, content)

    def _replace(self, why: str) -> None:
        """Kill what is left of the process and start a new one, later each time it happens in a row."""
        self.close()
        pause = min(2.0**self._deaths, LONGEST_PAUSE) if self._deaths else 0.0
        self._deaths += 1
        self.replaced += 1
        LOG.warning("a process is replaced", process=self._work.name, why=why, pause=pause)
        self._timer = self._loop.call_later(pause, self._start)
        self.trouble = f"the {self._work.name} {why} and is started again"
        if (request := self._asked) is not None:
            self._asked, self._owes = None, True
            self._listener.failed(request, self.trouble, self._work.again(request))
