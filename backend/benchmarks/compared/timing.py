"""CPU time, of this process and of others."""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

ROUNDS = 5


class Ended(NamedTuple):
    """The CPU time of a process and its children, in seconds, what it wrote, and whether it was stopped."""

    seconds: float
    output: str
    stopped: bool


def child(command: Sequence[str | Path], limit: float, stdin: Path | None = None, folder: Path | None = None) -> Ended:
    """Run a process for at most `limit` seconds; Python keeps what it has compiled, also where that is switched off."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    stopped, output = False, ""
    with (stdin or Path(os.devnull)).open("rb") as given:
        try:
            ended = subprocess.run(
                command,
                stdin=given,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                timeout=limit,
                cwd=folder,
                env={**os.environ, "PYTHONDONTWRITEBYTECODE": ""},
                check=False,
            )
            output = ended.stdout.decode(errors="replace")
        except subprocess.TimeoutExpired:
            stopped = True
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Ended(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, output, stopped)


def own(work: Callable[[], object]) -> float:
    """The CPU time of `work` in this process, in seconds."""
    began = time.process_time()
    work()
    return time.process_time() - began


def median(measure: Callable[[], float], rounds: int = ROUNDS) -> float:
    """The median of several measurements."""
    return statistics.median(measure() for _ in range(rounds))
