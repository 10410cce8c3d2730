"""Processes of the workshop, each for one piece of work: it can be killed at any time, and disturbs no tick.

They are forked from one that has imported all that they need, so that they begin at once. What they do is named and not
handed over, since the server does without what that imports.
"""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import multiprocessing
import os
import signal
import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from multiprocessing.connection import Connection
from pathlib import Path

from sequence_planner.lifeline import end_without_parent

_CONTEXT = multiprocessing.get_context("forkserver")
_CONTEXT.set_forkserver_preload(["sequence_planner.workshop.checking", "sequence_planner.workshop.tasks"])
_NICENESS = 5  # ticks come first


class WorkEndedError(Exception):
    """The process ended before its work was done."""


@asynccontextmanager
async def working(module: str, name: str, *arguments: object) -> AsyncIterator[AsyncIterator[object]]:
    """What the generator `name` of a module of this room tells, until the block is left: then its process is killed.

    It is called with `arguments` and the path of an empty folder. Iterating raises `WorkEndedError` when the process
    ends too early.
    """
    with tempfile.TemporaryDirectory(prefix="sequence-planner-workshop-") as folder:
        ours, theirs = _CONTEXT.Pipe(duplex=False)
        with ours:
            given = (theirs, f"{__package__}.{module}", name, arguments, Path(folder))
            process = _CONTEXT.Process(target=_work, args=given, daemon=True, name=name)
            with theirs:
                await asyncio.to_thread(process.start)
            try:
                yield _heard(ours)
            finally:
                process.kill()
                await asyncio.shield(asyncio.to_thread(process.join))


async def _heard(connection: Connection) -> AsyncIterator[object]:
    loop = asyncio.get_running_loop()
    while True:
        heard = asyncio.Event()
        loop.add_reader(connection.fileno(), heard.set)
        try:
            await heard.wait()
        finally:
            loop.remove_reader(connection.fileno())
        try:
            yield await asyncio.to_thread(connection.recv)
        except (EOFError, OSError):
            raise WorkEndedError("the process has ended without an answer; is memory short?") from None


def _work(connection: Connection, module: str, name: str, arguments: tuple[object, ...], folder: Path) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    end_without_parent()
    os.nice(_NICENESS)
    with contextlib.suppress(OSError):
        for each in getattr(importlib.import_module(module), name)(*arguments, folder):
            connection.send(each)
