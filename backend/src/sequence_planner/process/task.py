"""One piece of work in a process of its own: what it finds is told piece by piece, and it can be killed at any time.

An executor's process could not be: whoever leaves it waits until it is done, and one whose owner is killed lives on.
"""

from __future__ import annotations

import asyncio
import importlib
import os
import signal
import time
from collections.abc import AsyncIterator, Callable, Generator, Iterator
from contextlib import AbstractContextManager, asynccontextmanager, nullcontext
from dataclasses import dataclass
from multiprocessing.connection import Connection, Pipe
from typing import Any, Final, Generic, TypeVar

from sequence_planner.forking.child import Child
from sequence_planner.forking.copying import Copy, can_be_copied
from sequence_planner.forking.starting import start
from sequence_planner.process.memory_limit import LOOK, MemoryLimit
from sequence_planner.texts.message import message

Found = TypeVar("Found")
NO_ANSWER: Final = message("work.no-answer")


class WorkerError(Exception):
    """A process has ended, or was late, and has not done what it was asked for; the text says why.

    It may be asked `again` where that is no fault of what it was asked.
    """

    def __init__(self, why: str, *, again: bool = False) -> None:
        super().__init__(why)
        self.why = why
        self.again = again


class TooLargeError(WorkerError):
    """There is not enough memory or time for it: it would be the same once more."""


@dataclass(frozen=True)
class BackgroundTask(Generic[Found]):
    """Work for a process called `name`, which ends when nobody waits for it any more.

    `work` is a function of a module, or the name of one as in `package.module:function`, where whoever has it done does
    without what that imports. All that a generator yields is told. One that `reports` is called with a function that
    tells, behind its `arguments`. Its `errors` are raised here; `WorkerError` when it ends otherwise, or has more
    memory than so many `gigabytes`. One that `leads` ends with all that it has started.
    """

    work: Callable[..., Iterator[Found] | Found] | str
    arguments: tuple[object, ...]
    name: str
    niceness: int
    gigabytes: float | None = None
    errors: tuple[type[Exception], ...] = ()
    reports: bool = False
    leads: bool = False

    @asynccontextmanager
    async def telling(self) -> AsyncIterator[AsyncIterator[Found]]:
        """Give what it tells, until the block is left: then its process is killed."""
        ours, theirs = Pipe(duplex=False)
        limit = None if self.gigabytes is None else MemoryLimit(self.gigabytes)
        with ours:
            process = await asyncio.to_thread(self._forked, theirs)
            held: AbstractContextManager[None] = nullcontext() if limit is None else limit.held(process)
            try:
                with held:
                    yield self._heard(ours, limit)
            finally:
                process.kill()
                await asyncio.shield(asyncio.to_thread(process.join))

    async def found(self, hear: Callable[[Found], object] = lambda each: None) -> Found:
        """Return the last that it tells; `hear` is called with each."""
        async with self.telling() as telling:
            async for last in telling:
                hear(last)
        return last

    def told(self, seconds: float) -> Generator[Found, None, None]:
        """Give what it tells to a command, which waits for it. Raises `TimeoutError` after so many seconds."""
        ours, theirs = Pipe(duplex=False)
        limit = None if self.gigabytes is None else MemoryLimit(self.gigabytes)
        end = time.monotonic() + seconds
        with ours:
            process: Child | Copy
            if can_be_copied():
                process = Copy(_carry_out, self, name=self.name, connection=theirs)
            else:
                process = self._forked(theirs)
            try:
                number, looked = process.pid, time.monotonic()
                while True:
                    left = end - time.monotonic()
                    if left <= 0:
                        raise TimeoutError
                    if ours.poll(min(LOOK, left)):
                        is_last, content = _next(ours, limit)
                        if is_last:
                            return
                        yield content
                    if limit is not None and number is not None and time.monotonic() - looked >= LOOK:
                        limit.look(process, number)
                        looked = time.monotonic()
            finally:
                process.kill()
                process.join()

    def _forked(self, connection: Connection) -> Child:
        modules = (module_of(self.work),)
        return start(_carry_out, self, name=self.name, connection=connection, modules=modules, leads=self.leads)

    async def _heard(self, connection: Connection, limit: MemoryLimit | None) -> AsyncIterator[Found]:
        heard, loop = asyncio.Event(), asyncio.get_running_loop()
        while True:
            heard.clear()
            loop.add_reader(connection.fileno(), heard.set)
            try:
                await heard.wait()
            finally:
                loop.remove_reader(connection.fileno())
            is_last, content = await asyncio.to_thread(_next, connection, limit)
            if is_last:
                return
            yield content


def _next(connection: Connection, limit: MemoryLimit | None) -> tuple[bool, Any]:
    """Return what comes next, and whether nothing more does. Raises the error with which it has ended."""
    try:
        is_last, content = connection.recv()
    except (EOFError, OSError):
        if limit is not None and limit.reached:
            raise TooLargeError(limit.exceeded) from None
        raise WorkerError(NO_ANSWER) from None
    if isinstance(content, Exception) and is_last:
        raise content
    return is_last, content


def _carry_out(connection: Connection, task: BackgroundTask[Any]) -> None:
    function = begun(task.work, task.niceness)

    def tell(found: object, is_last: bool = False) -> None:
        connection.send((is_last, found))

    try:
        found = function(*task.arguments, *((tell,) if task.reports else ()))
        for each in found if isinstance(found, Iterator) else (found,):
            tell(each)
        tell(None, is_last=True)
    except task.errors as error:
        tell(error, is_last=True)


def module_of(function: Callable[..., Any] | str) -> str:
    """Return where a function is that may be named: what it imports is imported once for all processes."""
    return function.partition(":")[0] if isinstance(function, str) else function.__module__


def begun(function: Callable[..., Any] | str, niceness: int) -> Callable[..., Any]:
    """Let this process, which others end, give way to them by so much; returns the function, which may be named."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(niceness)
    if not isinstance(function, str):
        return function
    module, _, name = function.partition(":")
    found: Callable[..., Any] = getattr(importlib.import_module(module), name)
    return found
