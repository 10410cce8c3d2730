"""The log holds nobody up, whoever reads it."""

from __future__ import annotations

import os
import subprocess
import sys
import time

from sequence_planner.logs import LineQueue

CHATTER = """
import time
import structlog
from sequence_planner.logs import configure_logs

configure_logs()
log = structlog.get_logger()
began = time.monotonic()
for number in range(30_000):
    log.info("said", number=number)
print("done", flush=True)
"""


def test_lines_are_written_in_order() -> None:
    read, write = os.pipe()
    lines = LineQueue(write)
    for number in range(100):
        lines.write(f"{number}\n")
    lines.drain()
    assert os.read(read, 10_000).decode().split() == [str(number) for number in range(100)]


def test_nobody_waits_for_a_reader_that_stands_still_and_the_lost_are_counted() -> None:
    read, write = os.pipe()
    lines = LineQueue(write, most=10)
    began = time.monotonic()
    for _ in range(1000):
        lines.write("x" * 1000 + "\n")
    lines.drain(0.1)
    assert time.monotonic() - began < 1
    heard = b""
    while b"lines of the log were lost here" not in heard:
        heard += os.read(read, 100_000)
        lines.write("and on\n")


def test_a_reader_that_is_gone_or_stopped_does_not_end_the_process() -> None:
    for stop in (True, False):
        process = subprocess.Popen(
            [sys.executable, "-c", CHATTER], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        assert process.stderr is not None
        if not stop:
            process.stderr.close()
        assert process.stdout.readline() == "done\n"
        assert process.wait(timeout=20) == 0
        process.stdout.close()
        process.stderr.close()
