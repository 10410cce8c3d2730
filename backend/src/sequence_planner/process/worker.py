"""Worker processes: request-response companions with non-blocking pipes."""

from __future__ import annotations

import asyncio
import contextlib
import signal
import tempfile
import threading
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from queue import SimpleQueue
from typing import Any, Generic, Protocol, TypeVar

import structlog

from sequence_planner.core.immutable import Immutable
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import hang_up, start
from sequence_planner.process.budget import Budget
from sequence_planner.process.task import WorkerError, begun

# Processes that stand by to answer: questions go in, answers come out, and nobody ever waits for the pipe.
#
# A process can stand still, or end in the middle of a word, at any time. So each companion has two threads on the
# asking side, one that writes and one that reads; whoever asks only leaves a question, and hears words from the reading
# thread. In the process itself a thread reads too, so that a question can be called off while it is worked on.

Model = TypeVar("Model")
Content = TypeVar("Content")
Answer = TypeVar("Answer")


class WorkerQuestion(Immutable, Generic[Content]):
    """Something to be worked on for at most so many seconds. Later questions have higher numbers."""

    number: int
    seconds: float
    content: Content


class CallOff(Immutable):
    """Nobody waits any more for an answer to the question of this number, nor to earlier ones."""

    number: int


class WorkerReady(Immutable):
    """From now on the process answers."""


class WorkerAnswered(Immutable, Generic[Answer]):
    """An answer to the question of this number; there can be several."""

    number: int
    content: Answer


class WorkerFinished(Immutable):
    """Work on the question of this number has ended; `trouble` says what it failed at, and the process ends then."""

    number: int
    trouble: str = ""


class Ended(Immutable):
    """The process has ended, or what came from it was no word; it is of no more use."""


# What comes from a companion.
Word = WorkerReady | WorkerAnswered[Any] | WorkerFinished | Ended


class Companion(Generic[Model, Content]):
    """One process that runs `serve`, which calls `stand_by`. `hear` is called with each word, in a thread of its own.

    Raises OSError when no process can be started.
    """

    def __init__(
        self,
        serve: Callable[[Connection], None],
        model: Model,
        hear: Callable[[Word], None],
        name: str,
    ) -> None:
        self._hear = hear
        self._words: SimpleQueue[Model | WorkerQuestion[Content] | CallOff | None] = SimpleQueue()
        self._words.put(model)
        self._connection, theirs = Pipe()
        self._process = start(serve, name=name, connection=theirs)
        self._threads = [threading.Thread(target=each, daemon=True, name=name) for each in (self._write, self._read)]
        for thread in self._threads:
            thread.start()

    def ask(self, question: WorkerQuestion[Content]) -> None:
        """Leave a question for it; returns at once."""
        self._words.put(question)

    def call_off(self, number: int) -> None:
        """Have the question of this number, and all before, given up; returns at once."""
        self._words.put(CallOff(number))

    def close(self) -> None:
        """End process and threads, whatever they are doing. Not from `hear`."""
        self._process.kill()
        self._process.join()
        self._words.put(None)
        hang_up(self._connection)
        for thread in self._threads:
            thread.join()
        self._connection.close()

    def _write(self) -> None:
        with contextlib.suppress(OSError):  # it has ended, which the reading thread hears
            while (word := self._words.get()) is not None:
                try:
                    self._connection.send(word)
                except OSError:
                    raise
                except Exception:  # without this word whoever asked would wait for ever
                    traceback.print_exc()
                    self._process.kill()
                    return

    def _read(self) -> None:
        with contextlib.suppress(Exception):  # whatever is wrong with what comes out of the pipe
            while True:
                self._hear(self._connection.recv())
        self._hear(Ended())


