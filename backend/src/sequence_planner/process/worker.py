"""A process that is asked one thing after the other, each within a time, and has another one in its place if it fails.

A process can stand still, or end in the middle of a word, at any time. So each has two threads on the asking side, one
that writes and one that reads, and nobody ever waits for a pipe: neither whoever asks nor the event loop. In the
process itself a thread reads too, so that a question can be called off while it is worked on.
"""

from __future__ import annotations

import asyncio
import contextlib
import tempfile
import threading
import traceback
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from queue import SimpleQueue
from typing import Any, Final, Generic, TypeVar

from sequence_planner.core.late_log import LateLog
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import hang_up, start
from sequence_planner.process.budget import Budget
from sequence_planner.process.task import WorkerError, begun, module_of

LOG = LateLog(__name__)

LATE = 10.0  # seconds beyond the time of a question, for the answer's way; then the process is replaced
STARTING = 120.0  # seconds a process may take to start
LONGEST_PAUSE = 30.0  # seconds before a process that has died again and again is replaced
RESTS_AFTER = 30.0  # seconds without a question, after which it ends until there is one

Request = TypeVar("Request")
Answer = TypeVar("Answer")
Result = TypeVar("Result")
FOLDER: Final = object()  # a model that is the path of an empty folder, which each process has for itself

# What makes of a model the function that answers: with an answer, or with several one after the other.
Prepare = Callable[[Any], Callable[[Request, Budget], Answer | Iterator[Answer]]]


class WorkerLateError(WorkerError):
    """There is no answer in time."""


