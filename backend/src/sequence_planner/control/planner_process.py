"""The planner's process as the controller sees it: one question at a time, a new process when it fails to answer.

The event loop never touches the pipe: a write or a read would wait for a process that stands still, and the ticks with
it. A thread does, and ends with its process.
"""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import threading
from collections.abc import Callable
from dataclasses import dataclass
from queue import SimpleQueue

import structlog

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.planning.plan import Answer, Request, WayBackRequest
from sequence_planner.planning.worker import Ready, Word, work

LOG = structlog.get_logger(__name__)

GRACE = 10.0  # seconds beyond the deadline of a request, for the answer's way; then the process is replaced
STARTING = 120.0  # seconds a process may take to start
LONGEST_PAUSE = 30.0  # seconds before a process that has died again and again is replaced


@dataclass(frozen=True)
class Listener:
    """Who hears of it, on the event loop: an answer, or why there is none and whether to ask the same again."""

    answered: Callable[[Request, Answer], None]
    failed: Callable[[Request, str, bool], None]


class _Worker:
    """One process and the thread that speaks with it; `hear` is called on the loop, with None when it has ended."""

    def __init__(
        self,
        automaton: Automaton,
        supervisor: Supervisor,
        loop: asyncio.AbstractEventLoop,
        hear: Callable[[_Worker, Word | None], None],
    ) -> None:
        self.ready = False
        self.questions: SimpleQueue[Request | None] = SimpleQueue()
        self._model = (automaton, supervisor)
        self._loop = loop
        self._hear = hear
        context = multiprocessing.get_context("spawn")
        self._connection, theirs = context.Pipe()
        with theirs:
            self._process = context.Process(target=work, args=(theirs,), daemon=True, name="planner")
            self._process.start()
        loop.add_reader(self._process.sentinel, self._ended)
        self._thread = threading.Thread(target=self._converse, daemon=True, name="planner")
        self._thread.start()

    def close(self) -> None:
        """End process and thread, whatever they are doing."""
        self._loop.remove_reader(self._process.sentinel)
        self._process.kill()
        self._process.join()
        self.questions.put(None)
        self._thread.join()

    def _ended(self) -> None:
        """The process has ended; what it said before is still to be heard."""
        self._loop.remove_reader(self._process.sentinel)
        self.questions.put(None)

    def _converse(self) -> None:
        # Whatever is wrong with the pipe or with what comes out of it: the process is of no more use.
        with self._connection, contextlib.suppress(Exception):
            self._connection.send(self._model)  # from this thread: a large one takes as long as the process to start
            self._tell(self._connection.recv())
            while (question := self.questions.get()) is not None:
                self._connection.send(question)
                self._tell(self._connection.recv())
        self._tell(None)

    def _tell(self, word: Word | None) -> None:
        with contextlib.suppress(RuntimeError):  # the loop has been closed: nobody listens any more
            self._loop.call_soon_threadsafe(self._hear, self, word)


class PlannerProcess:
    """Asks a planner in another process. Used from one event loop."""

    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, loop: asyncio.AbstractEventLoop, listener: Listener
    ) -> None:
        self._arguments = (automaton, supervisor)
        self._loop = loop
        self._listener = listener
        self._asked: Request | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._worker: _Worker | None = None
        self._deaths = 0  # since the last answer
        self._owes = False  # it has died over a question since
        self.trouble: str | None = None
        self._start()

    @property
    def busy(self) -> bool:
        """Whether a question is out, or there is no process to be asked."""
        return self._asked is not None or self._worker is None

    def ask(self, request: Request) -> None:
        """Ask; the one question before must have been answered."""
        if self._asked is not None or self._worker is None:
            raise RuntimeError("the planner is asked one thing at a time")
        self._asked = request
        self._worker.questions.put(request)
        if self._worker.ready:
            self._limit(request.deadline + GRACE)

    def close(self) -> None:
        """End the process."""
        self._limit(None)
        if self._worker is not None:
            self._worker.close()
        self._worker = None

    def _start(self) -> None:
        try:
            self._worker = _Worker(*self._arguments, self._loop, self._hear)
        except OSError as error:
            self._replace(f"cannot be started ({error})")
            return
        self._limit(STARTING)

    def _limit(self, seconds: float | None) -> None:
        """The process is replaced unless it speaks within so many seconds; None: it may be silent."""
        if self._timer is not None:
            self._timer.cancel()
        self._timer = None if seconds is None else self._loop.call_later(seconds, self._replace, "was silent too long")

    def _hear(self, worker: _Worker, word: Word | None) -> None:
        if worker is not self._worker:
            return  # the last word of one that has been replaced
        if word is None:
            self._replace("has ended")
            return
        self._limit(None)
        if isinstance(word, Ready):
            worker.ready = True
            if not self._owes:
                self.trouble = None
            if self._asked is not None:
                self._limit(self._asked.deadline + GRACE)
            return
        request, self._asked = self._asked, None
        self._deaths, self._owes = 0, False
        if isinstance(word, str):
            LOG.error("a question was not answered", why=word)
            self.trouble = word
            if request is not None:
                self._listener.failed(request, word, False)
        elif request is not None:
            self.trouble = None
            self._listener.answered(request, word)

    def _replace(self, why: str) -> None:
        """Kill what is left of the process and start a new one, later each time it happens in a row."""
        self.close()
        pause = min(2.0**self._deaths, LONGEST_PAUSE) if self._deaths else 0.0
        self._deaths += 1
        LOG.warning("planner is replaced", why=why, pause=pause)
        self._timer = self._loop.call_later(pause, self._start)
        self.trouble = f"the planner {why} and is started again"
        if (request := self._asked) is not None:
            self._asked, self._owes = None, True
            # A way back is only told; a station whose planner it kills again and again would have no plans.
            self._listener.failed(request, self.trouble, not isinstance(request, WayBackRequest))