def stand_by(connection: Connection, prepare: Callable[[Any], Callable[[Any, Budget], Iterator[Any]]]) -> None:
    """Hear of a model, then answer one question after the other with what `prepare` makes of it; a process's life.

    It ends when the other end is closed, and after an error that nobody thought of: what it has learnt could be wrong.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    with contextlib.suppress(EOFError, ConnectionError):  # whoever asked is gone
        model = connection.recv()
        inbox = _Inbox(connection)
        answer = prepare(model)
        connection.send(WorkerReady())
        while (question := inbox.next()) is not None:
            budget = inbox.begin(question)
            try:
                for each in answer(question.content, budget):
                    connection.send(WorkerAnswered(question.number, each))
            except (ConnectionError, MemoryError):  # another process may have enough of it
                raise
            except Exception as error:
                traceback.print_exc()
                connection.send(WorkerFinished(question.number, f"{type(error).__name__}: {error}"))
                return
            connection.send(WorkerFinished(question.number))


class _Inbox:
    """The messages that a thread of the process has read."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._questions: SimpleQueue[WorkerQuestion[Any] | None] = SimpleQueue()
        self._lock = threading.Lock()
        self._under_way = (0, Budget.seconds(0.0))
        self._off = 0
        threading.Thread(target=self._read, daemon=True, name="inbox").start()

    def next(self) -> WorkerQuestion[Any] | None:
        """The next question, as soon as there is one; None when there will be no more."""
        return self._questions.get()

    def begin(self, question: WorkerQuestion[Any]) -> Budget:
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
                word: WorkerQuestion[Any] | CallOff = self._connection.recv()
                if isinstance(word, WorkerQuestion):
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


# A process that answers, as the controller sees it: one question at a time, a new one when it fails to answer.
#
# It begins with the first question, and ends when nobody has asked for some time: it is forked again in no time.
#
# The event loop never touches the pipe: a write or a read would wait for a process that stands still, and the ticks
# with it. The companion's threads do.

LOG = structlog.get_logger(__name__)

GRACE = 10.0  # seconds beyond the deadline of a request, for the answer's way; then the process is replaced
STARTING = 120.0  # seconds a process may take to start
LONGEST_PAUSE = 30.0  # seconds before a process that has died again and again is replaced
ANSWERER_RESTS_AFTER = 30.0  # seconds without a question, after which it ends until there is one


class LimitedRequest(Protocol):
    """A request that says how many seconds its answer may take."""

    @property
    def deadline(self) -> float:
        """So many seconds."""
        ...


Request = TypeVar("Request", bound=LimitedRequest)


@dataclass(frozen=True)
class Listener(Generic[Request, Answer]):
    """The one who hears of it, on the event loop: an answer, or why there is none and whether to ask the same again."""

    answered: Callable[[Request, Answer], None]
    failed: Callable[[Request, str, bool], None]


@dataclass(frozen=True)
class WorkerTask(Generic[Model, Request]):
    """The task of the process: it is called `name` and lives `serve`, beginning with `model`.

    A request over which it has died is asked `again` where that is said, and the next one begins with `cautious`, if
    that is another model.
    """

    name: str
    serve: Callable[[Connection], None]
    model: Model
    again: Callable[[Request], bool]
    cautious: Model | None = None


