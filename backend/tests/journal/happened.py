"""What happens, to be journalled."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable, Iterable

from sequence_planner.db.database import Database
from sequence_planner.journal.writer import RunWriter

SNAPSHOTS = 10  # each tenth record is one


def kind(number: int) -> str:
    return "snapshot" if number % SNAPSHOTS == 0 else "alarm" if number % 7 == 3 else "ticked"


def content(number: int) -> str:
    return json.dumps({"number": number, "robot.pose": "bolt_pair", "torque": number / 7})


def with_writer(database: Database, act: Callable[[RunWriter], Awaitable[None]]) -> RunWriter:
    """Let `act` use a writer, which is closed then; it is returned for what it says."""

    async def run() -> RunWriter:
        writer = RunWriter(database, lambda: None)
        writer.start()
        await act(writer)
        await writer.close()
        return writer

    return asyncio.run(run())


def happened(database: Database, numbers: Iterable[int]) -> None:
    """Write records of these numbers, which must be the next; their times are their numbers."""

    async def write(writer: RunWriter) -> None:
        for number in numbers:
            assert writer.write(kind(number), float(number), content(number)) == number

    with_writer(database, write)


async def durable(writer: RunWriter, number: int, patience: float = 10.0) -> None:
    """Wait until all up to `number` is durable."""
    async with asyncio.timeout(patience):
        while writer.durable < number:  # noqa: ASYNC110 (it tells somebody else)
            await asyncio.sleep(0.005)


async def troubled(writer: RunWriter, patience: float = 10.0) -> str:
    """Wait until nothing can be written, and say why."""
    async with asyncio.timeout(patience):
        while writer.trouble is None:  # noqa: ASYNC110
            await asyncio.sleep(0.005)
    return writer.trouble
