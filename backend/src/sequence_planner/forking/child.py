"""A process that a fork server has forked, as whoever has asked for it sees it."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import subprocess
import threading
import time
from typing import Final

from sequence_planner.forking.request import read_begun, read_code

LOST: Final = -signal.SIGKILL  # the exit code of a process that has ended when nobody was left to see how


class Child:
    """A process called `name`; used like `subprocess.Popen`, from any thread. It ends when this is closed."""

    def __init__(self, name: str, connection: socket.socket, *, leads: bool = False) -> None:
        self.name = name
        self.returncode: int | None = None
        self._connection = connection
        self._leads = leads
        self._lock = threading.RLock()
        self._begun: tuple[int, int] | None = None

    @property
    def pid(self) -> int | None:
        """Its number, as soon as it has begun, which is waited for; None if it never has."""
        if self._begun is None:
            self._readable(None)  # nobody who ends it waits for that
        with self._lock:
            if self._begun is None and self.returncode is None:
                try:
                    self._begun = read_begun(self._connection)
                except (EOFError, OSError):
                    self._end(LOST)
            return None if self._begun is None else self._begun[0]

    def poll(self) -> int | None:
        """Its exit code, once it has ended; a signal's number, negative, where that has ended it."""
        self._look(0)
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait until it has ended: its exit code. Raises `subprocess.TimeoutExpired`."""
        end = None if timeout is None else time.monotonic() + timeout
        while self.returncode is None:
            rest = None if end is None else end - time.monotonic()
            if rest is not None and rest <= 0:
                raise subprocess.TimeoutExpired(self.name, timeout or 0.0)
            self._look(rest)
        return self.returncode

    def join(self) -> None:
        """Wait until it has ended."""
        self.wait()

    def terminate(self) -> None:
        """Ask it to end."""
        self._signal(signal.SIGTERM)

    def kill(self) -> None:
        """End it at once, and all that it has started if it leads."""
        with self._lock:
            if self.returncode is not None:
                return
            if self._begun is None and not self._readable(0):
                with contextlib.suppress(OSError):
                    self._connection.shutdown(socket.SHUT_WR)  # the server ends it, or never begins
                return
            if self._leads and (pid := self.pid) is not None and self.poll() is None:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(pid, signal.SIGKILL)
            self._signal(signal.SIGKILL)

    def close(self) -> None:
        """Let go of it, which ends it unless it was to be left."""
        with self._lock:
            self._end(LOST)

    def _signal(self, number: signal.Signals) -> None:
        with self._lock:
            if self.pid is not None and self._begun is not None and self.returncode is None:
                with contextlib.suppress(ProcessLookupError):
                    signal.pidfd_send_signal(self._begun[1], number)

    def _look(self, seconds: float | None) -> None:
        """See whether it has ended, for at most so many seconds; None: until something is said."""
        if not self._readable(seconds):
            return
        with self._lock:
            if self.returncode is not None or not self._readable(0):
                return
            if self._begun is None:
                _ = self.pid
                return
            try:
                code = read_code(self._connection)
            except (EOFError, OSError):  # the server is gone, and so is whoever else had this connection: the process
                code = LOST
                if self._begun is not None:
                    _poll(self._begun[1], None)
            self._end(code)

    def _readable(self, seconds: float | None) -> bool:
        with contextlib.suppress(ValueError, OSError):  # it was closed meanwhile
            return bool(_poll(self._connection.fileno(), seconds))
        return False

    def _end(self, code: int) -> None:
        if self.returncode is None:
            self.returncode = code
        with contextlib.suppress(OSError):
            self._connection.shutdown(socket.SHUT_RDWR)  # whoever waits for it is woken
        self._connection.close()
        if self._begun is not None:
            os.close(self._begun[1])
            self._begun = (self._begun[0], -1)


def _poll(descriptor: int, seconds: float | None) -> list[tuple[int, int]]:
    """Not `select`, which knows no descriptor above 1023."""
    looking = select.poll()
    looking.register(descriptor, select.POLLIN)
    return looking.poll(None if seconds is None else 1000 * seconds)
