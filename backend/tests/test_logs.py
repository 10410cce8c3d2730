"""The log holds nobody up, whoever reads it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time

from sequence_planner.core.logging import LineQueue
from support.waiting import patience

CHATTER = """
import time
import structlog
from sequence_planner.core.logging import configure_logs

configure_logs()
log = structlog.get_logger()
began = time.monotonic()
for number in range(30_000):
    log.info("said", number=number)
print("done", flush=True)
"""
FAULT = """
import structlog
from sequence_planner.core.logging import configure_logs

configure_logs()


def sign_in(password: str) -> None:
    raise RuntimeError("a fault of the program")


try:
    sign_in("".join(["a long ", "enough one"]))
except RuntimeError:
    structlog.get_logger().exception("a request failed")
"""

TYPED = """
import structlog
from sequence_planner.core.logging import configure_logs

configure_logs()
log = structlog.get_logger()
typed = "a" + chr(27) + "[2J" + chr(0) + chr(0x202E)
log.info("command", reason=typed, subject="a" + chr(10) + "12:00:00_forged", actor={"name": typed})
try:
    raise RuntimeError(typed)
except RuntimeError:
    log.exception("a request failed", path=typed)
"""


LIBRARY = """
import logging
logging.getLogger("uvicorn.error").warning("a library %s", "speaks")
"""
ENDING = """
from sequence_planner.core.logging import configure_logs

configure_logs()
raise RuntimeError("an end")
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
    assert time.monotonic() - began < patience(1)
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


def test_a_fault_is_told_with_its_place_and_without_what_people_sent() -> None:
    done = subprocess.run([sys.executable, "-c", FAULT], capture_output=True, text=True, timeout=20, check=True)
    assert "a request failed" in done.stderr
    assert "in sign_in" in done.stderr
    assert "RuntimeError: a fault of the program" in done.stderr
    assert "a long enough one" not in done.stderr


def test_what_somebody_typed_steers_no_terminal() -> None:
    told = subprocess.run([sys.executable, "-c", TYPED], capture_output=True, text=True, timeout=30, check=True).stderr
    assert all(each.isprintable() for each in told.replace("\n", ""))
    assert "12:00:00_forged" in told
    assert not any(line.startswith("12:00:00_forged") for line in told.splitlines())


def logged(program: str, form: str, code: int = 0) -> str:
    """What a program that ends with `code` writes to its log in this format."""
    environment = {**os.environ, "SEQUENCE_PLANNER_LOG_FORMAT": form}
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, timeout=30, check=False, env=environment)
    assert done.returncode == code
    return done.stderr


def test_each_event_is_one_line_of_json() -> None:
    lines = [json.loads(line) for line in logged(TYPED + LIBRARY, "json").splitlines()]
    assert [line["event"] for line in lines] == ["command", "a request failed", "a library speaks"]
    assert [line["level"] for line in lines] == ["info", "error", "warning"]
    assert all(line["time"].endswith("Z") for line in lines)
    assert "RuntimeError" in lines[1]["exception"]
    assert lines[2]["logger"] == "uvicorn.error"


def test_a_fault_in_json_does_not_tell_what_people_sent() -> None:
    (line,) = logged(FAULT, "json").splitlines()
    assert "in sign_in" in json.loads(line)["exception"]
    assert "a long enough one" not in line


def test_what_ends_a_process_is_an_event_too() -> None:
    (line,) = logged(ENDING, "json", code=1).splitlines()
    assert json.loads(line)["level"] == "critical"


def test_nothing_is_imported_to_write_more_beautifully() -> None:
    code = (
        "import sys; import sequence_planner.core.logging\n"
        "print(*({each.partition('.')[0] for each in sys.modules} & {'rich', 'twisted', 'attr'}))\n"
        "import rich.console, twisted.python.log"
    )
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert printed.split() == []
