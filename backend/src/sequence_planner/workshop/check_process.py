"""Checks of the draft in processes of their own, each of which can be killed: by then the draft is another one.

They are forked from one that has imported all that a check needs, so that what is wrong is said soon after it was
written.
"""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import os
import signal
import tempfile
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerProcess
from pathlib import Path

from sequence_planner.lifeline import end_without_parent
from sequence_planner.workshop.check_view import CheckState, CheckView, waiting
from sequence_planner.workshop.files import Files

SETTLED = 0.15  # seconds without a change after which a check begins
_NICENESS = 5  # ticks come first


class CheckDesk:
    """Checks what it is told to, from one event loop; `stages` is the model whose Python stages belong to the draft.

    `tell` is called with each view, all of one check in their order.
    """

    def __init__(self, stages: Path | None, tell: Callable[[CheckView], None]) -> None:
        self._stages = stages
        self._tell = tell
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload(["sequence_planner.workshop.checking"])
        self._checking: asyncio.Task[None] | None = None

    def check(self, number: int, files: Files) -> None:
        """Check this now, and nothing else any more."""
        if self._checking is not None:
            self._checking.cancel()
        self._tell(waiting(number))
        self._checking = asyncio.create_task(self._checked(number, dict(files), self._checking))

    async def close(self) -> None:
        """End what is being checked."""
        if self._checking is not None:
            self._checking.cancel()
            await asyncio.gather(self._checking, return_exceptions=True)

    async def _checked(self, number: int, files: Files, before: asyncio.Task[None] | None) -> None:
        if before is not None:
            await asyncio.gather(before, return_exceptions=True)
        await asyncio.sleep(SETTLED)
        folder = tempfile.TemporaryDirectory(prefix="sequence-planner-check-")
        process, connection = await asyncio.to_thread(self._started, number, files, Path(folder.name))
        view = waiting(number)
        try:
            while view.state not in (CheckState.DONE, CheckState.FAILED):
                view = await _heard(connection)
                self._tell(view)
        except (EOFError, OSError):
            why = "the process that checks has ended without an answer; is memory short?"
            self._tell(view.model_copy(update={"state": CheckState.FAILED, "doing": why}))
        finally:
            await asyncio.shield(_end(process, connection, folder))

    def _started(self, number: int, files: Files, folder: Path) -> tuple[ForkServerProcess, Connection]:
        ours, theirs = self._context.Pipe(duplex=False)
        with theirs:
            arguments = (theirs, number, files, self._stages, folder)
            process = self._context.Process(target=_work, args=arguments, daemon=True, name="check")
            process.start()
        return process, ours


async def _heard(connection: Connection) -> CheckView:
    heard, loop = asyncio.Event(), asyncio.get_running_loop()
    loop.add_reader(connection.fileno(), heard.set)
    try:
        await heard.wait()
    finally:
        loop.remove_reader(connection.fileno())
    view: CheckView = await asyncio.to_thread(connection.recv)
    return view


async def _end(process: ForkServerProcess, connection: Connection, folder: tempfile.TemporaryDirectory[str]) -> None:
    process.kill()
    await asyncio.to_thread(process.join)
    connection.close()
    await asyncio.to_thread(folder.cleanup)


def _work(connection: Connection, number: int, files: Files, stages: Path | None, folder: Path) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    end_without_parent()
    os.nice(_NICENESS)
    from sequence_planner.workshop.checking import checked  # noqa: PLC0415 - the server does without what that imports

    with contextlib.suppress(OSError):
        for view in checked(number, files, stages, folder):
            connection.send(view)