class Worker(Generic[Request, Answer]):
    """Asks a process called `name`, which lives by what `prepare` makes of `model`. Used from one event loop.

    `prepare` is a function of a module or its name, as of a `BackgroundTask`. The process begins with a question, and
    ends when nobody has one for `rests_after` seconds, when it has not answered `late` seconds after the time of a
    question, or has not come back so long after one was called off. One that is `kept` begins again at once when it has
    ended otherwise, later each time it happens in a row, and with the `cautious` model if that was over a question. It
    may take `starting` seconds to begin; where that is None, that counts as time of the question.
    """

    def __init__(
        self,
        prepare: Prepare[Request, Answer] | str,
        model: object,
        name: str,
        *,
        cautious: object = None,
        niceness: int = 0,
        errors: tuple[type[Exception], ...] = (),
        late: float = LATE,
        starting: float | None = STARTING,
        rests_after: float | None = None,
        kept: bool = True,
    ) -> None:
        self.name = name
        self.trouble: str | None = None
        self.replaced = 0  # how often
        self._life = partial(_Process, prepare, name, niceness, errors)
        self._model, self._cautious = model, model if cautious is None else cautious
        self._late, self._starting, self._kept = late, starting, kept
        self._rests_after = RESTS_AFTER if rests_after is None else rests_after
        self._turn = asyncio.Lock()
        self._asked: _Asked[Answer] | None = None
        self._number = self._back = 0  # of the last question, and of the last one that the process is done with
        self._process: _Process | None = None
        self._generation = 0  # of the process; what earlier ones say counts no more
        self._ready = False
        self._timer: asyncio.TimerHandle | None = None
        self._deaths = 0  # since the last answer
        self._owes = False  # it has died over a question since
        self._leaving: set[threading.Thread] = set()  # each ends a process
        self._closed = False

    @property
    def begun(self) -> bool:
        """True if there is a process, which knows what it was told before."""
        return self._process is not None

    @property
    def away(self) -> bool:
        """True if there can be no process to be asked yet."""
        return self._process is None and self._timer is not None

    async def ask(
        self, request: Request, seconds: float, hear: Callable[[Answer], object] = lambda answer: None
    ) -> Answer:
        """Return the answer, the last if there are several, which is worked on for at most so many seconds once its
        turn has come; `hear` is called with each. Whoever is cancelled calls it off.

        Raises `WorkerError`, and the errors that the process may raise.
        """
        async with self._turn:
            if self.away or self._closed:
                raise WorkerError(self.trouble or f"the {self.name} is not asked any more", again=True)
            self.begin()
            assert self._process is not None
            self._number += 1
            answer: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
            self._asked = _Asked(self._number, seconds, hear, answer)
            self._process.post(_Question(self._number, seconds, request))
            if self._back == self._number - 1 and (self._ready or self._starting is None):
                self._watch()
            try:
                return await answer
            finally:
                self._asked = None
                if answer.cancelled():
                    self._call_off()

    def begin(self) -> None:
        """Begin the process, as it will be asked soon. It rests again where it is not."""
        if self._process is None and not self.away:
            self._start()

    def close(self) -> None:
        """End the process, whatever it does, for ever."""
        self._closed = True
        self._end("is not asked any more")
        for thread in self._leaving:
            thread.join()
        self._leaving.clear()

    def _call_off(self) -> None:
        """Nobody waits for an answer to the last question any more; the next may be asked at once."""
        if self._process is None or self._back == self._number:
            return
        if not self._late:
            self._end("was given up")
            return
        self._process.post(_CallOff(self._number))
        if self._ready and self._back == self._number - 1:
            self._watch()

    def _start(self) -> None:
        self._timer = None
        hear = partial(self._tell, asyncio.get_running_loop(), self._generation)
        self._process = self._life(self._cautious if self._owes else self._model, hear)
        if self._starting is not None:
            self._limit(self._starting, self._silent)

    def _end(self, why: str) -> None:
        """End the process, which nobody hears any more; nobody waits until it has ended."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        self._generation += 1
        self._back = self._number
        process, self._process, self._ready = self._process, None, False
        self._leaving = {each for each in self._leaving if each.is_alive()}
        if process is not None:
            leaving = threading.Thread(target=process.close, daemon=True, name=self.name)
            leaving.start()
            self._leaving.add(leaving)
        self._fail(WorkerError(f"the {self.name} {why}"))

    def _watch(self) -> None:
        """Limit the time for what is worked on, or let it rest."""
        if self._back == self._number:
            self._limit(self._rests_after, lambda: self._end("rests"))
        elif self._asked is None:
            self._limit(self._late, self._silent)
        else:
            self._limit(self._asked.seconds + self._late, self._silent)

    def _limit(self, seconds: float, act: Callable[[], None]) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._timer = asyncio.get_running_loop().call_later(seconds, act)

    def _silent(self) -> None:
        self._died("was silent too long", WorkerLateError)

    def _tell(self, loop: asyncio.AbstractEventLoop, generation: int, word: _Word) -> None:
        """In the thread that reads."""
        with contextlib.suppress(RuntimeError):  # the loop has been closed: nobody listens any more
            loop.call_soon_threadsafe(self._hear, generation, word)

    def _hear(self, generation: int, word: _Word) -> None:
        if generation != self._generation:
            return
        match word:
            case _Ready():
                self._ready = True
                if not self._owes:
                    self.trouble = None
                if self._starting is not None:
                    self._watch()
            case _Answer(number, content):
                if self._asked is not None and self._asked.number == number:
                    self._asked.last = content
                    self._asked.hear(content)
            case _Done(number, error):
                self._back, self._deaths, self._owes = number, 0, False
                if isinstance(error, str):
                    LOG.error("a question was not answered", process=self.name, why=error)
                    if self._asked is None or self._asked.number == number:
                        self._replace(WorkerError(f"the {self.name} failed ({error})"), "has ended")
                    else:
                        self._died("has ended")
                    return
                self._watch()
                if self._asked is not None and self._asked.number == number:
                    self.trouble = None if error is None else str(error)
                    if error is None:
                        self._asked.succeed()
                    else:
                        self._fail(error)
            case _Ended(why):
                self._died(why)

    def _fail(self, error: Exception) -> None:
        if self._asked is not None and not self._asked.answer.done():
            self._asked.answer.set_exception(error)

    def _died(self, why: str, error: type[WorkerError] = WorkerError) -> None:
        self._owes = self._owes or (self._asked is not None and not self._asked.answer.done())
        self._replace(error(f"the {self.name} {why} and is started again", again=True), why)

    def _replace(self, error: WorkerError, why: str) -> None:
        """End what is left of the process; another one begins, later each time it happens in a row."""
        self.trouble = str(error)
        self._fail(error)
        self._end(why)
        pause = min(2.0**self._deaths, LONGEST_PAUSE) if self._deaths else 0.0
        LOG.warning("a process is replaced", process=self.name, why=why, pause=pause)
        self.replaced += 1
        if self._kept:
            self._deaths += 1
            self._limit(pause, self._start)


@dataclass
class _Asked(Generic[Answer]):
    """A question that somebody waits for."""

    number: int
    seconds: float
    hear: Callable[[Answer], object]
    answer: asyncio.Future[Answer]
    last: Answer | None = None

    def succeed(self) -> None:
        if not self.answer.done():
            self.answer.set_result(self.last)  # type: ignore[arg-type]  # which may be an answer


class WorkerLoop:
    """The event loop of workers in a thread, for who has none and waits for answers. To be closed."""

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True, name="workers")
        self._thread.start()

    def submit(self, asking: Coroutine[Any, Any, Result]) -> Future[Result]:
        """Have it done there; whoever cancels it calls it off."""
        return asyncio.run_coroutine_threadsafe(asking, self._loop)

    def begin(self, worker: Worker[Any, Any]) -> None:
        """Begin a process, as it will be asked soon."""
        self._loop.call_soon_threadsafe(worker.begin)

    def close(self, *workers: Worker[Any, Any]) -> None:
        """End the processes, and the thread."""

        async def close() -> None:
            for each in workers:
                each.close()
            await asyncio.gather(*(asyncio.all_tasks() - {asyncio.current_task()}), return_exceptions=True)

        self.submit(close()).result()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()


# What goes to the process, after its model, and what comes back.


@dataclass(frozen=True)
class _Question:
    """Something to be worked on for at most so many seconds. Later questions have higher numbers."""

    number: int
    seconds: float
    content: Any


@dataclass(frozen=True)
class _CallOff:
    """Nobody waits any more for an answer to the question of this number, nor to earlier ones."""

    number: int


@dataclass(frozen=True)
class _Ready:
    """From now on the process answers."""


@dataclass(frozen=True)
class _Answer:
    """An answer to the question of this number; there can be several."""

    number: int
    content: Any


@dataclass(frozen=True)
class _Done:
    """Work on the question of this number has ended, with an `error` that may be, or one that nobody thought of."""

    number: int
    error: Exception | str | None = None


@dataclass(frozen=True)
class _Ended:
    """The process is of no more use: it has ended, or cannot be started, or what came from it was no word."""

    why: str = "has ended"


_Word = _Ready | _Answer | _Done | _Ended


class _Process:
    """One process, and the threads that write to it and read; `hear` is called there with each word."""

    def __init__(
        self,
        prepare: Prepare[Any, Any] | str,
        name: str,
        niceness: int,
        errors: tuple[type[Exception], ...],
        model: object,
        hear: Callable[[_Word], None],
    ) -> None:
        self._hear = hear
        self._model = model
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._words: SimpleQueue[object] = SimpleQueue()
        self._connection, theirs = Pipe()
        modules = (module_of(prepare),)
        forking = partial(start, _live, prepare, niceness, errors, name=name, connection=theirs, modules=modules)
        self._child: Child | None = None
        self._writer = threading.Thread(target=self._write, args=(forking,), daemon=True, name=name)
        self._reader = threading.Thread(target=self._read, daemon=True, name=name)
        self._writer.start()

    def post(self, word: _Question | _CallOff) -> None:
        """Leave it for the process; returns at once."""
        self._words.put(word)

    def close(self) -> None:
        """End process and threads, whatever they are doing. Not from `hear`."""
        self._words.put(None)
        if self._child is not None:
            self._child.kill()
        hang_up(self._connection)
        self._writer.join()
        if self._child is not None:
            self._child.kill()  # it may have begun only now
            self._child.join()
            self._reader.join()
        self._connection.close()
        if self._folder is not None:
            self._folder.cleanup()

    def _write(self, forking: Callable[[], Child]) -> None:
        try:
            if self._model is FOLDER:
                self._folder = tempfile.TemporaryDirectory(prefix="sequence-planner-")
                self._model = Path(self._folder.name)
            self._child = forking()
        except OSError as error:
            self._hear(_Ended(f"cannot be started ({error})"))
            return
        self._reader.start()
        try:
            self._connection.send(self._model)
            while (word := self._words.get()) is not None:
                self._connection.send(word)
        except OSError:  # it has ended, which the reading thread hears
            return
        except Exception:  # without this word whoever asked would wait for ever
            traceback.print_exc()
            self._child.kill()

    def _read(self) -> None:
        with contextlib.suppress(Exception):  # whatever is wrong with what comes out of the pipe
            while True:
                self._hear(self._connection.recv())
        self._hear(_Ended())


# The life of the process.


def _live(
    connection: Connection, prepare: Prepare[Any, Any] | str, niceness: int, errors: tuple[type[Exception], ...]
) -> None:
    """Hear of a model, then answer one question after the other with what `prepare` makes of it.

    It ends when the other end is closed, and after an error that nobody thought of: what it has learnt could be wrong.
    """
    preparing = begun(prepare, niceness)
    with contextlib.suppress(EOFError, ConnectionError):  # whoever asked is gone
        model = connection.recv()
        inbox = _Inbox(connection)
        answer = preparing(model)
        connection.send(_Ready())
        while (question := inbox.next()) is not None:
            budget = inbox.begin(question)
            try:
                found = answer(question.content, budget)
                for each in found if isinstance(found, Iterator) else (found,):
                    connection.send(_Answer(question.number, each))
            except errors as error:
                connection.send(_Done(question.number, error))
            except (ConnectionError, MemoryError):  # another process may have enough of it
                raise
            except Exception as error:
                traceback.print_exc()
                connection.send(_Done(question.number, f"{type(error).__name__}: {error}"))
                return
            else:
                connection.send(_Done(question.number))


class _Inbox:
    """The messages that a thread of the process has read."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._questions: SimpleQueue[_Question | None] = SimpleQueue()
        self._lock = threading.Lock()
        self._under_way = (0, Budget.seconds(0.0))
        self._off = 0
        threading.Thread(target=self._read, daemon=True, name="inbox").start()

    def next(self) -> _Question | None:
        """The next question, as soon as there is one; None when there will be no more."""
        return self._questions.get()

    def begin(self, question: _Question) -> Budget:
        """The time for a question runs from when work on it begins."""
        budget = Budget.seconds(question.seconds)
        with self._lock:
            self._under_way = (question.number, budget)
            off = self._off >= question.number
        if off:
            budget.call_off()
        return budget

    def _read(self) -> None:
        with contextlib.suppress(EOFError, OSError):
            while True:
                word: _Question | _CallOff = self._connection.recv()
                if isinstance(word, _Question):
                    self._questions.put(word)
                else:
                    self._call_off(word.number)
        self._questions.put(None)
        self._call_off(self._under_way[0])

    def _call_off(self, number: int) -> None:
        with self._lock:
            self._off = number
            under_way, budget = self._under_way
        if under_way <= number:
            budget.call_off()
