"""Processes that stand by to answer: questions go in, answers come out, and nobody ever waits for the pipe.

A process can stand still, or end in the middle of a word, at any time. So each companion has two threads on the asking
side, one that writes and one that reads; whoever asks only leaves a question, and hears words from the reading thread.
In the process itself a thread reads too, so that a question can be called off while it is worked on.
"""

from __future__ import annotations

import contextlib
import signal
import threading
import traceback
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection, Pipe
from queue import SimpleQueue
from typing import Any, Generic, TypeVar

from sequence_planner.forking.starting import hang_up, start
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget

Model = TypeVar("Model")
Content = TypeVar("Content")
Answer = TypeVar("Answer")


class Question(Immutable, Generic[Content]):
    """Something to be worked on for at most so many seconds. Later questions have higher numbers."""

    number: int
    seconds: float
    content: Content


class CallOff(Immutable):
    """Nobody waits any more for an answer to the question of this number, nor to earlier ones."""

    number: int


class Ready(Immutable):
    """From now on the process answers."""


class Answered(Immutable, Generic[Answer]):
    """An answer to the question of this number; there can be several."""

    number: int
    content: Answer


class Finished(Immutable):
    """Work on the question of this number has ended; `trouble` says what it failed at, and the process ends then."""

    number: int
    trouble: str = ""


class Ended(Immutable):
    """The process has ended, or what came from it was no word; it is of no more use."""


# What comes from a companion.
Word = Ready | Answered[Any] | Finished | Ended


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
        self._words: SimpleQueue[Model | Question[Content] | CallOff | None] = SimpleQueue()
        self._words.put(model)
        self._connection, theirs = Pipe()
        self._process = start(serve, name=name, connection=theirs)
        self._threads = [threading.Thread(target=each, daemon=True, name=name) for each in (self._write, self._read)]
        for thread in self._threads:
            thread.start()

    def ask(self, question: Question[Content]) -> None:
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
        connection.send(Ready())
        while (question := inbox.next()) is not None:
            budget = inbox.begin(question)
            try:
                for each in answer(question.content, budget):
                    connection.send(Answered(question.number, each))
            except (ConnectionError, MemoryError):  # another process may have enough of it
                raise
            except Exception as error:
                traceback.print_exc()
                connection.send(Finished(question.number, f"{type(error).__name__}: {error}"))
                return
            connection.send(Finished(question.number))


class _Inbox:
    """What a thread of the process has read."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._questions: SimpleQueue[Question[Any] | None] = SimpleQueue()
        self._lock = threading.Lock()
        self._under_way = (0, Budget.seconds(0.0))
        self._off = 0
        threading.Thread(target=self._read, daemon=True, name="inbox").start()

    def next(self) -> Question[Any] | None:
        """The next question, as soon as there is one; None when there will be no more."""
        return self._questions.get()

    def begin(self, question: Question[Any]) -> Budget:
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
                word: Question[Any] | CallOff = self._connection.recv()
                if isinstance(word, Question):
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
