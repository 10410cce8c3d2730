"""Logs: one line an event, on standard error, as text for people or as JSON for programs.

Whoever reads the log may stand still: a terminal that was stopped with Ctrl-S, a pipe that nobody empties, a disk that
is full. No tick waits for that. Lines go to a queue and a thread writes them; of those for which there is no room the
number is said later.
"""

from __future__ import annotations

import atexit
import contextlib
import io
import logging
import os
import sys
import threading
from enum import StrEnum
from queue import Full, Queue
from types import TracebackType
from typing import TYPE_CHECKING, TextIO, cast

from sequence_planner.core.lean_structlog import structlog
from sequence_planner.core.numerals import counted

if TYPE_CHECKING:
    from structlog.typing import EventDict, ExcInfo, Processor

FORMAT = "SEQUENCE_PLANNER_LOG_FORMAT"  # the variable of the environment that names the format, for all processes
STANDARD_ERROR = 2
MOST_WAITING = 10_000  # lines
LAST_LINES = 1.0  # seconds in which the lines that wait at the end are still written


class LogFormat(StrEnum):
    """The way in which events are written."""

    TEXT = "text"
    JSON = "json"


def log_format() -> LogFormat:
    """The format that the environment names. Raises `ValueError` where it names none that there is."""
    return LogFormat(os.environ.get(FORMAT) or LogFormat.TEXT)


class LineQueue:
    """The part of a file that a logger needs, and its calls never block; a thread writes to the file descriptor
    `out`.
    """

    def __init__(self, out: int, most: int = MOST_WAITING) -> None:
        self._out = out
        self._waiting: Queue[str] = Queue(most)
        self._lost = 0
        threading.Thread(target=self._write_all, daemon=True, name="log").start()

    def write(self, line: str) -> int:
        """Have `line` written some time."""
        try:
            self._waiting.put_nowait(line)
        except Full:
            self._lost += 1
        return len(line)

    def flush(self) -> None:
        """Nothing: nobody waits for the log."""

    def drain(self, seconds: float = LAST_LINES) -> None:
        """Wait until all is written, but no longer than `seconds`."""
        with self._waiting.all_tasks_done:
            self._waiting.all_tasks_done.wait_for(lambda: not self._waiting.unfinished_tasks, seconds)

    def _write_all(self) -> None:
        while True:
            text = self._waiting.get()
            lost, self._lost = self._lost, 0
            if lost:
                text += f"{counted(lost, 'line of the log was', 'lines of the log were')} lost here\n"
            with contextlib.suppress(OSError):  # the reader is gone, or the disk is full
                rest = text.encode(errors="replace")
                while rest:  # not through `sys.stderr`: whoever waits in it holds up the interpreter's end
                    rest = rest[os.write(self._out, rest) :]
            self._waiting.task_done()


def _escape_values(logger: object, method: str, event: EventDict) -> EventDict:
    """Keep what somebody typed from steering a terminal or beginning a line of its own."""
    return {name: _escaped(value) if isinstance(value, str) else value for name, value in event.items()}


def _write_traceback(out: TextIO, error: ExcInfo) -> None:
    """In the plain form: the other one shows the values of variables, and so passwords that people sent."""
    text = io.StringIO()
    structlog.dev.plain_traceback(text, error)
    out.write("\n".join(map(_escaped, text.getvalue().split("\n"))))


def _escaped(text: str) -> str:
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode("ascii") for each in text)


class _Events(logging.Handler):
    """Takes what libraries log by Python's own means as events like all others."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write it."""
        with contextlib.suppress(Exception):  # a record that cannot be formatted ends nothing
            structlog.get_logger().log(
                record.levelno, record.getMessage(), logger=record.name, exc_info=record.exc_info or None
            )


def configure_logs() -> None:
    """Write events as time, level, text and its values, in the format that the environment names."""
    lines = LineQueue(STANDARD_ERROR)
    atexit.register(lines.drain)
    structlog.configure(
        processors=[structlog.contextvars.merge_contextvars, structlog.processors.add_log_level, *_written()],
        logger_factory=structlog.WriteLoggerFactory(cast(TextIO, lines)),
    )
    root = logging.getLogger()
    root.handlers = [_Events()]
    root.setLevel(logging.WARNING)


def _written() -> list[Processor]:
    if log_format() is LogFormat.JSON:
        sys.excepthook = _end_with_an_event
        return [
            structlog.processors.TimeStamper(fmt="iso", utc=True, key="time"),
            structlog.processors.format_exc_info,
            structlog.processors.JSONRenderer(default=str),
        ]
    return [
        structlog.processors.TimeStamper(fmt="%H:%M:%S", utc=False),
        _escape_values,
        structlog.dev.ConsoleRenderer(colors=sys.stderr.isatty(), exception_formatter=_write_traceback),
    ]


def _end_with_an_event(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Log what ends the process as an event too."""
    structlog.get_logger().critical("the process failed", exc_info=(kind, error, trace))


def say(text: str) -> None:
    """Write for a person on standard output, or an event where nobody reads that: secrets are told at a terminal."""
    if os.environ.get(FORMAT) == LogFormat.JSON and not sys.stdout.isatty():
        structlog.get_logger().info(text)
        return
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
