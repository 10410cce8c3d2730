"""The analysis of a model in a process of its own, with the memory there is for it, and what it has found by then."""

from __future__ import annotations

import gc
from collections.abc import AsyncIterator, Callable, Generator, Iterator
from contextlib import AbstractAsyncContextManager
from typing import TYPE_CHECKING, Any, TypeVar

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.process.memory_limit import memory_limit
from sequence_planner.process.task import BackgroundTask, TooLargeError
from sequence_planner.texts.message import message

if TYPE_CHECKING:
    from sequence_planner.analysis.analysis import Analysis

# After ticks and the page, beside plans, and before all that is done in the background (10 and more): a station does
# nothing without its safe states. A command has no ticks, but a station may be at work on the same machine.
_NICENESS = 5

Word = TypeVar("Word")


def analysing(automaton: Automaton) -> AbstractAsyncContextManager[AsyncIterator[Analysis]]:
    """Give what synthesis finds of `automaton`, each time more of it, see `telling`. Raises `MemoryLimitError`."""
    from sequence_planner.analysis.finding import analyses  # noqa: PLC0415

    return telling(memory_limit(), analyses, automaton)


def telling(
    gigabytes: float, work: Callable[..., Iterator[Word]], *arguments: object
) -> AbstractAsyncContextManager[AsyncIterator[Word]]:
    """Give what `work`, a function of a module, finds until the block is left. Raises `WorkerError`."""
    return _task(gigabytes, work, arguments).telling()


def told(
    gigabytes: float, seconds: float, work: Callable[..., Iterator[Word]], *arguments: object
) -> Generator[Word, None, None]:
    """The same to a command, which waits for it. Raises `WorkerError`, and `TimeoutError` after so many seconds."""
    return _task(gigabytes, work, arguments).told(seconds)


def _task(gigabytes: float, work: Callable[..., Iterator[Word]], arguments: tuple[object, ...]) -> BackgroundTask[Word]:
    return BackgroundTask(_work, (work, *arguments), "synthesis", _NICENESS, gigabytes, (TooLargeError,))


def _work(work: Callable[..., Iterator[Any]], *arguments: object) -> Iterator[Any]:
    gc.freeze()  # the model stays; what is made for one question must go with it
    try:
        yield from work(*arguments)
    except MemoryError:
        raise TooLargeError(message("work.outgrown")) from None
