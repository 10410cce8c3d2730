"""Synthesis in a process of its own that can be killed at any time, and whatever it has found by then.

An executor's process could not be: whoever leaves it waits until it is done, and one whose owner is killed lives on.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from multiprocessing.connection import Connection

from sequence_planner.analysis.analysis import Analysis, analyses
from sequence_planner.automaton.structure import Automaton
from sequence_planner.lifeline import end_without_parent

_NICENESS = 5  # ticks come first


class SynthesisEndedError(Exception):
    """The process ended without having found all; the text says what the reason may be."""


@asynccontextmanager
async def analysing(automaton: Automaton) -> AsyncIterator[AsyncIterator[Analysis]]:
    """What is found of `automaton`, each time more of it, until the block is left: then the process is killed.

    Iterating raises `SynthesisEndedError` when the process ends before it is done.
    """
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=False)
    with ours:
        with theirs:
            process = context.Process(target=_work, args=(theirs, automaton), daemon=True, name="synthesis")
            process.start()
        words = _Words(ours)
        try:
            yield words.heard()
        finally:
            process.kill()
            process.join()
            await words.end()


class _Words:
    """What the process says, heard by a thread so that nobody else waits."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._hearing: asyncio.Future[Analysis | str] | None = None

    async def heard(self) -> AsyncIterator[Analysis]:
        while True:
            self._hearing = asyncio.get_running_loop().run_in_executor(None, self._next)
            word = await asyncio.shield(self._hearing)
            if isinstance(word, str):
                raise SynthesisEndedError(word)
            yield word
            if word.pending is None:
                return

    def _next(self) -> Analysis | str:
        try:
            word: Analysis | str = self._connection.recv()
        except (EOFError, OSError):
            return "the process that computes the safe states has ended without an answer; is memory short?"
        return word

    async def end(self) -> None:
        if self._hearing is not None:
            await asyncio.wait({self._hearing})  # at once, as nobody is left who could speak


def _work(connection: Connection, automaton: Automaton) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    end_without_parent()
    os.nice(_NICENESS)
    try:
        for found in analyses(automaton):
            connection.send(found)
    except MemoryError:
        connection.send(
            "the sets of states have outgrown the memory set aside for them: let fewer or smaller variables bear on "
            "the specifications and on `rest`"
        )
