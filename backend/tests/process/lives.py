"""What processes do in the tests of workers."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from sequence_planner.process.budget import Budget


class RefusedError(Exception):
    """What the process may answer, too."""


def work(model: object) -> Callable[[str, Budget], object]:
    """Do what a question says."""

    def answer(asked: str, budget: Budget) -> object:
        match asked:
            case "model":
                return model
            case "process":
                return os.getpid(), os.nice(0)
            case "off":
                while not budget.spent:
                    time.sleep(0.001)
                return "given up"
            case "refuse":
                raise RefusedError("not that")
            case "fail":
                raise ZeroDivisionError("of its own making")
            case "forget":
                raise MemoryError
            case "count":
                return iter(range(3))
            case "write":
                assert isinstance(model, Path)
                before = sorted(each.name for each in model.iterdir())
                (model / "file").write_text("kept", encoding="utf-8")
                return model, before
        time.sleep(600)
        raise AssertionError(asked)

    return answer


def slow(model: object) -> Callable[[str, Budget], object]:
    """Take long to begin."""
    time.sleep(1)
    return work(model)


def counting(most: int, pause: float) -> Iterator[int]:
    """Count, and then end in the way that numbers beyond it say."""
    for number in range(most):
        yield number
        time.sleep(pause)
    raise RefusedError("no more")


def growing() -> Iterator[int]:
    """Take more and more memory."""
    kept = []
    while True:
        kept.append(bytearray(16 << 20))
        yield len(kept)


def leading() -> Iterator[int]:
    """Start another process, and say its number."""
    yield subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"]).pid
    time.sleep(600)


def reporting(more: int, tell: Callable[[int], None]) -> int:
    """Say something on the way."""
    tell(more)
    return more + 1
