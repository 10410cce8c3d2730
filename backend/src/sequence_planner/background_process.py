"""A process that does one thing, so that nobody who runs the station waits for it.

It computes at a low priority. Whoever ends it ends all that it has started.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from functools import partial
from importlib import import_module
from multiprocessing.connection import Connection, Pipe
from typing import Final

from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import start
from sequence_planner.storage.error import StorageError

_NICENESS: Final = 10  # below the station and what people wait for


class EndedEarlyError(Exception):
    """The process is gone, and has not told how it came out."""


async def carried_out(
    work: str, task: object, longest: float, tell: Callable[[object], None] = lambda _: None
) -> object:
    """What `work`, as in `package.module:function`, makes of `task` in a process; `tell` is called with what it tells.

    Raises the `StorageError` that it raises, `TimeoutError` after `longest` seconds, and `EndedEarlyError`.
    """
    ours, theirs = Pipe(duplex=False)
    with ours:
        module = work.partition(":")[0]
        given = partial(start, name=module, connection=theirs, modules=(module,), leads=True)
        process = await asyncio.shield(asyncio.to_thread(given, _work, work, task))
        try:
            async with asyncio.timeout(longest):
                while not (told := await _told(ours))[0]:
                    tell(told[1])
        except (EOFError, OSError) as error:
            if isinstance(error, TimeoutError):
                raise
            raise EndedEarlyError from None
        finally:
            await asyncio.shield(asyncio.to_thread(_end, process))
    if isinstance(told[1], StorageError):
        raise told[1]
    return told[1]


async def _told(connection: Connection) -> tuple[bool, object]:
    """Whether it is the last word, and what it says."""
    heard, loop = asyncio.Event(), asyncio.get_running_loop()
    loop.add_reader(connection.fileno(), heard.set)
    try:
        await heard.wait()
    finally:
        loop.remove_reader(connection.fileno())
    found: tuple[bool, object] = connection.recv()  # a few hundred bytes, all there at once
    return found


def _end(process: Child) -> None:
    process.kill()
    process.join()


def _work(connection: Connection, work: str, task: object) -> None:
    os.nice(_NICENESS)
    module, _, name = work.partition(":")
    function = getattr(import_module(module), name)  # the server does without what that imports
    try:
        connection.send((True, function(task, lambda step: connection.send((False, step)))))
    except StorageError as error:
        connection.send((True, error))
