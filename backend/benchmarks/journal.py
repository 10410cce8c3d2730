"""What it costs to journal what happens: how long a record takes to be durable, and the processor's time for it.

Run with `make bench`. Records as a tick writes them go to a new SQLite file (`synchronous = FULL`), at even distances;
times are on the wall, from `write` until the event loop is told. The processor's time is that of the process, less what
the same loop takes without writing. A `fdatasync` alone, on the same disk, stands beside it.
"""

from __future__ import annotations

import asyncio
import json
import os
import statistics
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from sequence_planner.db.database import Database
from sequence_planner.journal.writer import RunWriter

RATES = (10, 50, 200)  # records per second
SECONDS = 20.0
CONTENT = json.dumps(
    {
        "measured": {f"robot.joint_{number}": number for number in range(6)},
        "started": ["robot.move(bolt_pair)"],
        "finished": ["robot.move(home)"],
        "changes": {"robot.target_pose": "bolt_pair", "bolts": "placed"},
        "digest": "0123456789abcdef",
    }
)


async def at_even_distances(rate: int, act: Callable[[], None]) -> float:
    """Seconds of the processor."""
    used, began = time.process_time(), time.perf_counter()
    for number in range(int(rate * SECONDS)):
        await asyncio.sleep(max(0.0, began + number / rate - time.perf_counter()))
        act()
    return time.process_time() - used


async def measure(folder: Path, rate: int) -> None:
    """One line."""
    idle = await at_even_distances(rate, lambda: None)
    with closing(Database.open(f"sqlite:///{folder}/{rate}.sqlite")) as database:
        database.upgrade()
        waiting: deque[tuple[int, float]] = deque()
        took: list[float] = []

        def told() -> None:
            while waiting and waiting[0][0] <= writer.durable:
                took.append(time.perf_counter() - waiting.popleft()[1])

        def write() -> None:
            moment = time.perf_counter()
            waiting.append((writer.write("ticked", time.time(), CONTENT), moment))

        writer = RunWriter(database, told)
        writer.start()
        used = await at_even_distances(rate, write)
        await writer.close()
    took.sort()
    print(
        f"{rate:4d} records/s: durable after {_ms(statistics.median(took))} (median), "
        f"{_ms(took[int(0.99 * len(took))])} (99 %), {_ms(took[-1])} (longest); "
        f"{(used - idle) / len(took) * 1e3:.2f} ms of the processor for a record"
    )


def disk(folder: Path) -> None:
    """One line: three pages, made durable."""
    descriptor = os.open(folder / "alone", os.O_RDWR | os.O_CREAT)
    took = []
    for number in range(500):
        os.pwrite(descriptor, bytes(3 * 4096), number * 3 * 4096)
        began = time.perf_counter()
        os.fdatasync(descriptor)
        took.append(time.perf_counter() - began)
        time.sleep(0.01)
    os.close(descriptor)
    took.sort()
    print(f"fdatasync alone: {_ms(statistics.median(took))} (median), {_ms(took[int(0.99 * len(took))])} (99 %)")


def _ms(seconds: float) -> str:
    return f"{seconds * 1e3:.1f} ms"


def main() -> None:
    """In the folder that is named, or else in a temporary one."""
    with tempfile.TemporaryDirectory(dir=sys.argv[1] if len(sys.argv) > 1 else None) as folder:
        disk(Path(folder))
        for rate in RATES:
            asyncio.run(measure(Path(folder), rate))


if __name__ == "__main__":
    main()
