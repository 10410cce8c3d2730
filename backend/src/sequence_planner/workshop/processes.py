"""Processes of the workshop, each for one piece of work: it can be killed at any time, and disturbs no tick.

What they do is named and not handed over, since the server does without what that imports.
"""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import os
import signal
import tempfile
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Any

from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import start
from sequence_planner.memory_limit import MemoryLimit, memory_limit

PATIENCE = 60.0  # seconds for a task
RESTS_AFTER = 60.0  # seconds without a question, after which a process that answers ends until there is one
_ANSWERING, _WORKING = 5, 15  # niceness: ticks come first, then whoever waits for an answer, then checks
_PREFIX = "sequence-planner-workshop-"  # of folders
_NO_ANSWER = "the process has ended without an answer; is memory short?"


class WorkEndedError(Exception):
    """The process ended before its work was done."""


@asynccontextmanager
async def working(module: str, name: str, *arguments: object) -> AsyncIterator[AsyncIterator[object]]:
    """What the generator `name` of a module of this room tells, until the block is left: then its process is killed.

    It is called with `arguments` and the path of an empty folder. Iterating raises `WorkEndedError` when the process
    ends too early, as it does when it takes more memory than there is for it.
    """
    limit = MemoryLimit(memory_limit())
    with tempfile.TemporaryDirectory(prefix=_PREFIX) as folder:
        ours, theirs = Pipe(duplex=False)
        with ours:
            given = (f"{__package__}.{module}", name, arguments, Path(folder))
            process = await asyncio.to_thread(start, _work, *given, name=name, connection=theirs, modules=given[:1])
            try:
                with limit.held(process):
                    yield _heard(ours, limit)
            finally:
                process.kill()
                await asyncio.shield(asyncio.to_thread(process.join))


async def worked(name: str, *arguments: object, patience: float = PATIENCE) -> object:
    """What the task `name` of `tasks` finds within so many seconds. Raises `WorkEndedError`."""
    try:
        async with asyncio.timeout(patience), working("tasks", name, *arguments) as found:
            async for each in found:
                return each
    except TimeoutError:
        raise WorkEndedError(f"it took more than {patience:g} s and was given up") from None
    raise WorkEndedError(_NO_ANSWER)


class Answering:
    """A process that answers one question after the other; it is started with the first of them, and ends when nobody
    asks for long. `name` is a function of a module of this room that is called with a connection and the path of an
    empty folder. Used from one event loop.
    """

    def __init__(self, module: str, name: str) -> None:
        self._what = module, name
        self._turn = asyncio.Lock()
        self._kept: tuple[Child, Connection, tempfile.TemporaryDirectory[str]] | None = None
        self._resting: asyncio.Task[None] | None = None

    @property
    def begun(self) -> bool:
        """Whether it lives, and knows what it was told before."""
        return self._kept is not None

    async def ask(self, question: Callable[[], object], patience: float) -> object:
        """The answer to what `question` says when its turn has come, within so many seconds from then on.

        Raises `WorkEndedError` when there is none; the process begins anew with the next question then.
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
                raise WorkEndedError(f"there was no answer within {patience:g} s") from None
            except OSError:
                await self._end()
                raise WorkEndedError(_NO_ANSWER) from None
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
        given = (f"{__package__}.{module}", name, Path(folder.name))
        process = start(_answer, *given, name=module, connection=theirs, modules=given[:1])
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


async def _heard(connection: Connection, limit: MemoryLimit) -> AsyncIterator[object]:
    while True:
        try:
            word = await _told(connection)
        except WorkEndedError:
            if limit.reached:
                raise WorkEndedError(str(limit)) from None
            raise
        yield word


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
        raise WorkEndedError(_NO_ANSWER) from None


def _work(connection: Connection, module: str, name: str, arguments: tuple[object, ...], folder: Path) -> None:
    work = _begun(module, name, _WORKING)
    with contextlib.suppress(OSError):
        for each in work(*arguments, folder):
            connection.send(each)


def _answer(connection: Connection, module: str, name: str, folder: Path) -> None:
    _begun(module, name, _ANSWERING)(connection, folder)


def _begun(module: str, name: str, niceness: int) -> Callable[..., Any]:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    os.nice(niceness)
    found: Callable[..., Any] = getattr(importlib.import_module(module), name)
    return found
