"""The supervisor, computed in a process of its own that can be killed at any time.

An executor's process could not be: whoever leaves it waits until it is done, and one whose owner is killed lives on.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import signal
from multiprocessing.connection import Connection

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.lifeline import end_without_parent
from sequence_planner.synthesis.supervision import SynthesisError, synthesise


async def synthesised(automaton: Automaton) -> Supervisor:
    """The supervisor of `automaton`; when this is cancelled the process is killed.

    Raises `SynthesisError` when there is none, and `RuntimeError` when the process ended without an answer.
    """
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    with ours:
        with theirs:
            process = context.Process(target=_work, args=(theirs, automaton), daemon=True, name="synthesis")
            process.start()
        answer = asyncio.get_running_loop().run_in_executor(None, _heard, ours)
        try:
            found = await asyncio.shield(answer)
        finally:
            process.kill()
            process.join()
            await asyncio.wait({answer})  # at once, as nobody is left who could speak
    if found is None:
        raise RuntimeError("the process that computes the safe states has ended without an answer; is memory short?")
    if isinstance(found, SynthesisError):
        raise found
    return found


def _heard(connection: Connection) -> Supervisor | SynthesisError | None:
    try:
        word: Supervisor | SynthesisError = connection.recv()
    except (EOFError, OSError):
        return None
    return word


def _work(connection: Connection, automaton: Automaton) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    end_without_parent()
    try:
        connection.send(synthesise(automaton))
    except SynthesisError as error:
        connection.send(error)
