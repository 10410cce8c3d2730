"""The analysis of a model in a process of its own that can be killed at any time, and whatever it has found by then.

An executor's process could not be: whoever leaves it waits until it is done, and one whose owner is killed lives on.
"""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import time
from collections.abc import AsyncIterator, Callable, Generator, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, Pipe
from typing import TYPE_CHECKING, Generic, TypeVar

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.forking.copying import Copy, can_be_copied
from sequence_planner.forking.starting import hang_up, start
from sequence_planner.process.memory_limit import LOOK, MemoryLimit, memory_limit

if TYPE_CHECKING:
    from sequence_planner.analysis.analysis import Analysis

# After ticks and the page, beside plans, and before all that is done in the background (10 and more): a station does
# nothing without its safe states. A command has no ticks, but a station may be at work on the same machine.
_NICENESS = 5

Word = TypeVar("Word")


class SynthesisEndedError(Exception):
    """The process ended without having found all; the text says what the reason may be."""


class TooLargeError(SynthesisEndedError):
    """There is not enough memory or time for this model: it would be the same once more."""


@dataclass(frozen=True)
class _Last:
    """The last word of the process: why there is no more, or None if that was all; it may be `too_large`."""

    why: str | None = None
    too_large: bool = False

    def end(self) -> None:
        """Raise `SynthesisEndedError` if that was not all."""
        if self.why is not None:
            raise TooLargeError(self.why) if self.too_large else SynthesisEndedError(self.why)


def analysing(automaton: Automaton) -> AbstractAsyncContextManager[AsyncIterator[Analysis]]:
    """Give what synthesis finds of `automaton`, each time more of it, see `telling`. Raises `MemoryLimitError`."""
    from sequence_planner.analysis.finding import analyses  # noqa: PLC0415

    return telling(memory_limit(), analyses, automaton)


@asynccontextmanager
async def telling(
    gigabytes: float, work: Callable[..., Iterator[Word]], *arguments: object
) -> AsyncIterator[AsyncIterator[Word]]:
    """Give what `work`, a function of a module, tells of its arguments until the block is left: then its process is
    killed.

    Iterating raises `SynthesisEndedError` when the process ends before it is done, or has more than so much memory.
    """
    ours, theirs = Pipe()
    limit = MemoryLimit(gigabytes)
    with ours:
        process = await asyncio.to_thread(start, _work, work, arguments, name="synthesis", connection=theirs)
        words: _Words[Word] = _Words(ours, limit)
        try:
            with limit.held(process):
                yield words.heard()
        finally:
            process.kill()
            process.join()
            hang_up(ours)
            await words.end()


def told(
    gigabytes: float, seconds: float, work: Callable[..., Iterator[Word]], *arguments: object
) -> Generator[Word, None, None]:
    """The same to a command, which waits for it.

    Raises `SynthesisEndedError`, and `TimeoutError` after so many seconds. The process ends with the iteration.
    """
    ours, theirs = Pipe()
    limit = MemoryLimit(gigabytes)
    end = time.monotonic() + seconds
    with ours:
        begin = Copy if can_be_copied() else start
        process = begin(_work, work, arguments, name="synthesis", connection=theirs)
        try:
            number, looked = process.pid, time.monotonic()
            while True:
                left = end - time.monotonic()
                if left <= 0:
                    raise TimeoutError
                if ours.poll(min(LOOK, left)):
                    word = _next(ours, limit)
                    if isinstance(word, _Last):
                        word.end()
                        return
                    yield word
                if number is not None and time.monotonic() - looked >= LOOK:
                    limit.look(process, number)
                    looked = time.monotonic()
        finally:
            process.kill()
            process.join()


def _next(connection: Connection, limit: MemoryLimit) -> Word | _Last:
    """Return what the process at the other end says next."""
    try:
        word: Word | _Last = connection.recv()
    except (EOFError, OSError):
        if limit.reached:
            return _Last(str(limit), too_large=True)
        return _Last("the process that computes the safe states has ended without an answer; is memory short?")
    return word


class _Words(Generic[Word]):
    """The words that the process says, heard by a thread so that nobody else waits."""

    def __init__(self, connection: Connection, limit: MemoryLimit) -> None:
        self._connection = connection
        self._limit = limit
        self._hearing: asyncio.Future[Word | _Last] | None = None

    async def heard(self) -> AsyncIterator[Word]:
        while True:
            self._hearing = asyncio.get_running_loop().run_in_executor(None, _next, self._connection, self._limit)
            word = await asyncio.shield(self._hearing)
            if isinstance(word, _Last):
                word.end()
                return
            yield word

    async def end(self) -> None:
        if self._hearing is not None:
            await asyncio.wait({self._hearing})  # at once, as nobody is left who could speak


def _work(connection: Connection, work: Callable[..., Iterator[object]], arguments: tuple[object, ...]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    os.nice(_NICENESS)
    gc.freeze()  # the model stays; what is made for one question must go with it
    try:
        for found in work(*arguments):
            connection.send(found)
        connection.send(_Last())
    except MemoryError:
        connection.send(
            _Last(
                "the sets of states have outgrown the memory set aside for them: let fewer or smaller variables bear "
                "on the specifications and on `rest`",
                too_large=True,
            )
        )
