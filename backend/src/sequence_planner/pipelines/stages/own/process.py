"""One process that runs a function, as its keeper sees it. All calls may wait, at most for the time they are given."""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from sequence_planner.late_log import LateLog

LOG = LateLog(__name__)

STARTING = 10.0  # seconds within which a file must have been loaded
MOST_LINES = 20  # of what is printed during one call, in the log
LONGEST_LINE = 500
MOST_ANSWERED = 1_000_000  # characters
_PROGRAM = Path(__file__).with_name("program.py")
_CHUNK = 65_536
_PASSED = frozenset({"LANG", "TZ", "LD_LIBRARY_PATH", "PATH", "PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV"})
_PASSED_STARTS = ("LC_", "OMP_", "OPENBLAS_")


class OwnStageError(Exception):
    """A function gave no answer; the text says why."""


class FunctionFailed(OwnStageError):
    """The function raised an exception; its process goes on."""


@dataclass(frozen=True)
class Function:
    """A function in a file of a station, given as they were written and as a path."""

    file: str
    name: str
    path: Path
    folder: Path

    def __str__(self) -> str:
        return f"{self.file} {self.name}"


class FunctionProcess:
    """Starts the process; `load` waits until it can be asked."""

    def __init__(self, function: Function) -> None:
        self._function = function
        command = [sys.executable, "-B", "-P", str(_PROGRAM), str(function.folder), str(function.path), function.name]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(
            command, stdin=pipe, stdout=pipe, stderr=pipe, bufsize=0, start_new_session=True, env=_environment()
        )
        self._requests, self._answers, self._prints = (
            stream.fileno()
            for stream in (self._process.stdin, self._process.stdout, self._process.stderr)
            if stream is not None
        )
        os.set_blocking(self._requests, False)
        self._answer = self._printed = b""
        self._alive = True
        self._lock = threading.Lock()

    def load(self) -> None:
        """Wait until the file has been loaded. Raises `OwnStageError` if it cannot be."""
        try:
            note_unconfined(self._exchange(b"", STARTING).get("without"))
        except OwnStageError as error:
            raise OwnStageError(f"cannot be loaded: {error}") from None

    def call(self, arguments: Mapping[str, object], deadline: float) -> object:
        """What the function returns. Raises `OwnStageError` if it raises, or gives no answer in time."""
        return self._exchange(json.dumps(arguments).encode() + b"\n", deadline).get("gives")

    def kill(self) -> None:
        """End it and what it has started, without waiting. May be called from any thread."""
        with self._lock, contextlib.suppress(ProcessLookupError, PermissionError):
            if self._alive:
                os.killpg(self._process.pid, signal.SIGKILL)

    def close(self) -> None:
        """End it, and wait for that."""
        self.kill()
        os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOWAIT)
        with self._lock:  # from here on the number may belong to another process
            self._alive = False
            self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream is not None:
                stream.close()

    def _exchange(self, request: bytes, deadline: float) -> dict[str, object]:
        end = time.monotonic() + deadline
        try:
            with selectors.DefaultSelector() as selector:
                selector.register(self._answers, selectors.EVENT_READ)
                selector.register(self._prints, selectors.EVENT_READ)
                if request:
                    selector.register(self._requests, selectors.EVENT_WRITE)
                while b"\n" not in self._answer:
                    left = end - time.monotonic()
                    ready = selector.select(left) if left > 0 else []
                    if not ready:
                        raise OwnStageError(f"gave no answer within {deadline:g} s")
                    for key, _ in ready:
                        if key.fd == self._requests:
                            request = request[os.write(key.fd, request) :]
                            is_done = not request
                        else:
                            is_done = not self._receive(key.fd)
                        if is_done:
                            selector.unregister(key.fd)
        except OSError:
            raise OwnStageError("has ended by itself") from None
        finally:
            self._log()
        line, _, self._answer = self._answer.partition(b"\n")
        try:
            word: dict[str, object] = json.loads(line)
        except (ValueError, RecursionError):
            raise OwnStageError("gave an answer that cannot be read") from None
        if "failed" in word:
            raise FunctionFailed(str(word["failed"]))
        return word

    def _receive(self, pipe: int) -> bool:
        """Take what has come; whether more can come."""
        chunk = os.read(pipe, _CHUNK)
        if pipe == self._prints:
            self._printed = (self._printed + chunk)[:_CHUNK]
            return bool(chunk)
        self._answer += chunk
        if not chunk:
            raise OwnStageError("has ended by itself")
        if len(self._answer) > MOST_ANSWERED:
            raise OwnStageError(f"returned more than {MOST_ANSWERED} characters")
        return True

    def _log(self) -> None:
        lines = self._printed.decode(errors="replace").splitlines()
        self._printed = b""
        for line in lines[:MOST_LINES]:
            LOG.info("a stage printed", stage=str(self._function), line=line[:LONGEST_LINE])
        if len(lines) > MOST_LINES:
            LOG.info("a stage printed more", stage=str(self._function), lines=len(lines) - MOST_LINES)


def _environment() -> dict[str, str]:
    """What Python and its libraries go by, and nothing that tells of the station."""
    return {name: value for name, value in os.environ.items() if name in _PASSED or name.startswith(_PASSED_STARTS)}


def note_unconfined(without: object) -> None:
    """Say once in this process from what the system does not keep stages."""
    if isinstance(without, list) and without:
        _note_once(", ".join(map(str, without)))


@cache
def _note_once(without: str) -> None:
    LOG.warning("this system cannot keep Python stages from all that they have no use for", open_to_them=without)