class AnsweringWorker(Generic[Model, Request, Answer]):
    """Asks another process. Used from one event loop."""

    def __init__(
        self, work: WorkerTask[Model, Request], loop: asyncio.AbstractEventLoop, listener: Listener[Request, Answer]
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
        """True if a question is out, or there can be no process to be asked yet."""
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
            self._companion.ask(WorkerQuestion(self._number, request.deadline, request))
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
        self._timer = self._loop.call_later(ANSWERER_RESTS_AFTER, self._rest)

    def _tell(self, generation: int, word: Word) -> None:
        """In the thread that reads."""
        with contextlib.suppress(RuntimeError):  # the loop has been closed: nobody listens any more
            self._loop.call_soon_threadsafe(self._hear, generation, word)

    def _hear(self, generation: int, word: Word) -> None:
        if generation != self._generation:
            return
        match word:
            case WorkerReady():
                self._ready = True
                if not self._owes:
                    self.trouble = None
                if self._asked is None:
                    self._limit_to_rest()
                else:
                    self._limit(self._asked.deadline + GRACE)
            case WorkerAnswered(number, content) if number == self._number:
                self._limit_to_rest()
                self._take(content)
            case WorkerFinished(number, trouble) if number == self._number:
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


# A process that answers whoever waits, one question after the other.
#
# What it does is named and not handed over, since the server does without what that imports.

RESTS_AFTER = 60.0  # seconds without a question, after which a process that answers ends until there is one
_ANSWERING = 5  # niceness: ticks come first, then whoever waits for an answer, then checks
_PREFIX = "sequence-planner-workshop-"  # of folders
_NO_ANSWER = "the process has ended without an answer; is memory short?"


class Answering:
    """A process that answers one question after the other; it is started with the first of them, and ends when nobody
    asks for long. `name` is a function of a module that is called with a connection and the path of an
    empty folder. Used from one event loop.
    """

    def __init__(self, module: str, name: str) -> None:
        self._what = module, name
        self._turn = asyncio.Lock()
        self._kept: tuple[Child, Connection, tempfile.TemporaryDirectory[str]] | None = None
        self._resting: asyncio.Task[None] | None = None

    @property
    def begun(self) -> bool:
        """True if it lives, and knows what it was told before."""
        return self._kept is not None

    async def ask(self, question: Callable[[], object], patience: float) -> object:
        """The answer to what `question` says when its turn has come, within so many seconds from then on.

        Raises `WorkerError` when there is none; the process begins anew with the next question then.
        """
        self._rest_no_more()
        async with self._turn:
            try:
                async with asyncio.timeout(patience):
                    asked = question()
                    if self._kept is None:
                        self._kept = await self._start()
                    connection = self._kept[1]
                    await asyncio.to_thread(connection.send, asked)
                    return await _told(connection)
            except TimeoutError:
                await self._end()
                raise WorkerError(f"there was no answer within {patience:g} s") from None
            except OSError:
                await self._end()
                raise WorkerError(_NO_ANSWER) from None
            except BaseException:
                await self._end()  # its answer would be taken for that to the next question
                raise
            finally:
                self._rest_no_more()
                self._resting = asyncio.create_task(self._rest())

    async def close(self) -> None:
        """End the process."""
        self._rest_no_more()
        async with self._turn:
            await self._end()

    async def _rest(self) -> None:
        """End the process when nobody has asked for long."""
        await asyncio.sleep(RESTS_AFTER)
        async with self._turn:
            self._resting = None  # it is not to be cut short, and nobody has asked before it had its turn
            await self._end()

    def _rest_no_more(self) -> None:
        if self._resting is not None:
            self._resting.cancel()
            self._resting = None

    async def _start(self) -> tuple[Child, Connection, tempfile.TemporaryDirectory[str]]:
        starting = asyncio.create_task(asyncio.to_thread(self._started))
        try:
            return await asyncio.shield(starting)
        except asyncio.CancelledError:
            self._kept = await starting  # so that it is ended
            raise

    def _started(self) -> tuple[Child, Connection, tempfile.TemporaryDirectory[str]]:
        module, name = self._what
        folder = tempfile.TemporaryDirectory(prefix=_PREFIX)
        ours, theirs = Pipe()
        given = (module, name, Path(folder.name))
        process = start(_answer, *given, name=module.rpartition(".")[2], connection=theirs, modules=given[:1])
        return process, ours, folder

    async def _end(self) -> None:
        if self._kept is not None:
            (process, connection, folder), self._kept = self._kept, None
            process.kill()
            try:
                await asyncio.shield(asyncio.to_thread(process.join))
            finally:
                connection.close()
                folder.cleanup()


async def _told(connection: Connection) -> object:
    heard, loop = asyncio.Event(), asyncio.get_running_loop()
    loop.add_reader(connection.fileno(), heard.set)
    try:
        await heard.wait()
    finally:
        loop.remove_reader(connection.fileno())
    try:
        return await asyncio.to_thread(connection.recv)
    except (EOFError, OSError):
        raise WorkerError(_NO_ANSWER) from None


def _answer(connection: Connection, module: str, name: str, folder: Path) -> None:
    begun(f"{module}:{name}", _ANSWERING)(connection, folder)
