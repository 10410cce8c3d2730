"""A process that makes or checks one backup, so that nobody who runs the station waits for it.

It computes at a low priority. Whoever ends it ends all that it has started.
"""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from pathlib import Path
from typing import Final

from sequence_planner.backup.archive import Maker
from sequence_planner.backup.making import Step
from sequence_planner.backup.settings import Keeping
from sequence_planner.backup.trouble import BackupError, Trouble
from sequence_planner.lifeline import lead_group_without_parent
from sequence_planner.storage.error import StorageError

LONGEST: Final = 12 * 3600.0  # seconds after which it is given up
_NICENESS: Final = 10  # below the station and what people wait for


@dataclass(frozen=True)
class Task:
    """What to do with `file`: check it, or make it where there is a `maker`."""

    url: str
    model: Path
    keeping: Keeping
    file: Path
    maker: Maker | None


@dataclass(frozen=True)
class Finished:
    """It is whole; for its sake the `removed` are no more."""

    removed: tuple[str, ...]


async def carried_out(task: Task, tell: Callable[[Step], None]) -> Finished:
    """Do it in a process; `tell` is called with each step. Raises `StorageError`."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(theirs, task), daemon=True, name="backup")
    with ours:
        with theirs:
            await asyncio.shield(asyncio.to_thread(process.start))
        try:
            async with asyncio.timeout(LONGEST):
                while isinstance(told := await _told(ours), Step):
                    tell(told)
        except TimeoutError:
            raise BackupError(
                Trouble.OTHER, f"it has taken more than {LONGEST / 3600:.0f} h and was given up"
            ) from None
        except (EOFError, OSError):
            raise BackupError(Trouble.OTHER, "its process has ended too early: is memory short? Try again") from None
        finally:
            await asyncio.shield(asyncio.to_thread(_end, process))
    if isinstance(told, StorageError):
        raise told
    assert isinstance(told, Finished)
    return told


async def _told(connection: Connection) -> object:
    heard, loop = asyncio.Event(), asyncio.get_running_loop()
    loop.add_reader(connection.fileno(), heard.set)
    try:
        await heard.wait()
    finally:
        loop.remove_reader(connection.fileno())
    return connection.recv()  # a few hundred bytes, all there at once


def _end(process: SpawnProcess) -> None:
    if process.pid is not None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.kill()  # it may not lead a group yet
    process.join()


def _work(connection: Connection, task: Task) -> None:
    lead_group_without_parent()
    os.nice(_NICENESS)
    from sequence_planner.backup.task import do  # noqa: PLC0415 - the server does without what that imports

    try:
        connection.send(do(task, connection.send))
    except StorageError as error:
        connection.send(error)
