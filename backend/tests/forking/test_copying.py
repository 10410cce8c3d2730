"""A copy of a process works beside it, has what it has, and ends with it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from multiprocessing.connection import Connection, Pipe
from pathlib import Path

import pytest

from sequence_planner.analysis.worker import told
from sequence_planner.forking.copying import Copy
from sequence_planner.process.task import TooLargeError, WorkerError

PARENT = """
import sys, time
from multiprocessing.connection import Pipe
from sequence_planner.forking.copying import Copy

def sleep(connection):
    connection.send("begun")
    time.sleep(600)

ours, theirs = Pipe()
copy = Copy(sleep, name="test", connection=theirs)
ours.recv()
print(copy.pid, flush=True)
time.sleep(600)
"""


def answering(work: object) -> tuple[Connection, Copy]:
    """A copy that does `work`, which cannot be pickled, and where it answers."""
    ours, theirs = Pipe()
    assert callable(work)
    return ours, Copy(work, 20, name="test", connection=theirs)


def test_a_copy_has_what_the_process_has_and_changes_nothing_there() -> None:
    values = {"seen": 1}

    def work(connection: Connection, more: int) -> None:
        values["seen"] += more
        connection.send((values["seen"], os.getpid()))

    ours, copy = answering(work)
    assert ours.recv() == (21, copy.pid)
    copy.join()
    assert values == {"seen": 1}
    with pytest.raises(EOFError):
        ours.recv()
    copy.kill()  # it has ended, and its number may be another's


def test_an_error_in_a_copy_is_told_and_goes_no_further(capfd: pytest.CaptureFixture[str]) -> None:
    def work(connection: Connection, more: int) -> None:
        raise RuntimeError(f"no {more}")

    ours, copy = answering(work)
    with pytest.raises(EOFError):
        ours.recv()
    copy.join()
    assert "RuntimeError: no 20" in capfd.readouterr().err


def test_a_copy_ends_with_its_process_however_that_ends() -> None:
    with subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        number = int(parent.stdout.readline())
        parent.send_signal(signal.SIGKILL)
    end = time.monotonic() + 20
    while Path(f"/proc/{number}").exists() and " Z " not in Path(f"/proc/{number}/stat").read_text(encoding="ascii"):
        assert time.monotonic() < end
        time.sleep(0.02)


def counting(last: int) -> Iterator[int]:
    """Numbers, and then nothing for long."""
    yield from range(last)
    time.sleep(600)


def growing() -> Iterator[int]:
    """Take ever more memory."""
    kept = []
    while True:
        kept.append(bytearray(16 << 20))
        yield len(kept)


def killed() -> Iterator[int]:
    """End without a word."""
    yield 1
    os.kill(os.getpid(), signal.SIGKILL)


def test_what_was_told_before_the_deadline_is_had() -> None:
    heard = []
    with pytest.raises(TimeoutError):
        for each in told(1.0, 4.0, counting, 3):
            heard.append(each)
    assert heard == [0, 1, 2]


def test_a_process_that_takes_too_much_memory_or_is_killed_is_no_end_of_all() -> None:
    with pytest.raises(TooLargeError, match=r"more than 0\.25 GB"):
        list(told(0.25, 60.0, growing))
    with pytest.raises(WorkerError, match="has ended without an answer"):
        list(told(1.0, 60.0, killed))


def test_whoever_stops_listening_ends_it() -> None:
    telling = told(1.0, 60.0, counting, 3)
    assert next(telling) == 0
    telling.close()  # the generator waits until its process has ended
