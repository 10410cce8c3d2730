"""The search for what is never together, in a process of its own that gives way to all others."""

from __future__ import annotations

import asyncio
import os
import signal
from multiprocessing.connection import Connection, Pipe

from sequence_planner.analysis.never_together import NeverTogether, never_together
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.forking.starting import hang_up, start
from sequence_planner.planning.budget import Budget

_NICENESS = 15  # it only serves questions


async def find_never_together(automaton: Automaton, supervisor: Supervisor, seconds: float) -> NeverTogether | None:
    """What is never together; nothing when that is not found within so many seconds of work, as it would not be another
    time. None when the process has ended early. It can be cancelled.
    """
    ours, theirs = Pipe()
    with ours:
        process = await asyncio.to_thread(
            start, _work, automaton, supervisor, seconds, name="never-together", connection=theirs
        )
        hearing = asyncio.get_running_loop().run_in_executor(None, _heard, ours)
        try:
            return await asyncio.shield(hearing)
        finally:
            process.kill()
            hang_up(ours)
            await asyncio.wait({hearing})  # at once, as nobody is left who could speak
            process.join()


def _heard(connection: Connection) -> NeverTogether | None:
    try:
        found: NeverTogether | None = connection.recv()
    except (EOFError, OSError):
        return None
    return found


def _work(connection: Connection, automaton: Automaton, supervisor: Supervisor, seconds: float) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    os.nice(_NICENESS)
    found = never_together(automaton, supervisor, Budget(float("inf")).working(seconds))
    connection.send(found or NeverTogether(frozenset(), None))
